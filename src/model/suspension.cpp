#include "model/suspension.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numbers>
#include <span>

namespace percuss::model {

namespace {

/// Real solutions of a x + b x^3 = c in ascending order, at most three.
struct Solutions {
    std::array<double, 3> x{};
    std::size_t count = 0;
    void add(double value) { x[count++] = value; }
    [[nodiscard]] std::span<const double> all() const& { return {x.data(), count}; }
    std::span<const double> all() && = delete;  // the numbers live no longer than this does
};

/// One Newton step takes the closed form's rounding away; a double solution is left as it is.
double polished(double a, double b, double c, double x) {
    // At a double solution the slope is zero up to the square root of rounding, some 1e-8, and dividing by it would
    // throw the solution away.
    const double slope = a + 3.0 * b * x * x;
    return std::abs(slope) > 1e-8 * std::abs(a) ? x - ((a + b * x * x) * x - c) / slope : x;
}

/// By Cardano where one solution is real, by Viete's cosines where three are.
Solutions solve(double a, double b, double c) {
    Solutions found;
    if (b == 0.0) {
        if (a != 0.0) { found.add(c / a); }
        return found;
    }
    // x^3 + p x = q
    const double p = a / b;
    const double q = c / b;
    const double discriminant = 0.25 * q * q + p * p * p / 27.0;
    if (discriminant > 0.0) {
        // Cardano, the smaller cube root from the product of both so that nothing cancels
        const double larger = std::cbrt(0.5 * q + std::copysign(std::sqrt(discriminant), q));
        found.add(larger - p / (3.0 * larger));
    } else if (p == 0.0) {
        found.add(0.0);
    } else {
        const double radius = 2.0 * std::sqrt(-p / 3.0);
        const double angle = std::acos(std::clamp(4.0 * q / (radius * radius * radius), -1.0, 1.0)) / 3.0;
        // cos(angle - 4 pi/3) <= cos(angle - 2 pi/3) <= cos(angle) for an angle in [0, pi/3]: ascending.
        for (int k = 2; k >= 0; --k) { found.add(radius * std::cos(angle - 2.0 * std::numbers::pi * k / 3.0)); }
    }
    for (std::size_t k = 0; k < found.count; ++k) { found.x[k] = polished(a, b, c, found.x[k]); }
    return found;
}

/// Stable equilibria of k1 x + k3 x^3 = F0.
Solutions equilibria(const Suspension& s) {
    Solutions stable;
    // A purely cubic spring (k1 = 0) rests at zero too, where its slope is not positive as the test below asks.
    if (s.bias == 0.0 && s.stiffness >= 0.0) {
        stable.add(0.0);
        return stable;
    }
    const Solutions every = solve(s.stiffness, s.cubic, s.bias);
    for (const double x : every.all()) {
        if (s.stiffness + 3.0 * s.cubic * x * x > 0.0) { stable.add(x); }
    }
    return stable;
}

/// Whether the mass lies in the stop at x.
bool is_pressed(const Suspension& s, double x) { return s.stop_stiffness > 0.0 && x > s.gap; }

}  // namespace

double rest_position(const Suspension& s) {
    const Solutions free = equilibria(s);
    // From the largest x downwards: of two wells the one next to the stop counts.
    for (std::size_t k = free.count; k-- > 0;) {
        if (!is_pressed(s, free.x[k])) { return free.x[k]; }
    }
    if (s.stop_stiffness > 0.0) {
        // k1 x + k3 x^3 + k (x - gap) = F0
        const Solutions against = solve(s.stiffness + s.stop_stiffness, s.cubic, s.bias + s.stop_stiffness * s.gap);
        for (const double x : against.all()) {
            const double slope = s.stiffness + s.stop_stiffness + 3.0 * s.cubic * x * x;
            if (is_pressed(s, x) && slope > 0.0) { return x; }
        }
    }
    return 0.0;
}

Wells wells(const Suspension& s) {
    const Solutions free = equilibria(s);
    if (free.count == 0) { return {}; }
    return {free.x[0], free.x[free.count - 1]};
}

bool is_symmetric(const Suspension& s) { return s.bias == 0.0 && s.stiffness >= 0.0 && !is_pressed(s, 0.0); }

double natural_frequency(const Suspension& s) {
    // The stop counts where the mass rests in it.
    const double x = rest_position(s);
    double squared = s.stiffness + 3.0 * s.cubic * x * x + (is_pressed(s, x) ? s.stop_stiffness : 0.0);
    // A purely cubic spring has no linear stiffness: describing function at the static amplitude.
    if (squared == 0.0 && s.cubic > 0.0) {
        const double amplitude = std::cbrt(std::abs(s.held_force) / s.cubic);
        squared = 0.75 * s.cubic * amplitude * amplitude;
    }
    // The unit of time stands in where nothing restores the mass.
    return squared > 0.0 ? std::sqrt(squared) : 1.0;
}

void check_suspension(const Specification& spec, Key stiffness, Key cubic, std::vector<std::string>& found) {
    const double k1 = spec.value(stiffness);
    if (k1 <= 0.0 && spec.effective(cubic) <= 0.0) {
        found.push_back(assignment(stiffness, k1) + " is out of range: must be above 0 unless " +
                        std::string(key_info(cubic).name) + " is above 0");
    }
}

}  // namespace percuss::model
