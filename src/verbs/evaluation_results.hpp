#pragma once
/// \file
/// Results of one evaluated design, for every verb that has one: JSON, tables, presentation. JSON numbers are in SI, or
/// nondimensional for [nondimensional] problems ("units" says which); what is absent is null.

#include "design/evaluation.hpp"
#include "problem/problem_file.hpp"
#include "results/json.hpp"
#include "results/presentation.hpp"
#include "verbs/frequencies.hpp"
#include "verbs/session.hpp"

#include <array>
#include <complex>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace percuss::verbs {

/// Values of keys.
using DesignValues = std::vector<std::pair<model::Key, double>>;

/// The design variables of a problem at its own values; all keys when there are no variables.
DesignValues design_values(const design::Problem& problem);

/// Whether there is an edge to tell of.
enum class WithEdge : std::uint8_t { no, yes };

/// {"schema", "units"}, the beginning of every document.
results::Json document_beginning(const problem::ProblemFile& problem, std::string_view schema);

results::Json design_of(const DesignValues& values);
results::Json quantities_of(const std::array<double, design::quantity_count>& values,
                            const problem::ProblemFile& problem);
results::Json orbit_of(const design::OrbitReport& orbit);
results::Json uniqueness_of(const design::Uniqueness& uniqueness);
/// Derivatives of the quantities and of the operating point; those of angular frequencies in the unit in which the
/// operating point tells them.
results::Json gradients_of(const design::Evaluation& evaluation, const problem::ProblemFile& problem, WithEdge edge);
results::Json multipliers_of(const std::vector<std::complex<double>>& multipliers);
/// The whole document of verbs that evaluate one design.
results::Json evaluation_document(const problem::ProblemFile& problem, std::string_view schema,
                                  const design::Evaluation& evaluation, double seconds, WithEdge edge);

/// One row: design, operating point, quantities, their error estimates.
std::string quantities_csv(const problem::ProblemFile& problem, const DesignValues& design,
                           const design::Evaluation& evaluation);
/// One row per key: the derivative of every quantity with respect to it.
std::string gradients_csv(const problem::ProblemFile& problem, const design::Evaluation& evaluation);

results::Block design_block(const DesignValues& design);
results::Block operating_point_block(const problem::ProblemFile& problem, const design::OperatingPoint& point,
                                     PointMembers members);
/// Operating point, quantities, orbit, gradients, uniqueness.
void add_evaluation(const problem::ProblemFile& problem, const design::Evaluation& evaluation, WithEdge edge,
                    results::Presentation& out);

/// Creates the results folder of verbs that evaluate one design, and writes its tables.
void start_evaluation(Session& session);
void store_evaluation(const Session& session, const design::Evaluation& evaluation);

}  // namespace percuss::verbs
