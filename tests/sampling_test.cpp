// Sobol's sequence, plain and scrambled, Latin hypercubes and grids.

#include "numerics/sampling.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

using namespace percuss;
using numerics::Matrix;

namespace {

/// How many points of columns a and b lie in each of the 2^p x 2^q boxes with sides 2^-p, 2^-q.
std::vector<int> box_counts(const Matrix& points, Eigen::Index a, int p, Eigen::Index b, int q) {
    std::vector<int> counts(std::size_t{1} << (p + q), 0);
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
        const auto x = static_cast<std::size_t>(points(i, a) * std::ldexp(1.0, p));
        const auto y = static_cast<std::size_t>(points(i, b) * std::ldexp(1.0, q));
        ++counts[(x << q) | y];
    }
    return counts;
}

bool all_ones(const std::vector<int>& counts) {
    return std::all_of(counts.begin(), counts.end(), [](int count) { return count == 1; });
}

bool in_unit_cube(const Matrix& points) { return (points.array() >= 0.0).all() && (points.array() < 1.0).all(); }

/// Root mean square error over seeds of the mean of prod (1 + (x_j - 1/2)), which is 1.
double integration_error(Eigen::Index points) {
    const int seeds = 40;
    double sum = 0.0;
    for (int seed = 0; seed < seeds; ++seed) {
        const Matrix x = numerics::scrambled_sobol(4, static_cast<std::uint64_t>(seed))->rows(0, points);
        const double error = (x.array() + 0.5).rowwise().prod().mean() - 1.0;
        sum += error * error;
    }
    return std::sqrt(sum / seeds);
}

}  // namespace

TEST_CASE("plain Sobol points are the published ones") {
    // First ten points in three dimensions of Joe and Kuo's own generator with new-joe-kuo-6 direction numbers.
    const Matrix points = numerics::plain_sobol(3)->rows(0, 10);
    const double expected[10][3] = {{0, 0, 0},
                                    {0.5, 0.5, 0.5},
                                    {0.75, 0.25, 0.25},
                                    {0.25, 0.75, 0.75},
                                    {0.375, 0.375, 0.625},
                                    {0.875, 0.875, 0.125},
                                    {0.625, 0.125, 0.875},
                                    {0.125, 0.625, 0.375},
                                    {0.1875, 0.3125, 0.9375},
                                    {0.6875, 0.8125, 0.4375}};
    for (Eigen::Index i = 0; i < 10; ++i) {
        for (Eigen::Index j = 0; j < 3; ++j) { CHECK(points(i, j) == expected[i][j]); }
    }
}

TEST_CASE("blocks stand alone: any block equals the same rows of a long run, also after billions of rows") {
    for (const auto& points :
         {numerics::plain_sobol(5), numerics::scrambled_sobol(5, 7), numerics::latin_hypercube(5, 640, 7)}) {
        const Matrix whole = points->rows(0, 640);
        for (Eigen::Index block = 9; block >= 0; --block) {
            const Matrix rows = points->rows(static_cast<std::uint64_t>(64 * block), 64);
            CHECK((rows.array() == whole.middleRows(64 * block, 64).array()).all());
        }
        CHECK(in_unit_cube(whole));
    }
    const auto points = numerics::scrambled_sobol(6, 1);
    const std::uint64_t far = (std::uint64_t{1} << 40) + 3;
    CHECK((points->rows(far, 64).bottomRows(60).array() == points->rows(far + 4, 60).array()).all());
}

TEST_CASE("scrambled prefixes of 2^m points, and aligned runs further on, are stratified") {
    const int dimensions = 6;
    for (const std::uint64_t seed : {1U, 2U, 12345U}) {
        const auto sequence = numerics::scrambled_sobol(dimensions, seed);
        for (const int m : {1, 3, 6, 10}) {
            const Eigen::Index count = Eigen::Index{1} << m;
            for (const std::uint64_t run : {0U, 1U, 5U}) {
                const Matrix points = sequence->rows(run * static_cast<std::uint64_t>(count), count);
                CAPTURE(seed);
                CAPTURE(m);
                for (Eigen::Index j = 0; j < dimensions; ++j) { CHECK(all_ones(box_counts(points, j, m, j, 0))); }
                // The first two coordinates are a (0, m, 2)-net: one point in each box of area 2^-m, of every shape.
                for (int p = 0; p <= m; ++p) { CHECK(all_ones(box_counts(points, 0, p, 1, m - p))); }
            }
        }
    }
}

TEST_CASE("scrambling is random: seeds differ, every digit is scrambled, each point is uniform") {
    const Matrix one = numerics::scrambled_sobol(4, 1)->rows(0, 64);
    const Matrix two = numerics::scrambled_sobol(4, 2)->rows(0, 64);
    CHECK((one.array() != two.array()).all());
    CHECK(one.col(0) != one.col(1));

    // Row 0 over 4096 seeds: mean and mean square of a uniform number, within four standard errors.
    const int seeds = 4096;
    double sum = 0.0;
    double squares = 0.0;
    int low_digit = 0;
    for (int seed = 0; seed < seeds; ++seed) {
        const double x = numerics::scrambled_sobol(2, static_cast<std::uint64_t>(seed))->rows(0, 1)(0, 1);
        sum += x;
        squares += x * x;
        low_digit += static_cast<int>(static_cast<std::uint64_t>(std::ldexp(x, 53)) & 1U);
    }
    CHECK(std::abs(sum / seeds - 0.5) < 4.0 * std::sqrt(1.0 / 12.0 / seeds));
    CHECK(std::abs(squares / seeds - 1.0 / 3.0) < 4.0 * std::sqrt(4.0 / 45.0 / seeds));
    CHECK(std::abs(low_digit / double{seeds} - 0.5) < 4.0 * 0.5 / std::sqrt(seeds));
}

