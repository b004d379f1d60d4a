#include "branch/piece.hpp"

namespace percuss::branch {

using numerics::Matrix;
using numerics::Vector;
using orbit::Motion;

Piece::Piece(const flow::ParameterFamily& family, Motion like, double size, const StepOptions& options)
    : family_(family),
      like_(std::move(like)),
      walker_([this](const Vector& u, Vector& f, Matrix& j) { return evaluate(u, f, j); },
              // 1e-7 is below the 1e-6 within which look() wants a motion to close. More is not asked of the points
              // between boundaries, which are refined by equations of their own.
              {.first_step = options.first_step,
               .largest_step = options.largest_step,
               .largest_parameter_step = options.largest_parameter_step,
               .target_angle = options.target_angle,
               .tolerance = 1e-7,
               .step_tolerance = 1e-7}) {
    const int n = like_.unknowns(family.base);
    units_.resize(n + 1);
    units_.head(n) = orbit::unit_of_unknowns(family.base, like_, size);
    units_[n] = family.units.front();
}

Motion Piece::motion_of(const Vector& u) const {
    const auto n = u.size() - 1;
    return orbit::unpack(family_.base, u.head(n).cwiseProduct(units_.head(n)), like_);
}

double Piece::parameter_of(const Vector& u) const { return u[u.size() - 1] * units_[u.size() - 1]; }

Vector Piece::scaled(const Motion& motion, double parameter) const {
    Vector u(units_.size());
    u.head(u.size() - 1) = orbit::pack(family_.base, motion);
    u[u.size() - 1] = parameter;
    return u.cwiseQuotient(units_);
}

bool Piece::evaluate(const Vector& u, Vector& f, Matrix& jacobian) const {
    const double p = parameter_of(u);
    const flow::System system = family_.at(p);
    if (!(system.omega() > 0.0)) { return false; }
    const auto n = u.size() - 1;
    const auto r = orbit::shoot(system, motion_of(u), family_.directions({&p, 1}));
    if (!r) { return false; }
    f = r->value;
    jacobian.resize(n, n + 1);
    jacobian.leftCols(n) = r->by_unknowns * units_.head(n).asDiagonal();
    jacobian.col(n) = r->by_directions.col(0) * units_[n];
    return f.allFinite() && jacobian.allFinite();
}

bool Piece::start(const Motion& motion, double parameter, double direction) {
    return walker_.start(scaled(motion, parameter), direction);
}

bool Piece::start_with_speed(const Motion& motion, double parameter, int contact) {
    Vector direction = Vector::Zero(units_.size());
    // At grazing the parameter is stationary in the speed and says nothing of the way to go.
    direction[contact * like_.sequence.unknowns_per_contact(family_.base)] = 1.0;
    return walker_.start_along(scaled(motion, parameter), direction);
}

bool Piece::start_off(const Motion& motion, double parameter, const Vector& direction, double distance) {
    Vector along = Vector::Zero(units_.size());
    // The parameter has no part in it: from a flip it moves with the square of the distance.
    along.head(direction.size()) = direction.normalized();
    return walker_.start_along(scaled(motion, parameter) + distance * along, along);
}

std::optional<Piece::Probe> Piece::probe(double distance) {
    Vector u;
    Vector tangent;
    if (!walker_.probe(distance, u, tangent)) { return std::nullopt; }
    return Probe{motion_of(u), parameter_of(u), tangent[tangent.size() - 1]};
}

}  // namespace percuss::branch
