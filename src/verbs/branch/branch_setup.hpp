#pragma once
/// \file
/// What the studies `branch` and `locus` start from: the system, its family of parameters, the range, a first motion.

#include "branch/trace.hpp"
#include "design/integrators.hpp"
#include "flow/parameter_family.hpp"
#include "verbs/branch/branch.hpp"

#include <optional>

namespace percuss::verbs {

struct BranchSetup {
    /// Throws std::invalid_argument for a parameter that cannot be varied and for an empty range.
    BranchSetup(const StudyProblem& problem, const BranchOptions& study);
    BranchSetup(const BranchSetup&) = delete;
    BranchSetup& operator=(const BranchSetup&) = delete;

    /// A stable or unstable orbit of one drive cycle to set out from, met at rest.
    [[nodiscard]] std::optional<branch::Departure> departure() const;
    /// From the user's unit of the drive frequency to omega, and back.
    [[nodiscard]] double to_omega(double user) const;
    [[nodiscard]] double from_omega(double omega) const;

    const StudyProblem& problem;
    design::Integrators scene;
    model::Specification specification;  ///< with a drive frequency
    model::Scales scales;
    flow::Cost cost;
    flow::System system;  ///< at the specification's parameters
    flow::System scout;
    std::size_t omega_index = 0;
    bool along_frequency = true;
    model::Key along{};
    double user_from = 0.0;
    double user_to = 0.0;
    double from = 0.0;  ///< of the family's parameter
    double to = 0.0;
    double size = 0.1;
    flow::ParameterFamily family;
};

/// Stable periodic motions, up to the longest period wanted, that ensembles of starts lead to at 32 places between two
/// values of the parameter; only at the problem's own frequency where one is given. In the order of the places.
struct FoundMotion {
    orbit::Motion motion;
    double parameter = 0.0;
};
std::vector<FoundMotion> find_motions_along(const BranchSetup& setup, const BranchOptions& study, double low,
                                            double high, const Observer& observer, const StopRequest& stop);

}  // namespace percuss::verbs
