#pragma once
/// \file
/// The table of optimisation methods: what each is called, what it can do, how it is run.

#include "optimise/guard.hpp"
#include "optimise/result.hpp"
#include "optimise/solver_answer.hpp"

#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace percuss::optimise {

/// What a method can do. Methods without constraints of their own are given an augmented Lagrangian by their library.
struct Capabilities {
    bool global = false;    ///< searches the whole box, which must be finite; its result is polished by a local method
    bool gradient = false;  ///< asks for gradients
    int least_variables = 1;
    int most_variables = std::numeric_limits<int>::max();
    int most_constraints = std::numeric_limits<int>::max();
};

/// One run from a start within the bounds, without polish. Ends by the method's own tolerance, after the guard's
/// evaluations, or when the guard halts; errors of the evaluator wait in the guard.
using Solver = std::function<SolverAnswer(Guard& guard, const Vector& start, const Options& options)>;

/// A row of the table.
struct Method {
    std::string name;     ///< Options::method
    std::string library;  ///< "Ipopt", "NLopt"
    Capabilities capabilities;
    Solver solver;
};

/// All methods: those of Ipopt, then those of NLopt, local ones first. A further method of a library is a row in the
/// adapter of that library; a further library is an adapter with a table of rows, named here.
[[nodiscard]] const std::vector<Method>& method_table();

/// Throws std::invalid_argument with the list of names for one that is not in the table.
[[nodiscard]] const Method& find_method(const std::string& name);

/// Throws std::invalid_argument, naming the method and what it needs, for a problem that it cannot take.
void check_fits(const Method& method, const MemoisedNlp& nlp);

}  // namespace percuss::optimise
