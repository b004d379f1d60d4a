#pragma once
/// \file
/// Systems that depend on one or two parameters, for continuation.

#include "flow/flow.hpp"

#include <functional>
#include <span>
#include <vector>

namespace percuss::flow {

/// The systems `base` with the parameters p of a continuation: their parameter vectors and how those move with each p.
struct ParameterFamily {
    System base;
    std::function<ParameterVector(std::span<const double> p)> parameters;
    /// One entry per p.
    std::function<std::vector<ParameterVector>(std::span<const double> p)> directions;
    std::vector<double> units;  ///< what counts as a change of order one, per p

    [[nodiscard]] int dimension() const { return static_cast<int>(units.size()); }
    [[nodiscard]] System at(std::span<const double> p) const { return base.with(parameters(p)); }
    [[nodiscard]] System at(double p) const { return at({&p, 1}); }
};

/// The drive frequency omega as the only parameter.
ParameterFamily along_frequency(const System& base, double unit);

}  // namespace percuss::flow
