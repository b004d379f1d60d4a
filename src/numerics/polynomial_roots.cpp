#include "numerics/polynomial_roots.hpp"

#include <algorithm>
#include <cmath>

namespace percuss::numerics {
namespace {

using Coefficients = std::array<double, max_degree + 1>;

/// Halving stops here: two roots closer than this are one touch.
/// 2^-40 of the interval is 1e-12 of an integration step.
constexpr int max_depth = 40;

struct Search {
    const double* monomial;
    int degree;
    int wanted;  ///< sign after the root, 0 for all
    Roots* roots;
    [[nodiscard]] bool full() const {
        return roots->count == static_cast<int>(roots->at.size()) || (wanted != 0 && roots->count > 0);
    }
};

/// C(n, j) for all degrees, row after row.
constexpr auto binomials = [] {
    std::array<double, (max_degree + 1) * (max_degree + 2) / 2> table{};
    std::size_t at = 0;
    for (int n = 0; n <= max_degree; ++n) {
        double binomial = 1.0;
        for (int j = 0; j <= n; ++j) {
            table[at++] = binomial;
            binomial = binomial * (n - j) / (j + 1);
        }
    }
    return table;
}();

/// The polynomial and its derivative at t, side by side.
void evaluate(const double* c, int degree, double t, double& value, double& slope) {
    value = c[degree];
    slope = degree * c[degree];
    for (int j = degree - 1; j >= 1; --j) {
        value = value * t + c[j];
        slope = slope * t + j * c[j];
    }
    if (degree > 0) { value = value * t + c[0]; }
}

/// Monomial coefficients on [0,1] to Bernstein coefficients: b_i = sum_j C(i,j)/C(n,j) c_j.
void to_bernstein(const double* c, int n, Coefficients& b) {
    const double* binomial = &binomials[static_cast<std::size_t>(n * (n + 1) / 2)];
    for (int j = 0; j <= n; ++j) { b[static_cast<std::size_t>(j)] = c[j] / binomial[j]; }
    // The sums with C(i, j) are made by Pascal's rule, in place, additions only.
    for (int level = 1; level <= n; ++level) {
        for (int i = n; i >= level; --i) { b[static_cast<std::size_t>(i)] += b[static_cast<std::size_t>(i - 1)]; }
    }
}

/// Sign changes of the coefficients, zeros left out: as many as there are roots in (0, 1), or more by an even number.
int variations(const Coefficients& b, int n) {
    int count = 0;
    int last = 0;
    for (int i = 0; i <= n; ++i) {
        const double x = b[static_cast<std::size_t>(i)];
        const int s = (x > 0.0) - (x < 0.0);
        if (s != 0) {
            if (last != 0 && s != last) { ++count; }
            last = s;
        }
    }
    return count;
}

/// The root between lower and upper, where the polynomial has the signs -after and after: Newton kept inside a
/// shrinking bracket.
double polish(const Search& search, double lower, double upper, int after) {
    double t = 0.5 * (lower + upper);
    // A cap: halving alone comes to the spacing of doubles below 1 in 53 rounds, Newton's steps in a few.
    for (int iteration = 0; iteration < 80; ++iteration) {
        double value = 0.0;
        double slope = 0.0;
        evaluate(search.monomial, search.degree, t, value, slope);
        if (value == 0.0) { return t; }
        // The side is told by the sign alone: a product of values could underflow.
        ((value > 0.0) == (after > 0) ? upper : lower) = t;
        double next = t - value / slope;
        // Also where the slope vanishes and next is infinite or NaN.
        if (!(next > lower && next < upper)) { next = 0.5 * (lower + upper); }
        if (std::abs(next - t) <= 1e-16 || next == t) { return next; }
        t = next;
    }
    return t;
}

/// Adds a root, with the sign that the polynomial has after it, where that sign is wanted.
void record(const Search& search, double t, int after) {
    if (search.wanted != 0 && after != search.wanted) { return; }
    Roots& r = *search.roots;
    r.at[static_cast<std::size_t>(r.count)] = t;
    r.sign[static_cast<std::size_t>(r.count)] = after;
    ++r.count;
}

/// The roots inside (lower, lower + width), where the polynomial has Bernstein coefficients b; in increasing order.
void isolate(const Search& search, const Coefficients& b, double lower, double width, int depth) {
    const int n = search.degree;
    const int changes = variations(b, n);
    if (changes == 0 || search.full()) { return; }
    if (changes == 1) {
        // One sign change is one root exactly; the last coefficient that is not zero has the sign after it.
        int after = 0;
        for (int i = n; i >= 0 && after == 0; --i) {
            const double x = b[static_cast<std::size_t>(i)];
            after = (x > 0.0) - (x < 0.0);
        }
        record(search, polish(search, lower, lower + width, after), after);
        return;
    }
    if (depth == max_depth) { return; }
    Coefficients left{};  // de Casteljau at one half
    Coefficients right{};
    Coefficients work = b;
    for (int level = 0; level <= n; ++level) {
        left[static_cast<std::size_t>(level)] = work[0];
        right[static_cast<std::size_t>(n - level)] = work[static_cast<std::size_t>(n - level)];
        for (int i = 0; i < n - level; ++i) {
            work[static_cast<std::size_t>(i)] =
                0.5 * (work[static_cast<std::size_t>(i)] + work[static_cast<std::size_t>(i + 1)]);
        }
    }
    isolate(search, left, lower, 0.5 * width, depth + 1);
    // The halves are open intervals: neither sees a root on their common end.
    const double middle = left[static_cast<std::size_t>(n)];
    if (middle == 0.0 && !search.full()) {  // a root exactly between the halves
        const auto first_sign = [](const Coefficients& c, int from, int to, int step) {
            for (int i = from; i != to; i += step) {
                const double x = c[static_cast<std::size_t>(i)];
                if (x != 0.0) { return x > 0.0 ? 1 : -1; }
            }
            return 0;
        };
        const int before = first_sign(left, n, -1, -1);
        const int after = first_sign(right, 0, n + 1, 1);
        if (before != 0 && after != 0 && before != after) { record(search, lower + 0.5 * width, after); }
    }
    isolate(search, right, lower + 0.5 * width, 0.5 * width, depth + 1);
}

/// A root at the upper end, where as many Bernstein coefficients vanish as its multiplicity.
void check_upper_end(const Search& search, const Coefficients& b) {
    int last = search.degree;
    while (last > 0 && b[static_cast<std::size_t>(last)] == 0.0) { --last; }
    // A multiple root of even order touches; the last coefficient that is not zero has the sign before the end.
    const bool crosses = (search.degree - last) % 2 == 1;
    if (crosses && !search.full()) { record(search, 1.0, b[static_cast<std::size_t>(last)] > 0.0 ? -1 : 1); }
}

Roots run(const double* c, int degree, int wanted) {
    Roots roots;
    // Vanishing leading coefficients are no roots; without them the loops are as short as the polynomial is.
    while (degree > 0 && c[degree] == 0.0) { --degree; }
    if (degree <= 0) { return roots; }
    Coefficients b{};
    to_bernstein(c, degree, b);
    const Search search{c, degree, wanted, &roots};
    isolate(search, b, 0.0, 1.0, 0);
    check_upper_end(search, b);
    return roots;
}

}  // namespace

Roots sign_changes(const double* c, int degree) { return run(c, degree, 0); }

bool first_sign_change(const double* c, int degree, int sign, double& t) {
    const Roots roots = run(c, degree, sign);
    if (roots.count == 0) { return false; }
    t = roots.at[0];
    return true;
}

}  // namespace percuss::numerics
