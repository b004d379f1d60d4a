#pragma once
/// \file
/// Verb `sweep`: forward and backward frequency sweeps in the time domain.
#include "verbs/study.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace percuss::verbs {

enum class SweepMode : std::uint8_t { steps, chirp };

/// Frequencies are angular drive frequencies [rad/s], or omega of a nondimensional problem.
struct SweepOptions {
    SweepMode mode = SweepMode::steps;
    std::optional<double> from;  ///< default: 0.6 times the linear resonance
    std::optional<double> to;    ///< default: twice the linear resonance, where a linear spring with a hard stop at its
                                 ///< rest position would resonate
    int steps = 140;             ///< one frequency more than that
    double tolerance = 1e-8;     ///< of orbit::SettlingOptions, rule remaining_error
    int max_cycles = 500;
    int longest_period = 12;
    int chirp_cycles = 5000;  ///< drive cycles of a chirp in one direction
};

/// One frequency of a step sweep or one drive cycle of a chirp, in the problem's units.
struct SweepPoint {
    double omega = design::absent;
    double drive_frequency = design::absent;
    int cycles = 0;        ///< drive cycles followed until settled
    bool settled = false;  ///< always false in a chirp
    int period = 0;        ///< drive cycles; 0 unless settled
    double strobed_change = design::absent;
    double remaining_error = design::absent;
    double amplitude = design::absent;
    double x_max = design::absent;
    double x_min = design::absent;
    double peak_force = design::absent;
    int contacts = 0;           ///< per period; in longest_period cycles unless settled; in one cycle of a chirp
    std::vector<double> state;  ///< at theta = 0; empty in a chirp
};

/// Two neighbouring points with different motions: what differs.
struct SweepJump {
    std::size_t before = 0;  ///< indices of the points
    std::size_t after = 0;
    bool period = false;     ///< the period, or whether there is one
    bool contacts = false;   ///< contacts per cycle
    bool amplitude = false;  ///< a step out of line with those beside it
    bool peak_force = false;
    [[nodiscard]] bool discontinuous() const { return amplitude || peak_force; }
};

struct SweepDirection {
    bool forward = true;
    std::vector<SweepPoint> points;
    std::vector<SweepJump> jumps;
    std::string trouble;   ///< why it ended early, empty if it did not
    double periods = 0.0;  ///< drive cycles integrated
};

/// The settled motions of both directions at the same frequencies.
struct SweepComparison {
    int compared = 0;
    int unsettled = 0;       ///< frequencies where a direction did not settle, so that they cannot be compared
    int different = 0;       ///< other period, contacts, extremes or peak force
    double largest = 0.0;    ///< largest difference where they agree
    double tolerance = 0.0;  ///< of extremes and peak force, relative to the largest amplitude and peak force met
    std::vector<std::pair<double, double>> ranges;  ///< omega of the first and last point of each differing stretch
    [[nodiscard]] bool coincide() const { return compared > 0 && different == 0; }
};

struct SweepResult {
    Ending ending = Ending::not_run;  ///< verified: both directions went through; some_failed: a motion was lost;
                                      ///< interrupted: stopped early
    std::string reason;               ///< one sentence unless verified
    double from = design::absent;     ///< drive frequency [Hz], or cycles per unit of nondimensional time
    double to = design::absent;
    double from_omega = design::absent;
    double to_omega = design::absent;
    std::vector<SweepDirection> directions;  ///< forward, backward
    SweepComparison comparison;              ///< steps only
    double seconds = 0.0;
};

/// Both directions start at rest at their first frequency; a chirp settles there first. With jobs > 1 they run side by
/// side, with the same bits. `rows`: every point, forward first, written at the end. Throws std::invalid_argument for
/// options out of range.
SweepResult run_sweep(const StudyProblem& problem, const SweepOptions& study, RowSink* rows, const Observer& observer,
                      const StopRequest& stop);

}  // namespace percuss::verbs
