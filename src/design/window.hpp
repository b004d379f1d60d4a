#pragma once
/// \file
/// The frequencies at which a motion that should not be there exists, stable or not, and how they move with the design.

#include "branch/branch.hpp"
#include "design/evaluate.hpp"
#include "model/specification.hpp"

#include <span>
#include <string>
#include <vector>

namespace percuss::design {

/// One end of a window: a fold or a grazing point of the motion's branch.
struct WindowEnd {
    boundary::Kind kind = boundary::Kind::none;
    orbit::Motion motion;
    int contact = 0;
    double angle = 0.0;
    double omega = 0.0;
};

/// A motion's window at the design where it was met. The branch is followed both ways through its folds, grazings and
/// cascades; the window is what it spans.
struct Intruder {
    bool ok = false;
    std::string trouble;  ///< one sentence unless ok
    int period = 0;
    model::Specification design;
    WindowEnd lower;  ///< what is followed from design to design: a grazing point beside a fold in place of the fold
    WindowEnd upper;
    WindowEnd lowest;  ///< the ends themselves
    WindowEnd highest;
};

/// orbit: the stable motion met at `system`, whose frequency lies inside the window.
Intruder find_window(const flow::System& system, const model::Specification& design, const orbit::Orbit& orbit);

/// The window of the first periodic one of the motions that refuted a design, in the order given: polished from its
/// state, then as above. Not ok when none is periodic, or the limits of `cost` (null: none) end the search.
Intruder find_window(const Evaluator& evaluator, const model::Specification& design, double omega,
                     const std::vector<Attractor>& attractors, flow::Cost* cost = nullptr);

/// Largest relative difference of two designs' values.
double distance(const model::Specification& a, const model::Specification& b);

/// The window at another design, the ends carried there by continuation (Newton at each of a few steps in the design,
/// halved on failure).
struct WindowAt {
    enum class Status : std::uint8_t { failed, found, vanished };
    Status status = Status::failed;
    double lower = 0.0;  ///< omega
    double upper = 0.0;
    std::vector<double> d_lower;  ///< along each key
    std::vector<double> d_upper;
    Intruder carried;  ///< the same motion at this design: a nearer place to set out from next time
};
WindowAt window_at(const flow::System& system, const Intruder& intruder, const model::Specification& design,
                   std::span<const model::Key> keys);

}  // namespace percuss::design
