#include "attractor/trap.hpp"

#include "attractor/box.hpp"
#include "orbit/polish.hpp"
#include "orbit/return_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace percuss::attractor {
namespace {

using numerics::SmallMatrix;
using numerics::SmallVector;
using std::numbers::pi;

/// Shells are tried from the first of these radii that passes, doubling up to the size of the box.
/// An orbit whose linear regime is smaller than the smallest is taken as beyond capture: ten times the noise below.
constexpr double first_radius = 1e-4;
constexpr double smallest_radius = 1e-7;
constexpr double largest_radius = 1.0;
/// Below this distance the integration error of the scout (relative tolerance 1e-8), not the dynamics, decides how a
/// motion goes on.
constexpr double noise = 1e-8;
/// Multipliers below this one are not asked to contract any faster: as s -> 0 the norm, which has D^T Q D / s^2, would
/// grow without bound, and the ellipsoid with it flatten.
constexpr double fast_enough = 0.04;
/// Besides axes and eigenvectors: a kink of the map (a contact about to graze) need not lie across any of these.
constexpr int random_directions = 12;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// Directions on the unit sphere of the ellipsoid's own coordinates: axes, eigenvectors, and some at random.
std::vector<SmallVector> sample_directions(const SmallMatrix& upper, const SmallMatrix& monodromy) {
    const int n = static_cast<int>(upper.rows());
    std::vector<SmallVector> directions;
    const auto add = [&](const SmallVector& v) {
        // Real eigenvectors have no imaginary part to add.
        if (!(v.norm() > 1e-12) || !v.allFinite()) { return; }
        directions.emplace_back(v.normalized());
        directions.emplace_back(-v.normalized());
    };
    for (int k = 0; k < n; ++k) { add(SmallVector::Unit(n, k)); }
    const Eigen::EigenSolver<SmallMatrix> spectrum(monodromy);
    for (int k = 0; k < n; ++k) {
        add(upper * spectrum.eigenvectors().col(k).real());
        add(upper * spectrum.eigenvectors().col(k).imag());
    }
    Box cube;
    cube.lower.fill(-1.0);
    cube.upper.fill(1.0);
    for (int i = 0; i < random_directions; ++i) {
        const flow::State corner = start_state(cube, n, 0, i);
        add(Eigen::Map<const Eigen::VectorXd>(corner.data(), n));
    }
    return directions;
}

}  // namespace

Trap::Trap(const flow::System& system, const orbit::Orbit& orbit, const flow::State& scale)
    : states_(system.states()),
      scale_(scale) {
    find_points(system, orbit);
    adapt_norm();
    find_radius(system);
}

void Trap::find_points(const flow::System& system, const orbit::Orbit& orbit) {
    // The strobe points of the scout itself, which differ from the exact ones by its error: a motion that it follows
    // never comes nearer to those than that.
    orbit::Orbit here = orbit::find_orbit(system, orbit.map, orbit.state);
    if (!here.ok()) { here = orbit; }
    orbit::ReturnMap cycle;
    flow::State y = orbit::state_at_zero(system, here);
    SmallMatrix monodromy = SmallMatrix::Identity(states_, states_);
    for (int j = 0; j < orbit.map.period; ++j) {
        const orbit::Image image = orbit::apply(system, cycle, y, orbit::Differentiate::state);
        points_.push_back(y);
        derivatives_.emplace_back(image.derivative);
        // NaN fails every later check: no radius, nothing is captured.
        if (!image.ok()) { derivatives_.back() = SmallMatrix::Constant(states_, states_, std::nan("")); }
        monodromy = (derivatives_.back() * monodromy).eval();
        y = image.state;
    }
    max_multiplier_ = monodromy.allFinite() ? monodromy.eigenvalues().cwiseAbs().maxCoeff() : std::nan("");
}

void Trap::adapt_norm() {
    const int n = period();
    SmallMatrix weight = SmallMatrix::Zero(states_, states_);
    for (int k = 0; k < states_; ++k) { weight(k, k) = 1.0 / (scale_[index(k)] * scale_[index(k)]); }
    norms_.assign(index(n), weight);
    if (!(max_multiplier_ < 1.0)) { return; }
    // s^n is the root of the multiplier, half way (in logarithms) between the linear rate and none: with the rate
    // itself the norm would not exist, as the sum behind it does not converge.
    const double s_squared = std::pow(std::max(max_multiplier_, fast_enough), 1.0 / n);
    shrink_ = std::sqrt(s_squared);
    // Each round shrinks what is missing by s^(2n), the multiplier; so change/(1 - s^2) bounds it within 1e-6. The
    // rounds suffice up to multipliers of 0.9998. Beyond, the norm is a little off, and the shells, which are flown,
    // decide whether it serves.
    constexpr int most_rounds = 100000;
    constexpr double settled = 1e-6;
    for (int round = 0; round < most_rounds; ++round) {
        double change = 0.0;
        for (int j = n - 1; j >= 0; --j) {
            const SmallMatrix& d = derivatives_[index(j)];
            const SmallMatrix next = weight + d.transpose() * norms_[index((j + 1) % n)] * d / s_squared;
            change = std::max(change, (next - norms_[index(j)]).norm() / next.norm());
            norms_[index(j)] = next;
        }
        if (change < settled * (1.0 - s_squared)) { return; }
    }
}

