#include "branch/locus.hpp"

#include "boundary/critical.hpp"
#include "branch/corner.hpp"

#include <algorithm>
#include <cmath>

namespace percuss::branch {
namespace {

using boundary::CriticalEquations;
using boundary::Kind;
using numerics::ArclengthWalker;
using numerics::Matrix;
using numerics::Vector;

class Follower {
public:
    Follower(const flow::ParameterFamily& family, const BoundaryPoint& start, const LocusOptions& options)
        : family_(family),
          options_(options),
          start_(start),
          equations_(family, start.kind, start.point.motion, start.contact, options.size),
          walker_([this](const Vector& u, Vector& f, Matrix& j) { return evaluate(u, f, j); },
                  // Steps as long as those of a branch (StepOptions). Test rows have differences in their Jacobian,
                  // good to some 1e-8: a last step of 1e-6 leaves little beside it. Points at values that are asked for
                  // are refined by solve_critical.
                  {.first_step = 0.02,
                   .largest_step = 0.25,
                   .largest_parameter_step = 0.1,
                   .target_angle = 0.12,
                   .tolerance = 1e-8,
                   .step_tolerance = 1e-6}) {}

    Locus run() {
        const std::array<double, 2> p = {start_.point.omega, options_.from};
        const Vector u = equations_.pack(start_.point.motion, start_.angle, p);
        if (!walker_.start(u, options_.to > options_.from ? 1.0 : -1.0)) {
            lose("Newton's method on the boundary's equations did not converge at the start");
            return std::move(locus_);
        }
        add(walker_.point());
        while (can_continue()) { step(); }
        return std::move(locus_);
    }

private:
    bool evaluate(const Vector& u, Vector& f, Matrix& jacobian) const {
        auto r = equations_.evaluate(u, {});
        if (!r) { return false; }
        f = std::move(r->value);
        jacobian = std::move(r->jacobian);
        return true;
    }

    [[nodiscard]] bool can_continue() {
        if (locus_.end != End::not_run) { return false; }
        if (static_cast<int>(locus_.points.size()) >= options_.max_points ||
            (options_.cancelled && options_.cancelled())) {
            locus_.end = End::budget;
            locus_.end_reason = "as many points as were allowed";
            return false;
        }
        return true;
    }

    void lose(std::string reason) {
        locus_.end = End::lost;
        locus_.end_reason = std::move(reason);
    }

    void step() {
        const Vector before = walker_.point();
        const Vector tangent_before = walker_.tangent();
        if (!walker_.advance()) { return lose("the step length collapsed"); }
        const Vector& u = walker_.point();
        const orbit::Motion motion = equations_.motion(u);
        // Beyond the speed of zero the equations still have solutions, but no motion is one of them.
        if (start_.kind != Kind::grazing && contact_leaving(motion)) {
            // Near grazing the speed is tiny beside everything else: the step may only have been too long.
            if (walker_.step() > shortest_step && walker_.retreat()) { return; }
            return lose("the motion grazes: the boundary ends on a grazing curve");
        }
        note_turn(before, tangent_before);
        add_exact(before, u);
        const std::vector<double> p = equations_.parameters(u);
        const double low = std::min(options_.from, options_.to);
        const double high = std::max(options_.from, options_.to);
        if (p[1] < low || p[1] > high) {
            add_at(before, u, p[1] < low ? low : high);
            locus_.end = End::range;
        } else if (p[0] < options_.lowest_omega || p[0] > options_.highest_omega) {
            locus_.end = End::range;
            locus_.end_reason = "the drive frequency left its range";
        } else {
            add(u);
        }
    }