TEST_CASE("means converge faster than Monte Carlo") {
    // Scrambled nets: N^-3/2 times logarithms for a smooth integrand, a factor 64 from 256 to 4096 points; Monte Carlo
    // gives 4. Plain Sobol points or a mere digital shift would stay near N^-1, a factor 16.
    const double coarse = integration_error(256);
    const double fine = integration_error(4096);
    CAPTURE(coarse);
    CAPTURE(fine);
    CHECK(coarse / fine > 32.0);
    // The integrand has variance (1 + 1/12)^4 - 1: independent points would be off by 9.6e-3.
    CHECK(fine < 9.6e-3 / 300.0);
}

TEST_CASE("a Latin hypercube has one point in each stratum of each coordinate") {
    for (const int samples : {1, 2, 3, 7, 64, 100, 1000, 4097}) {
        const Matrix points = numerics::latin_hypercube(6, static_cast<std::uint64_t>(samples), 3)->rows(0, samples);
        CAPTURE(samples);
        for (Eigen::Index j = 0; j < points.cols(); ++j) {
            std::set<int> strata;
            for (Eigen::Index i = 0; i < samples; ++i) { strata.insert(static_cast<int>(points(i, j) * samples)); }
            CHECK(static_cast<int>(strata.size()) == samples);
        }
    }
    const Matrix one = numerics::latin_hypercube(3, 100, 1)->rows(0, 100);
    const Matrix two = numerics::latin_hypercube(3, 100, 2)->rows(0, 100);
    CHECK((one.array() != two.array()).all());
    // Coordinates are permuted independently: correlations stay within four standard errors.
    const Matrix many = numerics::latin_hypercube(4, 4096, 1)->rows(0, 4096).array() - 0.5;
    for (Eigen::Index a = 0; a < 4; ++a) {
        for (Eigen::Index b = 0; b < a; ++b) {
            CHECK(std::abs(12.0 * many.col(a).dot(many.col(b)) / 4096.0) < 4.0 / std::sqrt(4096.0));
        }
    }
    // The largest table allowed, near its end.
    const std::uint64_t largest = std::uint64_t{1} << 31;
    CHECK(in_unit_cube(numerics::latin_hypercube(2, largest, 1)->rows(largest - 64, 64)));
}

TEST_CASE("a grid has all combinations, the last coordinate fastest") {
    const auto grid = numerics::grid({2, 1, 3});
    REQUIRE(grid->size() == 6);
    const Matrix points = grid->rows(0, 6);
    const double expected[6][3] = {{0, 0.5, 0}, {0, 0.5, 0.5}, {0, 0.5, 1}, {1, 0.5, 0}, {1, 0.5, 0.5}, {1, 0.5, 1}};
    for (Eigen::Index i = 0; i < 6; ++i) {
        for (Eigen::Index j = 0; j < 3; ++j) { CHECK(points(i, j) == expected[i][j]); }
    }
    CHECK((grid->rows(4, 2).array() == points.bottomRows(2).array()).all());

    CHECK(numerics::grid_levels(std::vector<int>{0, 4, 0}, 1000) == std::vector<int>{15, 4, 15});
    CHECK(numerics::grid_levels(std::vector<int>{0, 0, 0}, 1000) == std::vector<int>{10, 10, 10});
    CHECK(numerics::grid_levels(std::vector<int>{3, 4}, 1000) == std::vector<int>{3, 4});
    CHECK_THROWS_AS(numerics::grid_levels(std::vector<int>{0, 4, 0}, 15), std::invalid_argument);
    CHECK_THROWS_AS(numerics::grid_levels(std::vector<int>{3, 4}, 11), std::invalid_argument);
    CHECK_THROWS_AS(numerics::grid_levels(std::vector<int>{-1}, 11), std::invalid_argument);
}

TEST_CASE("misuse is refused") {
    CHECK_THROWS_AS(numerics::plain_sobol(0), std::invalid_argument);
    CHECK_THROWS_AS(numerics::scrambled_sobol(3668, 1), std::invalid_argument);
    CHECK_THROWS_AS(numerics::latin_hypercube(0, 10, 1), std::invalid_argument);
    CHECK_THROWS_AS(numerics::latin_hypercube(2, 0, 1), std::invalid_argument);
    CHECK_THROWS_AS(numerics::grid({}), std::invalid_argument);
    CHECK_THROWS_AS(numerics::grid({2, 0}), std::invalid_argument);
    CHECK_THROWS_AS(numerics::latin_hypercube(2, 10, 1)->rows(5, 6), std::invalid_argument);
    CHECK_THROWS_AS(numerics::plain_sobol(2)->rows(std::uint64_t{1} << 53, 1), std::invalid_argument);
    CHECK_THROWS_AS(numerics::plain_sobol(2)->rows(0, -1), std::invalid_argument);
}

TEST_CASE("the table of samplings makes each of them, and only sobol can be extended") {
    const numerics::SamplingRequest request{{0, 3}, 64, 5};
    for (const auto& sampling : numerics::samplings()) {
        CAPTURE(std::string(sampling.name));
        const auto points = sampling.make(request);
        CHECK(points->dimensions() == 2);
        numerics::SamplingRequest longer = request;
        longer.samples = 128;
        const Eigen::Index shared = static_cast<Eigen::Index>(std::min<std::uint64_t>(points->size(), 64));
        const bool same = (points->rows(0, shared).array() == sampling.make(longer)->rows(0, shared).array()).all();
        CHECK(same == sampling.extendable);
    }
    CHECK(numerics::samplings().size() == 3);
}
