#pragma once
/// \file
/// A comparison by relative error. doctest::Approx alone adds one to the size of what it compares, which makes its
/// epsilon absolute for small numbers.

#include <doctest/doctest.h>

namespace percuss::test {

inline doctest::Approx relative(double value, double epsilon) {
    return doctest::Approx(value).epsilon(epsilon).scale(1e-300);
}

}  // namespace percuss::test
