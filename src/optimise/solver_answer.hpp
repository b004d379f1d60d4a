#pragma once
/// \file
/// What a foreign solver says about its own run; believed only after a check.

#include "optimise/nlp.hpp"

#include <cstdint>
#include <string>

namespace percuss::optimise {

struct SolverAnswer {
    enum class Claim : std::uint8_t { none, optimum, infeasible };
    Claim claim = Claim::none;
    Vector x;             ///< the point that the solver ends on; empty if it gave none
    Vector last;          ///< the last point it asked for with gradient, often the better one; empty without gradients
    std::string message;  ///< its own words
};

}  // namespace percuss::optimise
