#pragma once
/// \file
/// Order of the Taylor method.

#include <algorithm>
#include <cmath>

namespace percuss::flow {

/// Order for a relative tolerance per step: -ln(tol)/2 + 2 (Jorba and Zou 2005, section 3.2, with two to spare).
inline int taylor_order(double tolerance) {
    return std::max(4, static_cast<int>(std::ceil(-0.5 * std::log(tolerance) + 2.0)));
}

}  // namespace percuss::flow
