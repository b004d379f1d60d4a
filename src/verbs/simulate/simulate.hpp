#pragma once
/// \file
/// Verb `simulate`: a time series, with or without a kick.
#include "verbs/simulate/motion.hpp"
#include "verbs/study.hpp"

#include <optional>
#include <string>
#include <vector>

namespace percuss::verbs {

/// A disturbance, as in fig. 6d of Wu, Cai, Gao, Cao, Appl. Syst. Innov. 2022, 5, 122. Positions count drive cycles
/// from the start; fractions are phases.
struct Kick {
    enum class Kind : std::uint8_t {
        velocity,  ///< x' jumps
        drive,     ///< the drive (voltage, or force of a spring-mass system) is scaled for some cycles
    };
    Kind kind = Kind::velocity;
    double at = 0.0;        ///< when it comes [drive cycles]
    double velocity = 0.0;  ///< added to x' [m/s], or nondimensional
    double share = 1.0;     ///< of the drive
    double duration = 0.0;  ///< of a scaled drive [drive cycles]
    [[nodiscard]] double end() const { return at + (kind == Kind::drive ? duration : 0.0); }
};

enum class SimulationStart : std::uint8_t {
    rest,
    orbit,  ///< the orbit that verb `orbit` finds; at an edge the impacting orbit there
    state,
};

struct SimulateOptions {
    SimulationStart from = SimulationStart::rest;
    std::vector<double> start;                       ///< state at theta = 0 in the problem's units, for `state`
    std::optional<std::vector<double>> orbit_start;  ///< for `orbit`: what Newton's method starts from
    int orbit_period = 1;                            ///< for `orbit`: drive cycles
    int cycles = 100;
    int samples = 64;  ///< rows of the series per drive cycle
    std::optional<Kick> kick;
};

/// What a kick did: recovered: the motion is the one it was; fell, rose: it is another one with a smaller or larger
/// peak force (amplitude where nothing strikes); undecided: before or after it no motion settled.
enum class KickOutcome : std::uint8_t { none, recovered, fell, rose, undecided };
std::string_view to_string(KickOutcome outcome);

struct SimulateResult {
    Ending ending =
        Ending::not_run;  ///< verified; infeasible: no impact, so no edge to run at; some_failed; interrupted
    std::string reason;   ///< one sentence unless verified
    design::OperatingPoint operating_point;
    std::vector<double> start;           ///< at theta = 0, in the problem's units
    std::vector<double> end_state;       ///< at the end of the series
    double cycles = 0.0;                 ///< drive cycles in the series
    long contacts = 0;                   ///< entries in the series
    double peak_force = design::absent;  ///< in the series
    std::optional<Motion> before;        ///< with a kick: the motion that would have settled without it
    /// With a kick: relative strobed change over one period of that motion, in the last cycles before the kick; absent
    /// when the series is shorter.
    double change_before = design::absent;
    std::optional<Motion> after;  ///< the motion that settles after the end of the series
    KickOutcome outcome = KickOutcome::none;
    double seconds = 0.0;
    double periods = 0.0;  ///< drive cycles integrated
};

/// Tables, null for none. `series`: time, cycle, phase, state, stop force, drive; at a kick one row before and one
/// after. `contacts`: one row per contact. Throws std::invalid_argument for options out of range.
SimulateResult run_simulate(const StudyProblem& problem, const SimulateOptions& study, RowSink* series,
                            RowSink* contacts, const Observer& observer, const StopRequest& stop);

}  // namespace percuss::verbs
