// Bordered systems against determinants, singular values and differences.

#include "numerics/bordered.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <complex>

using namespace percuss;
using numerics::Complex;
using numerics::ComplexMatrix;
using numerics::Matrix;
using numerics::Vector;

namespace {

double entry(int seed) { return std::sin(12.9898 * seed + 0.37 * seed * seed + 1.0); }

template <class Scalar>
Scalar scalar_entry(int seed) {
    if constexpr (std::is_same_v<Scalar, double>) {
        return entry(seed);
    } else {
        return {entry(seed), entry(seed + 1000)};
    }
}

template <class Scalar>
using Square = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;

template <class Scalar>
Square<Scalar> filled(int n, int seed) {
    Square<Scalar> a(n, n);
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) { a(i, j) = scalar_entry<Scalar>(seed + 17 * i + j); }
    }
    return a;
}

/// The same matrix without its smallest singular value.
template <class Scalar>
Square<Scalar> made_singular(const Square<Scalar>& a) {
    const Eigen::JacobiSVD<Square<Scalar>> svd(a, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Vector sigma = svd.singularValues();
    sigma[sigma.size() - 1] = 0.0;
    return svd.matrixU() * sigma.cast<Scalar>().asDiagonal() * svd.matrixV().adjoint();
}

}  // namespace

TEST_CASE_TEMPLATE("g is the quotient of determinants, for any borders", Scalar, double, Complex) {
    for (int n = 1; n <= 9; ++n) {
        CAPTURE(n);
        const Square<Scalar> a = filled<Scalar>(n, n);
        numerics::NullVectors<Scalar> borders;
        borders.left = filled<Scalar>(n, 50).col(0);
        borders.right = filled<Scalar>(n, 90).col(0);
        Square<Scalar> full(n + 1, n + 1);
        full << a, borders.left, borders.right.adjoint(), Scalar(0.0);
        const auto b = numerics::solve_bordered<Scalar>(a, borders);
        const Scalar expected = a.determinant() / full.determinant();
        CHECK(std::abs(b.g - expected) < 1e-11 * std::abs(expected));
        // Both systems, row by row.
        CHECK((a * b.v + borders.left * b.g).norm() < 1e-12 * (1.0 + b.v.norm()));
        CHECK(std::abs(borders.right.dot(b.v) - 1.0) < 1e-12 * (1.0 + b.v.norm()));
        CHECK((a.adjoint() * b.w + borders.right * Eigen::numext::conj(b.g)).norm() < 1e-12 * (1.0 + b.w.norm()));
        CHECK(std::abs(borders.left.dot(b.w) - 1.0) < 1e-12 * (1.0 + b.w.norm()));
    }
}

TEST_CASE_TEMPLATE("with its own borders g is minus the smallest singular value", Scalar, double, Complex) {
    for (int n = 1; n <= 6; ++n) {
        CAPTURE(n);
        const Square<Scalar> a = filled<Scalar>(n, 3 * n);
        const auto sigma = Eigen::JacobiSVD<Square<Scalar>>(a).singularValues().eval();
        const auto b = numerics::solve_bordered<Scalar>(a);
        CHECK(std::abs(b.g + sigma[n - 1]) < 1e-14 * sigma[0]);
        const auto null = numerics::nearest_null_vectors<Scalar>(a);
        CHECK(std::abs(null.right.norm() - 1.0) < 1e-14);
        CHECK((a * null.right - sigma[n - 1] * null.left).norm() < 1e-14 * sigma[0]);
        CHECK((b.v - null.right).norm() < 1e-13);
        CHECK((b.w - null.left).norm() < 1e-13);
    }
}

TEST_CASE_TEMPLATE("a singular matrix: g is zero, v and w are its null vectors", Scalar, double, Complex) {
    for (int n = 2; n <= 6; ++n) {
        CAPTURE(n);
        const Square<Scalar> a = made_singular<Scalar>(filled<Scalar>(n, 5 * n));
        const auto b = numerics::solve_bordered<Scalar>(a);
        CHECK(std::abs(b.g) < 1e-14);
        CHECK((a * b.v).norm() < 1e-14 * b.v.norm());
        CHECK((a.adjoint() * b.w).norm() < 1e-14 * b.w.norm());
    }
}

TEST_CASE_TEMPLATE("the derivative -w^H A' v, singular or not", Scalar, double, Complex) {
    for (const bool singular : {false, true}) {
        for (int n = 2; n <= 6; ++n) {
            CAPTURE(n);
            Square<Scalar> a = filled<Scalar>(n, 7 * n);
            if (singular) { a = made_singular<Scalar>(a); }
            const Square<Scalar> change = filled<Scalar>(n, 300 + n);
            const auto borders = numerics::nearest_null_vectors<Scalar>(a);  // held while A moves
            const auto g = [&](double t) {
                return numerics::solve_bordered<Scalar>(Square<Scalar>(a + t * change), borders).g;
            };
            const auto b = numerics::solve_bordered<Scalar>(a, borders);
            const Scalar slope = -b.w.dot(change * b.v);
            // Central differences at two steps, the error of h^2 taken out.
            const double h = 1e-4;
            const Scalar coarse = (g(2.0 * h) - g(-2.0 * h)) / (4.0 * h);
            const Scalar fine = (g(h) - g(-h)) / (2.0 * h);
            const Scalar numeric = (4.0 * fine - coarse) / 3.0;
            CHECK(std::abs(slope - numeric) < 1e-9 * (1.0 + std::abs(slope)));
        }
    }
}

TEST_CASE("the smallest singular value of a matrix with known null vectors") {
    // [[1, 2], [2, 4 + e]]: det = e, null vectors (2, -1) either way.
    for (const double e : {0.0, 1e-8}) {
        Matrix a(2, 2);
        a << 1.0, 2.0, 2.0, 4.0 + e;
        const auto b = numerics::solve_bordered<double>(a);
        CHECK(std::abs(std::abs(b.g) - e / 5.0) < 1e-15);
        CHECK(std::abs(b.v[0] + 2.0 * b.v[1]) < 1e-7);
        CHECK(std::abs(b.w[0] + 2.0 * b.w[1]) < 1e-7);
    }
}

TEST_CASE("a row below") {
    Matrix a(2, 3);
    a << 1.0, 2.0, 3.0, 4.0, 5.0, 6.0;
    Vector row(3);
    row << 7.0, 8.0, 10.0;
    const Matrix m = numerics::bordered_below(a, row);
    REQUIRE(m.rows() == 3);
    CHECK(std::abs(m.determinant() + 3.0) < 1e-14);
    CHECK(m.topRows(2) == a);
    CHECK(m.row(2) == row.transpose());
}
