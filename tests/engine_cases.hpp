#pragma once
/// \file
/// Systems, runs and differences shared by the tests of the engine.

#include "flow/flow.hpp"
#include "kernels/kernels.hpp"
#include "model/membrane/membrane.hpp"
#include "model/spring/spring.hpp"
#include "reference_values.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <numbers>
#include <random>
#include <string_view>
#include <vector>

namespace percuss::test {

inline constexpr double pi = std::numbers::pi;
inline constexpr double two_pi = 2.0 * pi;

inline std::size_t at(int i) { return static_cast<std::size_t>(i); }

inline std::unique_ptr<flow::Integrator> membranes(model::ContactLaw law = model::ContactLaw::kelvin_voigt,
                                                   double tolerance = 1e-13, bool viscous = true) {
    kernels::IntegratorOptions options;
    options.tolerance = tolerance;
    return kernels::make_integrator(viscous ? model::membrane::viscous : model::membrane::elastic, law, options);
}
inline std::unique_ptr<flow::Integrator> spring(model::ContactLaw law = model::ContactLaw::kelvin_voigt,
                                                double tolerance = 1e-13) {
    kernels::IntegratorOptions options;
    options.tolerance = tolerance;
    return kernels::make_integrator(model::spring::scene, law, options);
}

inline flow::ParameterVector with(flow::ParameterVector p, int index, double value) {
    p[at(index)] = value;
    return p;
}

inline flow::Result run(const flow::Integrator& integrator, const flow::ParameterVector& parameters,
                        const flow::Request& request) {
    flow::Result result;
    integrator.run(parameters, request, result);
    return result;
}

/// Largest difference of two states over the entries in use.
inline double distance(const flow::State& a, const flow::State& b, int states) {
    double largest = 0.0;
    for (int k = 0; k < states; ++k) { largest = std::max(largest, std::abs(a[at(k)] - b[at(k)])); }
    return largest;
}

/// Random numbers that are the same everywhere: the standard fixes the engine but not the distributions.
class Random {
public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}
    double uniform(double low, double high) {
        return low + (high - low) * static_cast<double>(engine_() >> 11U) * 0x1.0p-53;
    }
    double log_uniform(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }

private:
    std::mt19937_64 engine_;
};

/// A numerical derivative and how far its last two extrapolations disagreed.
struct Derivative {
    double value = 0.0;
    double error = std::numeric_limits<double>::infinity();
};

/// Ridders' method: central differences with steps h, h/2, h/4, ... extrapolated in h^2; the entry of the table whose
/// neighbours agree best (C. Ridders, Advances in Engineering Software 4 (1982) 75). The error falls like h^(2 m) while
/// rounding of f grows only like 1/h, so a first step of 1e-2 of the scale on which f varies leaves about 1e-11.
template <class Function>
Derivative ridders(Function&& f, double h, int rows = 6) {
    constexpr int most = 10;
    std::array<std::array<double, most>, most> a{};
    Derivative best;
    for (int i = 0; i < rows; ++i, h *= 0.5) {
        a[at(i)][0] = (f(h) - f(-h)) / (2.0 * h);
        double factor = 4.0;
        for (int j = 1; j <= i; ++j, factor *= 4.0) {
            a[at(i)][at(j)] = (factor * a[at(i)][at(j - 1)] - a[at(i - 1)][at(j - 1)]) / (factor - 1.0);
            const double error = std::max(std::abs(a[at(i)][at(j)] - a[at(i)][at(j - 1)]),
                                          std::abs(a[at(i)][at(j)] - a[at(i - 1)][at(j - 1)]));
            if (error <= best.error) { best = {a[at(i)][at(j)], error}; }
        }
    }
    return best;
}

/// The same for a function with several components, all evaluated at once.
template <class Function>
std::vector<Derivative> ridders_many(Function&& f, std::size_t components, double h, int rows = 6) {
    std::vector<std::vector<double>> plus;
    std::vector<std::vector<double>> minus;
    double step = h;
    for (int i = 0; i < rows; ++i, step *= 0.5) {
        plus.push_back(f(step));
        minus.push_back(f(-step));
    }
    std::vector<Derivative> found;
    for (std::size_t c = 0; c < components; ++c) {
        found.push_back(ridders(
            [&](double s) {
                const auto row = static_cast<std::size_t>(std::lround(std::log2(h / std::abs(s))));
                return s > 0.0 ? plus[row][c] : minus[row][c];
            },
            h, rows));
    }
    return found;
}

/// An observable by name; call it with the observables of a run.
struct NamedObservable {
    std::string_view name;
    const flow::Sensitive& (*member)(const flow::Observables&);
};
template <flow::Sensitive flow::Observables::*Member>
const flow::Sensitive& one_of(const flow::Observables& all) {
    return all.*Member;
}
template <std::size_t K>
const flow::Sensitive& peak_of(const flow::Observables& all) {
    return all.peak[K];
}
inline constexpr std::array<NamedObservable, 12> observables = {{
    {"x_max", one_of<&flow::Observables::x_max>},
    {"x_min", one_of<&flow::Observables::x_min>},
    {"peak_force", one_of<&flow::Observables::peak_force>},
    {"impact_velocity", one_of<&flow::Observables::impact_velocity>},
    {"contact_time", one_of<&flow::Observables::contact_time>},
    {"impulse", one_of<&flow::Observables::impulse>},
    {"stop_work", one_of<&flow::Observables::stop_work>},
    {"peak_acceleration", one_of<&flow::Observables::peak_acceleration>},
    {"peak_field", peak_of<model::membrane::field>},
    {"peak_current", peak_of<model::membrane::current>},
    {"drive_work", one_of<&flow::Observables::drive_work>},
    {"dissipation", one_of<&flow::Observables::dissipation>},
}};

}  // namespace percuss::test
