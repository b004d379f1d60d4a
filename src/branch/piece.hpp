#pragma once
/// \file
/// The smooth part of a branch: motions of one form followed by pseudo-arclength.

#include "branch/point.hpp"
#include "numerics/arclength.hpp"

#include <memory>

namespace percuss::branch {

struct StepOptions {
    double first_step = 0.02;
    double largest_step = 0.25;           ///< in units of the unknowns
    double largest_parameter_step = 0.1;  ///< in units of the parameter
    double target_angle = 0.12;           ///< between tangents, rad (about 7 degrees)
};

/// A walker over the motions of one form. Unknowns are measured in orbit::unit_of_unknowns.
class Piece {
public:
    /// like: form of the motions; size: of the motion, for the units.
    Piece(const flow::ParameterFamily& family, orbit::Motion like, double size, const StepOptions& options);
    Piece(const Piece&) = delete;
    Piece& operator=(const Piece&) = delete;

    /// Sets out from near a motion towards rising (+1) or falling (-1) parameter.
    bool start(const orbit::Motion& motion, double parameter, double direction);
    /// Sets out with the entry speed of one contact held at its value, towards higher speed.
    bool start_with_speed(const orbit::Motion& motion, double parameter, int contact);
    /// Sets out from motion + distance x direction (scaled unknowns), held at right angles to it: onto a branch that
    /// leaves another one in that direction.
    bool start_off(const orbit::Motion& motion, double parameter, const numerics::Vector& direction, double distance);

    bool advance() { return walker_.advance(); }
    bool retreat() { return walker_.retreat(); }
    void set_step(double step) { walker_.set_step(step); }
    [[nodiscard]] double step() const { return walker_.step(); }

    [[nodiscard]] orbit::Motion motion() const { return motion_of(walker_.point()); }
    [[nodiscard]] double parameter() const { return parameter_of(walker_.point()); }
    [[nodiscard]] const numerics::Vector& point() const { return walker_.point(); }
    /// Sign and size of the parameter's change along the curve, scaled.
    [[nodiscard]] double slope() const { return walker_.tangent()[walker_.tangent().size() - 1]; }
    [[nodiscard]] const numerics::Vector& tangent() const { return walker_.tangent(); }

    /// Motion and parameter at a distance along the curve from where the walker stands (which stays).
    struct Probe {
        orbit::Motion motion;
        double parameter = 0.0;
        double slope = 0.0;
    };
    std::optional<Probe> probe(double distance);

    [[nodiscard]] orbit::Motion motion_of(const numerics::Vector& u) const;
    [[nodiscard]] double parameter_of(const numerics::Vector& u) const;
    [[nodiscard]] numerics::Vector scaled(const orbit::Motion& motion, double parameter) const;
    [[nodiscard]] const numerics::Vector& units() const { return units_; }

private:
    bool evaluate(const numerics::Vector& u, numerics::Vector& f, numerics::Matrix& jacobian) const;

    const flow::ParameterFamily& family_;
    orbit::Motion like_;
    numerics::Vector units_;
    numerics::ArclengthWalker walker_;
};

}  // namespace percuss::branch
