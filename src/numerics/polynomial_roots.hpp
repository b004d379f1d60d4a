#pragma once
/// \file
/// Real roots of a polynomial inside [0, 1], none missed: Bernstein coefficients bound the number of roots by their
/// sign changes (Descartes' rule in Bernstein form; see Mourrain, Rouillier, Roy, "The Bernstein basis and real root
/// isolation", 2005); intervals are halved until that number is zero or one.

#include <array>

namespace percuss::numerics {

inline constexpr int max_degree = 63;

struct Roots {
    std::array<double, 16> at{};  ///< increasing
    std::array<int, 16> sign{};   ///< sign of the polynomial just after the root: +1 rising, -1 falling
    int count = 0;
};

/// All sign changes of c[0] + c[1] t + ... + c[degree] t^degree for t in (0, 1], in increasing order, to a few units
/// in the last place of t where the polynomial is well conditioned. Touching without crossing is not reported. At most
/// 16 are returned.
Roots sign_changes(const double* c, int degree);

/// The first sign change with the given sign after it (+1 or -1); returns false when there is none.
bool first_sign_change(const double* c, int degree, int sign, double& t);

}  // namespace percuss::numerics
