#pragma once
/// \file
/// Neighbourhoods of a stable periodic orbit that motions do not leave again.
///
/// Around each strobe point y_j (theta = 0) of an orbit of n cycles stands an ellipsoid V_j(d) = d^T Q_j d <= R^2,
/// d = z - y_j, in the norm adapted to the one-cycle derivatives D_j,
///     Q_j = W + s^-2 D_j^T Q_(j+1) D_j,     W = diag(1/scale^2),
/// with s^n = sqrt(largest multiplier modulus), so that D_j shrinks |d|_j = sqrt(V_j) by s or more however non-normal
/// it is. R is the largest radius up to which the flow P itself agrees with that:
///     |P(z) - y_(j+1) - D_j d|_(j+1) <= (1 - s)/2 |d|_j
/// at every one of a set of samples on the shells R, R/2, R/4, ... of every ellipsoid. Then each cycle shrinks the
/// distance to (1 + s)/2 at most, and there is room for no other motion inside. A saddle beside a slow orbit or a
/// contact that is about to graze cuts R down: the radius itself says where the linear regime ends.

#include "flow/flow.hpp"
#include "numerics/linear.hpp"
#include "orbit/orbit.hpp"

#include <optional>
#include <span>
#include <vector>

namespace percuss::attractor {

class Trap {
public:
    /// `system` is the one that motions are followed with (its own strobe points are used, found by Newton from
    /// `orbit`); distances are measured in `scale`, one length per state.
    Trap(const flow::System& system, const orbit::Orbit& orbit, const flow::State& scale);

    [[nodiscard]] int period() const { return static_cast<int>(points_.size()); }
    [[nodiscard]] const std::vector<flow::State>& points() const { return points_; }
    /// Radius R, in units of the scale; zero when no shell passed and motions cannot be captured.
    [[nodiscard]] double radius() const { return radius_; }
    [[nodiscard]] double max_multiplier() const { return max_multiplier_; }

    /// |z - y_j|_j.
    [[nodiscard]] double norm(int j, const flow::State& z) const;
    /// The strobe point whose ellipsoid holds the state; the nearest where several do.
    [[nodiscard]] std::optional<int> holds(const flow::State& z) const;
    /// Whether a cycle that led from `before`, near y_j, to `after` agrees with the multipliers as above.
    [[nodiscard]] bool agrees(int j, const flow::State& before, const flow::State& after) const;
    /// Distance from the nearest strobe point, in units of the scale.
    [[nodiscard]] double distance(const flow::State& z) const;

private:
    [[nodiscard]] flow::State offset(int j, const flow::State& z) const;
    [[nodiscard]] double length(int j, const flow::State& d) const;
    void find_points(const flow::System& system, const orbit::Orbit& orbit);
    void adapt_norm();
    [[nodiscard]] bool shell_agrees(const flow::System& system, double radius) const;
    void find_radius(const flow::System& system);

    int states_ = 0;
    flow::State scale_{};
    std::vector<flow::State> points_;
    std::vector<numerics::SmallMatrix> derivatives_;  ///< of one cycle from each point
    std::vector<numerics::SmallMatrix> norms_;        ///< Q_j
    double max_multiplier_ = 1.0;
    double shrink_ = 1.0;  ///< s
    double radius_ = 0.0;
};

/// Watches one motion, strobe by strobe, until it is captured: inside an ellipsoid of one trap, and then from strobe
/// point to strobe point in agreement with its multipliers for a whole period of the orbit, at least three cycles.
class Watch {
public:
    /// Takes the next strobed state, with traps that stay the same from call to call but for new ones at the end;
    /// returns the number of the trap that has captured the motion.
    std::optional<int> see(const flow::State& z, std::span<const Trap* const> traps);

private:
    bool follow(const flow::State& z, const Trap& trap);
    void enter(const flow::State& z, std::span<const Trap* const> traps);

    int trap_ = -1;
    int point_ = 0;
    int agreements_ = 0;
    flow::State last_{};
};

}  // namespace percuss::attractor
