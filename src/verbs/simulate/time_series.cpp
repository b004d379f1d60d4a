#include "verbs/simulate/time_series.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace percuss::verbs {
namespace {

using std::numbers::pi;

/// Drive phase in [0, 2 pi) at a position in drive cycles.
double phase_of(double position) { return 2.0 * pi * (position - std::floor(position)); }

}  // namespace

TimeSeries::TimeSeries(const flow::System& system, const model::Specification& spec, const model::Scales& scales,
                       const flow::State& start, RowSink* series, RowSink* contacts)
    : nominal_(system),
      system_(system),
      spec_(spec),
      scales_(scales),
      series_(series),
      contacts_(contacts),
      state_(start) {
    write_headers();
}

void TimeSeries::write_headers() {
    const bool plain = spec_.type->nondimensional;
    const auto unit = [&](const char* name) { return plain ? std::string() : std::string(name); };
    if (series_ != nullptr) {
        std::vector<Column> columns = {{"time", unit("s")}, {"cycle", ""}, {"phase", unit("rad")}};
        for (const model::StateInfo& state : spec_.type->states.first(static_cast<std::size_t>(system_.states()))) {
            columns.push_back({std::string(state.name), plain ? std::string() : std::string(state.unit)});
        }
        columns.push_back({"stop_force", unit("N")});
        for (const model::DriveSignal& drive : spec_.type->drives) {
            columns.push_back({std::string(drive.name), std::string(drive.unit)});
        }
        series_->header(columns);
    }
    if (contacts_ != nullptr) {
        const std::array<Column, 8> columns = {{{"entry_time", unit("s")},
                                                {"entry_cycle", ""},
                                                {"entry_phase", unit("rad")},
                                                {"impact_velocity", unit("m/s")},
                                                {"peak_force", unit("N")},
                                                {"contact_time", unit("s")},
                                                {"exit_time", unit("s")},
                                                {"exit_phase", unit("rad")}}};
        contacts_->header(columns);
    }
}

bool TimeSeries::advance(double position) {
    // As for starts of ensembles: a limit of 128 gave some of them up in a brute-force check of random designs.
    constexpr int events_per_cycle = 1024;
    flow::Request request;
    request.state = state_;
    request.theta = phase_of(position_);
    request.duration = 2.0 * pi * (position - position_);
    request.observe = flow::observe_force;
    request.max_events = events_per_cycle;
    system_.run(request, result_);
    status_ = result_.status;
    if (status_ != flow::Status::ok) { return false; }
    // Pieces end at samples, so one contact may be met in several of them.
    const bool goes_on = !result_.contacts.empty() && result_.contacts.front().open_in;
    if (open_ && !goes_on) {  // it ended where the last piece did
        write_contact(*open_, position_);
        open_.reset();
    }
    for (const flow::Contact& contact : result_.contacts) { meet(contact, position_, request.theta); }
    state_ = result_.state;
    position_ = position;
    write_row();
    return true;
}

void TimeSeries::meet(const flow::Contact& contact, double from, double theta) {
    const auto position_of = [&](double at) { return from + (at - theta) / (2.0 * pi); };
    if (!open_) {
        open_ = OpenContact{position_of(contact.theta_in), contact.open_in ? design::absent : contact.state_in[1], 0.0};
        contacts_met_ += contact.open_in ? 0 : 1;
    }
    open_->peak_force = std::max(open_->peak_force, contact.peak_force);
    peak_force_ = std::max(peak_force_, contact.peak_force);
    if (!contact.open_out) {
        write_contact(*open_, position_of(contact.theta_out));
        open_.reset();
    }
}

void TimeSeries::write_contact(const OpenContact& contact, std::optional<double> end) {
    if (contacts_ == nullptr) { return; }
    const double until = end.value_or(design::absent);
    const std::array<double, 8> row = {time(contact.begin),
                                       contact.begin,
                                       phase_of(contact.begin),
                                       contact.speed * scales_.length / scales_.time,
                                       contact.peak_force * scales_.force,
                                       time(until) - time(contact.begin),
                                       time(until),
                                       end ? phase_of(until) : design::absent};
    contacts_->row(row);
}

void TimeSeries::finish() {
    if (open_) { write_contact(*open_, std::nullopt); }
    open_.reset();
}

void TimeSeries::add_velocity(double nondimensional) { state_[1] += nondimensional; }

void TimeSeries::scale_drive(double share) {
    share_ = share;
    const auto drive = static_cast<std::size_t>(system_.integrator->info().drive);
    flow::ParameterVector parameters = nominal_.parameters;
    parameters[drive] *= share;
    system_ = nominal_.with(parameters);
}

double TimeSeries::time(double position) const { return 2.0 * pi * position / system_.omega() * scales_.time; }

double TimeSeries::stop_force() const {
    if (!model::has_stop(spec_.law)) { return 0.0; }
    const flow::SystemInfo& info = system_.integrator->info();
    const auto parameter = [&](int i) { return system_.parameters[static_cast<std::size_t>(i)]; };
    const double overlap = state_[0] - system_.stop_position();
    if (!(overlap >= 0.0)) { return 0.0; }
    const double force = parameter(info.stiffness) * overlap + parameter(info.damping) * state_[1];
    return info.releases_on_force ? std::max(0.0, force) : force;
}

void TimeSeries::write_row() {
    if (series_ == nullptr) { return; }
    const double phase = phase_of(position_);
    std::vector<double> row = {time(position_), position_, phase};
    const std::vector<double> state = design::to_user(state_, scales_, system_.states());
    row.insert(row.end(), state.begin(), state.end());
    row.push_back(scales_.force * stop_force());
    // From the specification, not scaled back: the signal shows the number that was given.
    const double amplitude = spec_.value(*model::key_of(model::Role::drive, *spec_.type)) * share_;
    for (const model::DriveSignal& drive : spec_.type->drives) { row.push_back(amplitude * drive.shape(phase)); }
    series_->row(row);
}

}  // namespace percuss::verbs