double Trap::length(int j, const flow::State& d) const {
    const SmallMatrix& q = norms_[index(j)];
    double sum = 0.0;
    for (int a = 0; a < states_; ++a) {
        double row = 0.0;
        for (int b = 0; b < states_; ++b) { row += q(a, b) * d[index(b)]; }
        sum += row * d[index(a)];
    }
    return std::sqrt(sum);
}

flow::State Trap::offset(int j, const flow::State& z) const {
    flow::State d{};
    for (int k = 0; k < states_; ++k) { d[index(k)] = z[index(k)] - points_[index(j)][index(k)]; }
    return d;
}

double Trap::norm(int j, const flow::State& z) const { return length(j, offset(j, z)); }

std::optional<int> Trap::holds(const flow::State& z) const {
    std::optional<int> nearest;
    double smallest = radius_;
    for (int j = 0; j < period(); ++j) {
        const flow::State d = offset(j, z);
        double plain = 0.0;  // the norm is at least its root
        for (int k = 0; k < states_; ++k) {
            plain += d[index(k)] * d[index(k)] / (scale_[index(k)] * scale_[index(k)]);
        }
        if (!(plain <= smallest * smallest)) { continue; }
        const double here = length(j, d);
        if (here <= smallest) {
            smallest = here;
            nearest = j;
        }
    }
    return nearest;
}

bool Trap::agrees(int j, const flow::State& before, const flow::State& after) const {
    const int next = (j + 1) % period();
    const flow::State from = offset(j, before);
    flow::State defect = offset(next, after);
    for (int a = 0; a < states_; ++a) {
        for (int b = 0; b < states_; ++b) { defect[index(a)] -= derivatives_[index(j)](a, b) * from[index(b)]; }
    }
    // Near the centre the allowed defect shrinks with the distance until the integration error is larger.
    return length(next, defect) <= std::max(0.5 * (1.0 - shrink_) * length(j, from), noise);
}

double Trap::distance(const flow::State& z) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const flow::State& y : points_) {
        double sum = 0.0;
        for (int k = 0; k < states_; ++k) {
            const double d = (z[index(k)] - y[index(k)]) / scale_[index(k)];
            sum += d * d;
        }
        nearest = std::min(nearest, std::sqrt(sum));
    }
    return nearest;
}

bool Trap::shell_agrees(const flow::System& system, double radius) const {
    const int n = period();
    flow::EnsembleRequest request;
    request.duration = 2.0 * pi;
    std::vector<flow::State> shell;
    std::vector<flow::EnsembleMember> members;
    for (int j = 0; j < n; ++j) {
        SmallMatrix monodromy = SmallMatrix::Identity(states_, states_);
        for (int k = 0; k < n; ++k) { monodromy = (derivatives_[index((j + k) % n)] * monodromy).eval(); }
        const SmallMatrix upper = SmallMatrix(norms_[index(j)].llt().matrixU());
        shell.clear();
        for (const SmallVector& u : sample_directions(upper, monodromy)) {
            // Q = U^T U: |U d| = radius on the shell.
            const SmallVector d = radius * upper.triangularView<Eigen::Upper>().solve(u);
            flow::State z = points_[index(j)];
            for (int k = 0; k < states_; ++k) { z[index(k)] += d[k]; }
            shell.push_back(z);
        }
        request.states = shell;
        members.assign(shell.size(), {});
        system.run_ensemble(request, members);
        for (std::size_t i = 0; i < shell.size(); ++i) {
            if (members[i].status != flow::Status::ok || !agrees(j, shell[i], members[i].state)) { return false; }
        }
    }
    return true;
}

void Trap::find_radius(const flow::System& system) {
    if (!(max_multiplier_ < 1.0)) { return; }
    double trial = first_radius;
    while (trial >= smallest_radius && !shell_agrees(system, trial)) { trial *= 0.1; }
    if (trial < smallest_radius) { return; }
    radius_ = trial;
    // Outwards shell by shell, each agreeing before the next is asked: one far out that agrees by chance says nothing
    // of what lies within.
    while (radius_ < largest_radius && shell_agrees(system, 2.0 * radius_)) { radius_ *= 2.0; }
}

std::optional<int> Watch::see(const flow::State& z, std::span<const Trap* const> traps) {
    if (trap_ >= 0 && follow(z, *traps[index(trap_)])) {
        // A whole period; of short ones three cycles, as a motion that only passes may agree once or twice.
        const bool captured = agreements_ >= std::max(3, traps[index(trap_)]->period());
        return captured ? std::optional<int>(trap_) : std::nullopt;
    }
    enter(z, traps);
    return std::nullopt;
}

bool Watch::follow(const flow::State& z, const Trap& trap) {
    // The ellipsoid is not asked again: each cycle that agrees shrinks the distance.
    if (!trap.agrees(point_, last_, z)) { return false; }
    point_ = (point_ + 1) % trap.period();
    last_ = z;
    ++agreements_;
    return true;
}

void Watch::enter(const flow::State& z, std::span<const Trap* const> traps) {
    trap_ = -1;
    for (std::size_t i = 0; i < traps.size(); ++i) {
        const auto point = traps[i]->holds(z);
        if (!point) { continue; }
        trap_ = static_cast<int>(i);
        point_ = *point;
        last_ = z;
        agreements_ = 0;
        return;
    }
}

}  // namespace percuss::attractor
