#pragma once
/// \file
/// What an integrator is asked and what it answers. Everything above this line (orbits, boundaries, designs) sees an
/// actuator only through these types; everything here is nondimensional, and time is the drive phase
/// theta = omega tau.

#include "model/scene.hpp"
#include "numerics/cancel.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

namespace percuss::flow {

inline constexpr int max_states = model::max_states;
inline constexpr int max_parameters = model::max_parameters;
inline constexpr int max_lanes = 8;

using State = model::StateVector;             ///< unused entries are zero
using ParameterVector = model::Parameters;    ///< meaning given by the system's SystemInfo
using Lanes = std::array<double, max_lanes>;  ///< derivatives along the directions of a request

/// A scalar result with its derivatives along the requested directions.
struct Sensitive {
    double value = 0.0;
    Lanes d{};
};

/// One direction of differentiation: how the initial state, the parameters and the initial phase move along it.
struct Direction {
    State state{};
    ParameterVector parameter{};
    double phase = 0.0;  ///< d(theta at the start); the drive is explicit in theta, the duration stays fixed
};

/// How the stop is treated during a run.
enum class StopMode : std::uint8_t {
    hybrid,  ///< contact begins and ends by the stop law
    off,     ///< the stop is taken away
    held,    ///< the stop acts throughout, also where the law would have released (contact segments of
             ///< contact-sequence shooting)
};

/// Observables that cost extra work; only those in the mask are computed.
enum Observe : std::uint32_t {
    observe_nothing = 0,
    observe_extrema = 1U << 0U,       ///< x_max, x_min
    observe_force = 1U << 1U,         ///< peak_force, impulse, stop_work, contact_time, impact_velocity
    observe_acceleration = 1U << 2U,  ///< peak of |x''|
    observe_energy = 1U << 3U,        ///< drive work and viscous dissipation
    first_peak_bit = 1U << 8U,        ///< the peak signals of the system, a bit each: see observe_peak()
    first_mean_bit = 1U << 16U,       ///< the integrals of its mean signals, likewise: see observe_mean()
    observe_all = 0xffffffffU,        ///< whatever the system has
};
/// Bit of peak signal k, and of mean signal k, as SystemInfo numbers them.
constexpr std::uint32_t observe_peak(int k) { return first_peak_bit << static_cast<unsigned>(k); }
constexpr std::uint32_t observe_mean(int k) { return first_mean_bit << static_cast<unsigned>(k); }

/// One contact met by a run, times as phase theta. A contact under way at the start or end of the run is marked open
/// on that side and its phase is that of the start or end of the run.
struct Contact {
    double theta_in = 0.0;
    double theta_out = 0.0;
    State state_in{};   ///< on the surface, at entry
    State state_out{};  ///< at release
    bool open_in = false;
    bool open_out = false;
    double peak_force = 0.0;
};

struct Observables {
    Sensitive x_max, x_min;                          ///< displacement
    Sensitive peak_force;                            ///< max of f_stop; zero when there is no contact
    Sensitive impact_velocity;                       ///< largest x' at entry
    Sensitive contact_time;                          ///< nondimensional time tau, summed over contacts
    Sensitive impulse;                               ///< integral of f_stop dtau
    Sensitive stop_work;                             ///< integral of f_stop x' dtau
    Sensitive peak_acceleration;                     ///< max of |x''|
    Sensitive drive_work;                            ///< work done by the drive
    Sensitive dissipation;                           ///< work turned into heat in the actuator, stop excluded
    std::array<Sensitive, model::max_peaks> peak{};  ///< largest value (or modulus) of each peak signal of the system
    std::array<Sensitive, model::max_means> mean{};  ///< integral over tau of each of its mean signals
    double theta_x_max = 0.0;                        ///< phases at which the extrema are reached
    double theta_x_min = 0.0;
    double theta_peak_force = 0.0;
    double runner_up_force = 0.0;  ///< largest force among the other contacts: a tie is a kink of peak_force
};

enum class Status : std::uint8_t {
    not_run,
    ok,
    too_many_events,  ///< chatter: the cap on contact events was reached
    too_many_steps,
    diverged,  ///< the state left the range where the model means anything, or became NaN
    unsupported,
    cancelled,     ///< the caller wanted no more (Request::cancelled)
    budget_spent,  ///< the steps that the caller granted (Cost::step_budget) are used up
};

std::string_view to_string(Status status);

struct Request {
    State state{};
    double theta = 0.0;     ///< phase at the start
    double duration = 0.0;  ///< in theta; may be negative for `off` and `held`
    StopMode stop = StopMode::hybrid;
    std::span<const Direction> directions{};  ///< at most max_lanes
    std::uint32_t observe = observe_nothing;
    bool starts_in_contact = false;  ///< hybrid only: the start lies on the surface and has just entered
    bool full_derivatives = false;   ///< derivative series to the full order (see taylor.hpp): for final answers
    int max_events = 128;
    long max_steps = 200000;
    const numerics::CancelRequest* cancelled = nullptr;  ///< asked every few hundred steps; null: never
};

struct Result {
    Status status = Status::not_run;
    State state{};                            ///< at the end
    std::array<Lanes, max_states> state_d{};  ///< state_d[i][lane]: derivative of state i along a direction
    State rate{};                             ///< d(state)/d(theta) at the end
    Sensitive divided_gap;    ///< held only: (x - x_stop)/duration at the end, evaluated without cancellation
    Sensitive divided_force;  ///< held only: f_stop / (k |duration| + delta_i) at the end
    std::vector<Contact> contacts;
    Observables observables;
    long steps = 0;
    long rhs_evaluations = 0;  ///< for step-by-step backends; one jet counts once
};

/// Appends to result.contacts; kept out of line so that kernels of several instruction sets share one copy.
void append_contact(Result& result, const Contact& contact);
/// Sets everything but the contacts' storage back to what a fresh result holds.
void reset(Result& result);

/// Many starts of one system followed over the same phase; nothing is differentiated or observed.
struct EnsembleRequest {
    std::span<const State> states;
    double theta = 0.0;
    double duration = 0.0;  ///< in theta, not negative
    StopMode stop = StopMode::hybrid;
    int max_events = 128;  ///< per start
    long max_steps = 200000;
    const numerics::CancelRequest* cancelled = nullptr;  ///< asked every few hundred steps; null: never
};

/// What became of one of them. Its numbers depend on that start alone, never on its neighbours.
struct EnsembleMember {
    Status status = Status::not_run;
    State state{};     ///< at the end
    int contacts = 0;  ///< entries met
};

template <class AnyRequest>
bool is_cancelled(const AnyRequest& request) {
    return request.cancelled != nullptr && *request.cancelled && (*request.cancelled)();
}

/// Throws std::invalid_argument when the duration is negative or NaN, or when there are fewer members than starts.
void check(const EnsembleRequest& request, std::size_t members);

/// Names and places of the parameters that the levels above must know by role, and the symmetry of the free system.
struct SystemInfo {
    int states = 0;
    int parameters = 0;
    int omega = 0;      ///< index of the drive frequency in the parameter vector
    int gap = 0;        ///< index of the gap
    int stiffness = 0;  ///< index of the stop stiffness k
    int damping = 0;    ///< index of the stop damping delta_i
    int drive = 0;      ///< index of the amplitude of the drive
    std::array<std::string_view, max_parameters> names{};
    /// Without the stop the system, where Integrator::symmetric() says so, is unchanged under
    /// state -> reflect(state), theta -> theta + pi, where reflect mirrors x about the centre, negates x' and permutes
    /// the remaining states by `mirror`.
    std::array<int, max_states> mirror{};
    std::span<const model::PeakSignal> peaks{};  ///< its peak signals: Observables::peak
    int means = 0;                               ///< number of its mean signals: Observables::mean
    bool releases_on_force = false;              ///< contact ends when the force has gone to zero (no-tension law)
    bool has_stop = true;                        ///< false: the law is "none", gap and stiffness mean nothing
};

using StateRange = model::StateRange;

/// An integrator of one hybrid system. Stateless: may be shared between threads.
class Integrator {
public:
    Integrator() = default;
    Integrator(const Integrator&) = delete;
    Integrator& operator=(const Integrator&) = delete;
    virtual ~Integrator() = default;

