#include "design/operating_point.hpp"

#include "design/integrators.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace percuss::design {
namespace {

/// Free orbits are looked for down to this share of the operating frequency: past it the free branch must have been
/// followed for all its orbits at the frequency itself to be known, since a softening branch turns back up at a fold
/// below.
/// A softening tip that lies further below is missed.
constexpr double followed_past = 0.93;

EdgeKind to_edge_kind(boundary::Kind kind) {
    switch (kind) {
        case boundary::Kind::none: return EdgeKind::none;
        case boundary::Kind::grazing: return EdgeKind::grazing;
        case boundary::Kind::fold: return EdgeKind::fold;
        case boundary::Kind::flip: return EdgeKind::flip;
        case boundary::Kind::torus: return EdgeKind::torus;
    }
    return EdgeKind::none;
}

OperationStatus to_status(boundary::EdgeStatus status) {
    switch (status) {
        case boundary::EdgeStatus::found: return OperationStatus::found;
        case boundary::EdgeStatus::no_impact: return OperationStatus::no_impact;
        default: return OperationStatus::failed;
    }
}

void drive_at(double omega, const DrivenDesign& design, Operation& operation) {
    operation.system = design.system.at_omega(omega);
    operation.scout = design.scout.at_omega(omega);
    operation.point.omega = omega;
    operation.point.drive_frequency = drive_frequency(omega, design.scaled.scales);
}

/// At a frequency that was given (omega, nondimensional): nothing to look for.
Operation operate_at(double omega, const DrivenDesign& design) {
    Operation operation;
    operation.status = OperationStatus::found;
    operation.point.edge_kind = EdgeKind::given;
    drive_at(omega, design, operation);
    return operation;
}

/// The fold is looked for over twice the margin, so that one just beyond it is still told with its distance; 2 % where
/// the margin is smaller than that.
double range_of_fold(double margin) { return std::max(2.0 * margin, 0.02); }

/// Relative distance from the edge down to the fold; 0 where both are one, absent where none was located.
double offset_of(const boundary::GrazingFold& fold) {
    using Status = boundary::GrazingFold::Status;
    return fold.status == Status::found ? fold.offset : fold.status == Status::at_once ? 0.0 : absent;
}

void find_neighbours(const DrivenDesign& design, double margin, boundary::FreeBranch& branch, Operation& operation) {
    // Only at a grazing does an impacting branch begin; the fold looked for lies on it.
    if (operation.edge->kind == boundary::Kind::grazing) {
        operation.fold = boundary::find_fold_beside(design.system, *operation.edge, range_of_fold(margin));
        operation.point.fold_offset = offset_of(*operation.fold);
    }
    const double omega = operation.point.omega;
    operation.free_orbits = boundary::free_orbits_at(branch, design.system, omega, followed_past * omega);
}

Operation operate_below_edge(const DrivenDesign& design, const OperationOptions& options) {
    if (const auto why = edge_ruled_out(design.system)) { throw std::invalid_argument(*why); }
    Operation operation;
    boundary::FreeBranch branch(design.scout);
    const boundary::Edge edge = boundary::find_edge(branch, design.system, {}, options.directions);
    operation.status = to_status(edge.status);
    operation.reason = edge.reason;
    operation.point.margin = options.margin;
    if (!operation.found()) { return operation; }
    operation.edge = edge.boundary;
    operation.point.edge_kind = to_edge_kind(edge.boundary.kind);
    operation.point.edge_omega = edge.boundary.omega;
    for (const double d : edge.boundary.d_omega) { operation.d_omega.push_back((1.0 - options.margin) * d); }
    drive_at((1.0 - options.margin) * edge.boundary.omega, design, operation);
    if (options.find_neighbours) { find_neighbours(design, options.margin, branch, operation); }
    return operation;
}

/// The impacting orbit at the operating frequency, which the free motion falls to below the edge.
Reached reach_below_edge(const Operation& operation) {
    // Nearer to the edge than this the free orbit, barely pushed, stays close to grazing for hundreds of cycles, and
    // within the fold beside the edge it is still stable: the impacting orbit is then reached from further down and
    // followed up.
    constexpr double clear_of_edge = 2e-3;
    const boundary::Boundary& edge = *operation.edge;
    const flow::System& system = operation.system;
    const double omega = system.omega();
    const double start = std::min(omega, edge.omega * (1.0 - clear_of_edge));
    // From the grazing state, as the device itself falls when its frequency comes down past the edge.
    Reached reached = reach_orbit(system.at_omega(start), edge.state, 1, true);
    if (start == omega || !reached.orbit.ok()) { return reached; }
    auto moved = continue_orbit(system.at_omega(start), reached.orbit, omega);
    if (!moved) {
        reached.kind = Reached::Kind::unsettled;
        reached.reason = "the impacting orbit does not reach up to the operating frequency";
        return reached;
    }
    reached.orbit = std::move(*moved);
    reached.kind = orbit::max_multiplier(reached.orbit) < 1.0 ? Reached::Kind::stable : Reached::Kind::unstable;
    return reached;
}

}  // namespace

std::optional<std::string> edge_ruled_out(const flow::System& system) {
    if (!system.integrator->info().has_stop) { return "drive.frequency = edge needs a stop: stop.law is none"; }
    if (system.integrator->rest_state(system.parameters)[0] > system.stop_position()) {
        return "drive.frequency = edge: the stop presses on the mass at rest, so that no free motion grazes it; give "
               "drive.frequency a number";
    }
    return std::nullopt;
}

Operation operate(const DrivenDesign& design, const OperationOptions& options) {
    const auto given = given_omega(design.actuator, design.scaled, *design.system.integrator);
    return given ? operate_at(*given, design) : operate_below_edge(design, options);
}

Reached reach_motion(const Operation& operation) {
    return operation.edge ? reach_below_edge(operation) : reach_from_rest(operation.system, 1);
}

boundary::FreeOrbitsAt free_orbits_at(const Operation& operation) {
    if (operation.free_orbits) { return *operation.free_orbits; }
    const flow::System& system = operation.system;
    const double omega = system.omega();
    const double resonance = system.integrator->linear_resonance(system.parameters);
    boundary::FreeBranch branch(operation.scout);
    // From three times the resonance, as the edge is, or from above the frequency; higher still where rest is too far
    // from the orbit there for Newton's method. 100 times the resonance is beyond any motion of interest.
    for (double ratio = std::max(3.0, 1.5 * omega / resonance); ratio < 100.0; ratio *= 1.7) {
        if (branch.start(ratio * resonance)) {
            return boundary::free_orbits_at(branch, system, omega, followed_past * omega);
        }
    }
    return {};
}

}  // namespace percuss::design
