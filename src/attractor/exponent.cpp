#include "attractor/exponent.hpp"

#include "attractor/box.hpp"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace percuss::attractor {
namespace {

using std::numbers::pi;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// A state with a tangent vector, carried from strobe to strobe.
class TangentRun {
public:
    TangentRun(const flow::System& system, const flow::State& from) : system_(system) {
        const int states = system.states();
        // Any direction will do that is not one of those that shrink fastest; equal entries favour none.
        for (int k = 0; k < states; ++k) { tangent_.state[index(k)] = 1.0 / std::sqrt(states); }
        request_.state = from;
        request_.duration = 2.0 * pi;
        request_.max_events = most_contact_events;
        request_.observe = flow::observe_extrema | flow::observe_force;
        request_.directions = {&tangent_, 1};
    }

    /// One cycle; the logarithm of the growth of the tangent vector, NaN when the flow failed.
    double advance() {
        system_.run(request_, result_);
        if (result_.status != flow::Status::ok) { return std::nan(""); }
        double squared = 0.0;
        for (int k = 0; k < system_.states(); ++k) {
            squared += result_.state_d[index(k)][0] * result_.state_d[index(k)][0];
        }
        const double growth = std::sqrt(squared);
        if (!(growth > 0.0)) { return std::nan(""); }
        for (int k = 0; k < system_.states(); ++k) { tangent_.state[index(k)] = result_.state_d[index(k)][0] / growth; }
        before_ = request_.state;
        request_.state = result_.state;
        return std::log(growth);
    }

    [[nodiscard]] const flow::Result& result() const { return result_; }
    [[nodiscard]] const flow::State& before() const { return before_; }

private:
    const flow::System& system_;
    flow::Direction tangent_;
    flow::Request request_;
    flow::Result result_;
    flow::State before_{};
};

/// Phase until the first entry into contact, a whole cycle without one.
double flight(const flow::Result& result) {
    return result.contacts.empty() ? 2.0 * pi : result.contacts.front().theta_in;
}

void observe(const TangentRun& run, double& longest_flight, Wander& seen) {
    const flow::Result& result = run.result();
    const flow::Observables& o = result.observables;
    const bool first = seen.cycles == 0;
    seen.x_max = first ? o.x_max.value : std::max(seen.x_max, o.x_max.value);
    seen.x_min = first ? o.x_min.value : std::min(seen.x_min, o.x_min.value);
    seen.peak_force = std::max(seen.peak_force, o.peak_force.value);
    // Contacts are counted in the cycle in which they begin: one open at its start was counted in the one before.
    seen.contacts_per_cycle += static_cast<double>(
        std::count_if(result.contacts.begin(), result.contacts.end(), [](const auto& c) { return !c.open_in; }));
    if (flight(result) > longest_flight) {
        longest_flight = flight(result);
        seen.state = run.before();
    }
    seen.strobes.push_back(result.state);
    ++seen.cycles;
}

/// Mean of the logarithms, and its 95 % interval by Student's t from the scatter of batch means: consecutive logarithms
/// are correlated, means of batches (128 cycles by default) nearly not.
Exponent estimate(const std::vector<double>& logs, int batches) {
    const std::size_t length = logs.size() / index(batches);
    std::vector<double> means;
    for (std::size_t first = 0; means.size() < index(batches); first += length) {
        double sum = 0.0;
        for (std::size_t i = first; i < first + length; ++i) { sum += logs[i]; }
        means.push_back(sum / static_cast<double>(length));
    }
    double mean = 0.0;
    for (const double m : means) { mean += m / batches; }
    double variance = 0.0;
    for (const double m : means) { variance += (m - mean) * (m - mean) / (batches - 1); }
    const boost::math::students_t_distribution<> student(batches - 1);
    return {mean, boost::math::quantile(student, 0.975) * std::sqrt(variance / batches)};
}

}  // namespace

Wander wander(const flow::System& system, const flow::State& from, const ExponentOptions& options,
              const std::function<bool(const flow::State&)>& leave) {
    if (!(options.transient >= 0 && options.batches >= 2 && options.cycles >= options.batches)) {
        throw std::invalid_argument("exponent: allowed are transient >= 0, batches >= 2, cycles >= batches");
    }
    Wander seen;
    TangentRun run(system, from);
    std::vector<double> logs;
    double sum = 0.0;
    double longest_flight = -1.0;
    for (int cycle = 0; cycle < options.transient + options.cycles; ++cycle) {
        const double growth = run.advance();
        if (std::isnan(growth)) {
            seen.status = WanderStatus::flow_failed;
            return seen;
        }
        if (leave && leave(run.result().state)) {
            seen.status = WanderStatus::left;
            return seen;
        }
        // Until the vector has turned into the direction that grows most its logarithms say nothing.
        if (cycle < options.transient) { continue; }
        logs.push_back(growth);
        sum += growth;
        seen.swing = std::max(seen.swing, std::abs(sum));
        observe(run, longest_flight, seen);
    }
    seen.exponent = estimate(logs, options.batches);
    seen.contacts_per_cycle /= seen.cycles;
    seen.status = WanderStatus::ok;
    return seen;
}

}  // namespace percuss::attractor