    [[nodiscard]] virtual const SystemInfo& info() const = 0;

    /// Follows the flow over `request.duration`. Numerical trouble is a status in the result; a misused request
    /// (too many directions, negative hybrid duration) throws std::invalid_argument.
    virtual void run(const ParameterVector& parameters, const Request& request, Result& result) const = 0;

    /// Follows every start of the request; `members` has as many entries, else std::invalid_argument, as for a negative
    /// duration. One after another unless the integrator has something faster.
    virtual void run_ensemble(const ParameterVector& parameters, const EnsembleRequest& request,
                              std::span<EnsembleMember> members) const;

    /// Same integrator at another relative tolerance (dimensionless, 1e-16 < tolerance < 1e-2).
    [[nodiscard]] virtual double tolerance() const = 0;

    /// Centre of the motion (x at rest) and position of the stop, with derivatives along a parameter direction.
    [[nodiscard]] virtual double centre(const ParameterVector& p) const = 0;
    [[nodiscard]] virtual double centre_derivative(const ParameterVector& p, const ParameterVector& dp) const = 0;
    [[nodiscard]] double stop_position(const ParameterVector& p) const;
    [[nodiscard]] double stop_position_derivative(const ParameterVector& p, const ParameterVector& dp) const;

    /// The system at rest, undriven: a start for anything.
    [[nodiscard]] virtual State rest_state(const ParameterVector& p) const = 0;
    /// Where the states beyond x and x' stay while |x - centre| <= reach; the entries of x and x' are zero, as is
    /// everything for a system that has no other states.
    [[nodiscard]] virtual StateRange internal_range(const ParameterVector& p, double reach) const;
    /// Natural frequency of small motions about rest at the mean drive, viscous states frozen, nondimensional rad.
    [[nodiscard]] virtual double linear_resonance(const ParameterVector& p) const = 0;
    /// Whether the free system has the half-cycle mirror symmetry of SystemInfo::mirror at these parameters.
    [[nodiscard]] virtual bool symmetric(const ParameterVector& p) const = 0;
};

/// Work done so far, for `cost` in results, and the limits on it. Kept by the caller, one per evaluation.
struct Cost {
    double phase = 0.0;  ///< integrated theta; divide by 2 pi for drive cycles
    long runs = 0;
    long steps = 0;
    numerics::CancelRequest cancelled{};                  ///< runs end early, and none begins, once this is true
    long step_budget = std::numeric_limits<long>::max();  ///< likewise once so many steps are taken
    [[nodiscard]] double periods() const;
    /// ok, or why no run may begin: cancelled, budget_spent.
    [[nodiscard]] Status allowance() const;
};

/// A system with its parameters fixed: what orbit solvers take.
struct System {
    const Integrator* integrator = nullptr;
    ParameterVector parameters{};
    Cost* cost = nullptr;  ///< may be null

    [[nodiscard]] int states() const { return integrator->info().states; }
    [[nodiscard]] double omega() const { return parameters[static_cast<std::size_t>(integrator->info().omega)]; }
    [[nodiscard]] System at_omega(double omega) const;
    [[nodiscard]] System with(const ParameterVector& p) const;
    [[nodiscard]] double stop_position() const { return integrator->stop_position(parameters); }
    [[nodiscard]] bool symmetric() const { return integrator->symmetric(parameters); }
    /// Within the limits of `cost`, if there is one: a run that they end, or do not let begin, has the status cancelled
    /// or budget_spent.
    void run(const Request& request, Result& result) const;
    /// Likewise for many starts; each is charged its phase.
    void run_ensemble(const EnsembleRequest& request, std::span<EnsembleMember> members) const;
};

}  // namespace percuss::flow
