#pragma once
/// \file
/// A motion followed sample by sample, written as rows in the problem's units.

#include "design/integrators.hpp"
#include "flow/flow.hpp"
#include "verbs/study.hpp"

#include <optional>
#include <vector>

namespace percuss::verbs {

/// Follows a motion and writes it down. Positions count drive cycles from the start.
class TimeSeries {
public:
    /// Starts at position 0. `series` and `contacts` may be null.
    TimeSeries(const flow::System& system, const model::Specification& spec, const model::Scales& scales,
               const flow::State& start, RowSink* series, RowSink* contacts);

    /// Follows the motion up to a later position and writes a row there. False when the flow was lost.
    bool advance(double position);
    void add_velocity(double nondimensional);
    /// The drive becomes this share of its nominal value.
    void scale_drive(double share);
    /// A row for the present state.
    void write_row();
    /// Writes a contact that is still under way.
    void finish();

    [[nodiscard]] const flow::State& state() const { return state_; }
    [[nodiscard]] double position() const { return position_; }
    [[nodiscard]] flow::Status status() const { return status_; }
    [[nodiscard]] long contacts_met() const { return contacts_met_; }
    [[nodiscard]] double peak_force() const { return peak_force_; }  ///< nondimensional

private:
    struct OpenContact {
        double begin = 0.0;  ///< position
        double speed = 0.0;  ///< at entry; absent when the start lies in contact
        double peak_force = 0.0;
    };
    void write_headers();
    void meet(const flow::Contact& contact, double from, double theta);
    void write_contact(const OpenContact& contact, std::optional<double> end);
    [[nodiscard]] double time(double position) const;
    [[nodiscard]] double stop_force() const;

    flow::System nominal_, system_;
    const model::Specification& spec_;
    model::Scales scales_;
    RowSink* series_;
    RowSink* contacts_;
    flow::State state_{};
    double position_ = 0.0;
    double share_ = 1.0;
    flow::Status status_ = flow::Status::ok;
    flow::Result result_;
    std::optional<OpenContact> open_;
    long contacts_met_ = 0;
    double peak_force_ = 0.0;
};

}  // namespace percuss::verbs
