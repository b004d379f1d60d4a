#include "design/band.hpp"

#include "attractor/ensemble.hpp"
#include "boundary/critical.hpp"
#include "branch/trace.hpp"
#include "design/families.hpp"
#include "design/reach.hpp"
#include "design/window.hpp"
#include "orbit/polish.hpp"

#include <algorithm>
#include <cmath>

namespace percuss::design {
namespace {

using boundary::Kind;

constexpr int places = 6;        ///< frequencies looked at on either side
constexpr int places_again = 2;  ///< between the operating point and an end that starts have moved
/// The branch is followed within these multiples of the operating frequency.
/// Ends further off are not looked for.
constexpr double range_below = 0.3;
constexpr double range_above = 3.0;

class Search {
public:
    Search(const BandCase& c, const model::Specification& design) : c_(c), design_(design) {}

    Band run() {
        follow_branch();
        meet_free_motion();
        if (c_.sampling != nullptr) {
            look_for_others(band_.lower);
            look_for_others(band_.upper);
        }
        if (cut_short_) { leave_open(); }
        return std::move(band_);
    }

private:
    /// Where starts could not be followed to the end other motions may stand: no end is known then.
    void leave_open() {
        for (BandEnd* end : {&band_.lower, &band_.upper}) {
            *end = BandEnd{};
            end->reason = "the starts were not followed to the end";
        }
    }

    /// The first boundary on either side at which the motion ceases to be stable or to strike.
    void follow_branch() {
        const flow::ParameterFamily family = frequency_family(c_.system);
        const double omega = c_.system.omega();
        // Each way by itself; only the first end counts, since beyond it the motion is unstable or another one.
        for (const bool up : {false, true}) {
            branch::TraceOptions options;
            options.from = omega * range_below;
            options.to = omega * range_above;
            options.size = motion_size(c_.system);
            options.max_points = 400;
            const branch::Branch traced =
                branch::trace(family, {orbit::motion_of(c_.system, c_.orbit), omega, up ? 1.0 : -1.0, {}}, options);
            for (const branch::BoundaryPoint& found : traced.boundaries) {
                if (!ends_band(traced, found)) { continue; }
                set(up ? band_.upper : band_.lower, found.kind, found.point.motion, found.contact, found.angle,
                    found.point.parameter, std::string(boundary::to_string(found.kind)));
                break;
            }
        }
    }

    /// A fold, flip or torus ends it; a grazing only where the motion behind does not strike or is not stable.
    static bool ends_band(const branch::Branch& traced, const branch::BoundaryPoint& found) {
        if (found.kind != Kind::grazing) { return true; }
        const std::size_t behind = found.after + 1;
        // Nothing is known behind it: an end, rather than a promise that the band goes on.
        if (behind >= traced.points.size()) { return true; }
        return !traced.points[behind].stable() || traced.points[behind].contacts.empty();
    }

    void set(BandEnd& end, Kind kind, const orbit::Motion& motion, int contact, double angle, double omega,
             const std::string& reason) const {
        const flow::System there = c_.system.at_omega(omega);
        const flow::ParameterFamily family = frequency_family(there);
        // Again, for the derivatives along the keys, which a branch does not carry. Where that fails the frequency
        // stands as it was found, without a gradient.
        const auto exact = boundary::solve_critical(family, kind, motion, omega, contact, angle, motion_size(c_.system),
                                                    c_.directions);
        end.found = true;
        end.omega = exact.ok() ? exact.parameter : omega;
        end.d_omega = exact.d_parameter;
        end.error = 1e-12 * omega;
        end.reason = reason;
    }

    /// Above the edge the motion clear of the stop is stable too: the tuned one is no longer alone.
    void meet_free_motion() {
        const bool nearer =
            c_.edge_omega > c_.system.omega() && (!band_.upper.found || c_.edge_omega < band_.upper.omega);
        if (!nearer) { return; }
        band_.upper.found = true;
        band_.upper.omega = c_.edge_omega;
        band_.upper.d_omega.assign(c_.d_edge.begin(), c_.d_edge.end());
        band_.upper.error = 1e-12 * c_.edge_omega;
        band_.upper.reason = "edge: the motion clear of the stop exists above";
    }

    /// Starts at frequencies from the operating point outwards.
    void look_for_others(BandEnd& end) {
        if (!end.found) { return; }
        const double omega = c_.system.omega();
        double clear = omega;  // up to here nothing was found
        // From the operating point outwards, so that the first counterexample is the nearest one. It moves the end
        // inwards and with it the spacing: once more, over the shorter band.
        for (int count = places; count > 0;) {
            const double far = end.omega;
            bool moved = false;
            for (int i = 1; i <= count && !moved && !cut_short_; ++i) {
                const double at = omega + (far - omega) * i / (count + 1.0);
                moved = refuted_at(at, clear, end);
                if (!moved) { clear = at; }
            }
            if (!moved || count == places_again || cut_short_) { return; }
            clear = omega;
            count = places_again;
        }
    }

    /// Whether a start at this frequency leads elsewhere; `end` is then where that other motion's window begins.
    bool refuted_at(double at, double clear, BandEnd& end) {
        using Status = attractor::Refutation::Status;
        const flow::System exact = c_.system.at_omega(at);
        const flow::System scout = c_.scout.at_omega(at);
        const auto here = continue_orbit(c_.system, c_.orbit, at);
        if (!here) { return false; }
        attractor::EnsembleOptions options;
        options.starts = c_.sampling->starts;
        options.seed = c_.sampling->seed;
        options.jobs = c_.sampling->jobs;
        options.max_cycles = c_.sampling->cycles;
        const orbit::Orbit tuned = orbit::polish_orbit(exact, orbit::state_at_zero(exact, *here), here->map.period);
        if (!tuned.ok() || !(orbit::max_multiplier(tuned) < 1.0)) { return false; }
        // 0: the box takes its size from the gap alone, since the amplitude at this frequency has not been measured.
        const auto answer = attractor::refute({exact, scout}, tuned, attractor::ensemble_box(exact, 0.0), options);
        band_.starts += answer.starts;
        if (answer.status == Status::cancelled || answer.status == Status::budget_spent) { cut_short_ = true; }
        if (answer.status != Status::refuted) { return false; }
        const bool below = at < c_.system.omega();
        const bool periodic = answer.other->kind == attractor::Kind::periodic;
        end.found = true;
        // Until the window is known: somewhere between the last place without and the first with a counterexample.
        end.omega = 0.5 * (clear + at);
        end.error = 0.5 * std::abs(clear - at);
        end.d_omega.clear();
        end.reason = periodic ? "a motion of period " + std::to_string(answer.other->period) : "an aperiodic motion";
        if (!periodic) { return true; }
        const Intruder intruder = find_window(exact, design_, answer.other->orbit);
        const WindowEnd& near = below ? intruder.highest : intruder.lowest;
        // A window that reaches over a place where no start met its motion contradicts what was seen (its motion may be
        // unstable there, or its basin small): the bracket stays.
        const bool usable = intruder.ok && (below ? near.omega <= clear : near.omega >= clear);
        if (usable) {
            set(end, near.kind, near.motion, near.contact, near.angle, near.omega, "window of " + end.reason);
        }
        return true;
    }

    const BandCase& c_;
    const model::Specification& design_;
    Band band_;
    bool cut_short_ = false;
};

}  // namespace

Band single_stable_band(const BandCase& c, const model::Specification& design) { return Search(c, design).run(); }

}  // namespace percuss::design
