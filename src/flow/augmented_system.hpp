#pragma once
/// \file
/// The equations that the step-by-step backends really integrate for one request: the motion, its derivative along each
/// direction (variational equations) and the integrals that the observables ask for, with their derivatives.
///
/// The displacement is kept as the overlap x - x_stop, so that the surface of the stop is the number zero and the
/// shallowest contact keeps its relative accuracy. The independent variable is the
/// phase since the start, t = theta - Request.theta: the shortest run keeps its relative accuracy too.

#include "flow/flow.hpp"
#include "flow/right_hand_side.hpp"

#include <array>
#include <cstddef>
#include <span>

namespace percuss::flow {

inline constexpr int max_integrals = 4 + model::max_means;
inline constexpr int max_block = max_states + max_integrals;
inline constexpr int max_columns = 1 + max_lanes;

/// All numbers of a run at one time t, column after column: first the values, then the derivatives along each direction
/// at fixed t. A column holds the state (overlap first) and below it the integrals.
using Extended = std::array<double, static_cast<std::size_t>(max_block* max_columns)>;

/// Pointers to the part of each column that is meant, values first.
using Columns = std::array<const double*, static_cast<std::size_t>(max_columns)>;
using MutableColumns = std::array<double*, static_cast<std::size_t>(max_columns)>;

/// Places in a column, after the states; -1: not integrated.
struct IntegralPlaces {
    int impulse = -1;
    int stop_work = -1;
    int drive_work = -1;
    int dissipation = -1;
    std::array<int, model::max_means> mean = no_means();
    int count = 0;

private:
    static constexpr std::array<int, model::max_means> no_means() {
        std::array<int, model::max_means> none{};
        none.fill(-1);
        return none;
    }
};

class AugmentedSystem {
public:
    /// Keeps references to the right-hand side only; the directions are copied.
    AugmentedSystem(const RightHandSide& rhs, const ParameterVector& parameters, const Request& request);

    [[nodiscard]] const RightHandSide& rhs() const { return rhs_; }
    [[nodiscard]] const ParameterVector& parameters() const { return parameters_; }
    [[nodiscard]] int states() const { return states_; }
    [[nodiscard]] int lanes() const { return lanes_; }
    [[nodiscard]] int columns() const { return 1 + lanes_; }
    [[nodiscard]] const IntegralPlaces& integrals() const { return places_; }
    /// Drive phase theta at t.
    [[nodiscard]] double phase(double t) const { return start_ + t; }
    /// Numbers in a column, and in all columns.
    [[nodiscard]] int block() const { return states_ + places_.count; }
    [[nodiscard]] int size() const { return block() * columns(); }

    [[nodiscard]] double omega() const { return parameter(rhs_.info().omega); }
    [[nodiscard]] double stiffness() const { return parameter(rhs_.info().stiffness); }
    [[nodiscard]] double damping() const { return parameter(rhs_.info().damping); }
    [[nodiscard]] double omega_d(int lane) const { return parameter_d(rhs_.info().omega, lane); }
    [[nodiscard]] double stiffness_d(int lane) const { return parameter_d(rhs_.info().stiffness, lane); }
    [[nodiscard]] double damping_d(int lane) const { return parameter_d(rhs_.info().damping, lane); }
    /// Where the overlap is zero: the stop, or the centre when there is none.
    [[nodiscard]] double origin() const { return origin_; }
    [[nodiscard]] double origin_d(int lane) const { return origin_d_[static_cast<std::size_t>(lane)]; }

    /// Natural size of an entry of a column, to which absolute tolerances are relative: one for values; for derivatives
    /// what the direction moves, relative to what it moves. The overlap of a held run shorter than one is as small as
    /// that.
    [[nodiscard]] double natural_size(int column, int i) const;

    [[nodiscard]] Extended initial(const State& start) const;
    /// State with the displacement in place of the overlap.
    [[nodiscard]] State state(const State& values) const;
    /// Values of the states in a column block.
    [[nodiscard]] State values(const Extended& y) const;
    [[nodiscard]] double& entry(Extended& y, int column, int i) const { return y[index(column, i)]; }
    [[nodiscard]] double entry(const Extended& y, int column, int i) const { return y[index(column, i)]; }
    /// f_stop at given values: k overlap + delta_i x', whatever its sign.
    [[nodiscard]] double stop_force(const State& values) const {
        return stiffness() * values[0] + damping() * values[1];
    }
    /// Directions at a point: parameters and phase of the request, states from the columns.
    [[nodiscard]] std::span<const Direction> directions(const Columns& states) const;

    // Right-hand sides: d/dt of what `out` names. Evaluations are counted.
    void state_rate(double t, const double* values, bool touching, double* out) const;
    void state_rates(double t, const Columns& states, bool touching, const MutableColumns& out) const;
    void integral_rate(double t, const double* values, bool touching, double* out) const;
    void integral_rates(double t, const Columns& states, bool touching, const MutableColumns& out) const;
    /// Everything at once, laid out as Extended.
    void rates(double t, const double* y, bool touching, double* out) const;
    /// d(state_rate)/d(values), column-major, states x states.
    void jacobian(double t, const double* values, bool touching, double* out) const;

    [[nodiscard]] long evaluations() const { return evaluations_; }

private:
    [[nodiscard]] std::size_t index(int column, int i) const {
        return static_cast<std::size_t>(column) * static_cast<std::size_t>(block()) + static_cast<std::size_t>(i);
    }
    [[nodiscard]] double parameter(int i) const { return parameters_[static_cast<std::size_t>(i)]; }
    [[nodiscard]] double parameter_d(int i, int lane) const {
        return directions_[static_cast<std::size_t>(lane)].parameter[static_cast<std::size_t>(i)];
    }
    [[nodiscard]] State lift(const double* values) const;
    [[nodiscard]] bool watches_means() const;

    const RightHandSide& rhs_;
    ParameterVector parameters_;
    double start_;
    /// The state part is overwritten at each evaluation.
    mutable std::array<Direction, static_cast<std::size_t>(max_lanes)> directions_{};
    IntegralPlaces places_;
    int states_ = 0;
    int lanes_ = 0;
    double origin_ = 0.0;
    Lanes origin_d_{};
    Lanes lane_size_{};
    double overlap_size_ = 1.0;
    std::array<State, static_cast<std::size_t>(max_lanes)> start_lanes_{};
    mutable long evaluations_ = 0;
};

}  // namespace percuss::flow
