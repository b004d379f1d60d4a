#pragma once
/// \file
/// Interpretation of the sections of a problem file. What is wrong goes to the troubles.

#include "design/problem.hpp"
#include "io/setting_list.hpp"
#include "study/attractors.hpp"
#include "study/branch.hpp"
#include "study/locus.hpp"
#include "study/orbit.hpp"
#include "study/simulate.hpp"
#include "study/study.hpp"
#include "study/sweep.hpp"

#include <string>
#include <string_view>

namespace percuss::io {

/// The kind of problem told by the sections and actuator.type. Throws ProblemError for none and for mixtures.
const model::Actuator& family_of(const SettingList& settings);

/// [actuator] [material] [stop] [drive] [nondimensional] [spring-mass] into `problem`, whose family is set. Values are
/// parsed, not yet checked against their ranges.
void read_actuator(const SettingList& settings, design::Problem& problem, Troubles& troubles);

/// [design] into `problem`, whose family and stop law are set.
void read_design(const SettingList& settings, design::Problem& problem, Troubles& troubles);

/// [uniqueness], [optimiser], [solver] and [orbit].
void read_sampling(const SettingList& settings, design::Sampling& sampling, Troubles& troubles);
void read_optimiser(const SettingList& settings, study::OptimiserOptions& options, Troubles& troubles);
void read_solver(const SettingList& settings, design::SolverOptions& options, Troubles& troubles);
void read_orbit(const SettingList& settings, const model::Actuator& family, study::OrbitStudy& orbit,
                Troubles& troubles);

/// [simulate] and [sweep].
void read_simulate(const SettingList& settings, const model::Actuator& family, study::SimulateStudy& study,
                   Troubles& troubles);
void read_sweep(const SettingList& settings, const model::Actuator& family, study::SweepStudy& study,
                Troubles& troubles);

/// [attractors]
void read_attractors(const SettingList& settings, const model::Actuator& family, study::AttractorsStudy& study,
                     Troubles& troubles);

/// A kick as it is written in problem files; its numbers read back exactly.
std::string kick_text(const study::Kick& kick, const model::Actuator& family);

/// Numbers in a state of this family.
std::size_t states_of(const model::Actuator& family);

/// [branch] and [locus]; the actuator has been read.
void read_branch(const SettingList& settings, const model::Specification& spec, study::BranchStudy& study,
                 Troubles& troubles);
void read_locus(const SettingList& settings, const model::Specification& spec, study::LocusStudy& study,
                Troubles& troubles);

/// A number for this key of this family: plain for nondimensional keys, else with an optional unit. Throws
/// std::invalid_argument.
double parse_key_value(model::Key key, std::string_view text);

/// A key of the family by name. Throws ProblemError that names the nearest one.
model::Key parse_key(std::string_view name, const model::Actuator& family);

}  // namespace percuss::io