    /// Sign change of the value's slope: refined along the arc by the secant method. At a cusp the frequency's slope
    /// passes through zero with it, as the curve's tangent is there the null vector of the fold.
    void note_turn(const Vector& before, const Vector& tangent_before) {
        const auto last = tangent_before.size() - 1;
        const double slope_before = tangent_before[last];
        const double slope = walker_.tangent()[last];
        if (slope_before * slope >= 0.0) { return; }
        double low = -(walker_.point() - before).norm();
        double high = 0.0;
        double f_low = slope_before;
        double f_high = slope;
        Vector u = walker_.point();
        Vector tangent = walker_.tangent();
        // The bracket's one end may stay for long under the secant method: every third time it is halved instead.
        for (int iteration = 0; iteration < 30 && high - low > 1e-9; ++iteration) {
            double at = low - f_low * (high - low) / (f_high - f_low);
            if (iteration % 3 == 2) { at = 0.5 * (low + high); }
            if (!walker_.probe(at, u, tangent)) { break; }
            ++locus_.solves;
            if (tangent[last] * f_low > 0.0) {
                low = at;
                f_low = tangent[last];
            } else {
                high = at;
                f_high = tangent[last];
            }
            if (std::abs(tangent[last]) < 1e-10) { break; }
        }
        const std::vector<double> p = equations_.parameters(u);
        const bool omega_turns = tangent_before[last - 1] * walker_.tangent()[last - 1] < 0.0;
        // Located to 1e-9 along the arc, a cusp leaves the frequency's slope far below 1e-4; at another turn of the
        // value nothing makes it small.
        locus_.turns.push_back(
            {p[0], p[1], start_.kind == Kind::fold && omega_turns && std::abs(tangent[last - 1]) < 1e-4});
    }

    void add_exact(const Vector& a, const Vector& b) {
        const double va = equations_.parameters(a)[1];
        const double vb = equations_.parameters(b)[1];
        std::vector<double> passed;
        for (double value : options_.exact) {
            if ((value - va) * (value - vb) < 0.0) { passed.push_back(value); }
        }
        // In the order in which the step passed them.
        std::sort(passed.begin(), passed.end(), [&](double x, double y) { return (x < y) == (va < vb); });
        for (double value : passed) { add_at(a, b, value); }
    }

    /// The boundary at a value between two points, solved for in the frequency; left out where the solution is not
    /// between them: near a turn the curve has two points at that value.
    void add_at(const Vector& a, const Vector& b, double value) {
        const double va = equations_.parameters(a)[1];
        const double vb = equations_.parameters(b)[1];
        const Vector guess = a + (value - va) / (vb - va) * (b - a);
        // The family with its second parameter held at the value.
        flow::ParameterFamily by_omega;
        by_omega.base = family_.base;
        by_omega.units = {family_.units.front()};
        by_omega.parameters = [this, value](std::span<const double> p) {
            return family_.parameters(std::array<double, 2>{p[0], value});
        };
        by_omega.directions = [this, value](std::span<const double> p) {
            auto both = family_.directions(std::array<double, 2>{p[0], value});
            both.resize(1);
            return both;
        };
        const double omega = equations_.parameters(guess)[0];
        const auto exact = boundary::solve_critical(by_omega, start_.kind, equations_.motion(guess), omega,
                                                    start_.contact, equations_.angle(guess), options_.size);
        ++locus_.solves;
        if (!exact.ok()) { return; }
        const Vector chord = b - a;
        const Vector along = equations_.pack(exact.motion, exact.angle, std::array<double, 2>{exact.parameter, value});
        const double share = (along - a).dot(chord) / chord.squaredNorm();
        if (!(share >= 0.0 && share <= 1.0)) { return; }
        add_point(exact.motion, exact.parameter, value, exact.angle);
    }

    void add(const Vector& u) {
        const std::vector<double> p = equations_.parameters(u);
        add_point(equations_.motion(u), p[0], p[1], equations_.angle(u));
    }

    void add_point(const orbit::Motion& motion, double omega, double value, double angle) {
        ++locus_.solves;
        const flow::ParameterFamily fixed = flow::along_frequency(
            family_.base.with(family_.parameters(std::array<double, 2>{omega, value})), family_.units.front());
        const Look seen = look(fixed, motion, omega);
        // A grazing contact that is the only one exerts no force; what the hybrid flow meets in it is rounding.
        const double force = start_.kind == Kind::grazing && motion.contacts() == 1 ? 0.0 : seen.point.peak_force;
        locus_.points.push_back({omega, value, force, angle, motion});
    }

    /// In scaled unknowns. Folds stand close to grazing (at an entry speed of 8.4e-5 for the paper's defaults): steps
    /// must become shorter than that before the curve is said to end there.
    static constexpr double shortest_step = 1e-7;

    const flow::ParameterFamily& family_;
    const LocusOptions& options_;
    const BoundaryPoint& start_;
    CriticalEquations equations_;
    ArclengthWalker walker_;
    Locus locus_;
};

}  // namespace

Locus follow_boundary(const flow::ParameterFamily& family, const BoundaryPoint& start, const LocusOptions& options) {
    return Follower(family, start, options).run();
}

}  // namespace percuss::branch
