#pragma once
/// \file
/// A problem as the engine sees it: the actuator, where to operate it, what to vary, what to want.

#include "design/quantity.hpp"
#include "model/specification.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace percuss::design {

/// "stop.gap in 0.2 mm .. 1.6 mm log integer"; bounds in the key's SI unit.
struct DesignVariable {
    model::Key key{};
    double lower = 0.0;
    double upper = 0.0;
    bool logarithmic = false;
    bool integer = false;
};

struct Objective {
    Quantity quantity = Quantity::peak_force;
    bool maximise = true;
};

/// "amplitude <= 0.8 mm"; bound in the quantity's SI unit.
struct Limit {
    Quantity quantity{};
    bool upper = true;  ///< <=
    double bound = 0.0;
    std::string text;  ///< as the user wrote it
};

/// Tiers 0 to 3 of the uniqueness check.
enum class SingleStable : std::uint8_t { off, orbit, sampled, refuted };

struct SolverOptions {
    double tolerance = 1e-13;              ///< relative, per integration step
    std::string integrator = "auto";       ///< auto | taylor | erk | cvode
    std::string instruction_set = "auto";  ///< auto | v2 | v3 | v4 | generic
};

/// Starts of the sampled uniqueness check (tier 2).
struct Sampling {
    long starts = 512;
    std::uint64_t seed = 1;
    int jobs = 1;       ///< threads; results do not depend on it
    int cycles = 1000;  ///< budget of each start, drive cycles
    /// Distance kept from the window of a motion that refuted a design, relative; absent: as from the edge.
    std::optional<double> margin;
};

struct Problem {
    model::Specification actuator;
    double margin = 0.01;  ///< operate at (1 - margin) times the edge
    std::vector<DesignVariable> variables;
    std::vector<Objective> objectives;
    std::vector<Limit> limits;
    SingleStable single_stable = SingleStable::orbit;
    Sampling sampling;
    SolverOptions solver;
};

}  // namespace percuss::design
