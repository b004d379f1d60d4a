#include "flow/flow.hpp"

#include <algorithm>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

namespace percuss::flow {

std::string_view to_string(Status status) {
    switch (status) {
        case Status::not_run: return "not run";
        case Status::ok: return "ok";
        case Status::too_many_events: return "too many contact events";
        case Status::too_many_steps: return "too many integration steps";
        case Status::diverged: return "diverged";
        case Status::unsupported: return "not supported by this integrator";
        case Status::cancelled: return "cancelled";
        case Status::budget_spent: return "the budget of integration steps is spent";
    }
    return "unknown";
}

void append_contact(Result& result, const Contact& contact) { result.contacts.push_back(contact); }

void reset(Result& result) {
    // A result used run after run keeps its memory.
    std::vector<Contact> storage = std::move(result.contacts);
    storage.clear();
    result = Result{};
    result.contacts = std::move(storage);
}

void check(const EnsembleRequest& request, std::size_t members) {
    if (!(request.duration >= 0.0)) {
        throw std::invalid_argument("ensemble request: duration = " + std::to_string(request.duration) +
                                    ": allowed are non-negative numbers");
    }
    if (members < request.states.size()) {
        throw std::invalid_argument("ensemble request: " + std::to_string(request.states.size()) +
                                    " starts, but only " + std::to_string(members) + " members");
    }
}

double Integrator::stop_position(const ParameterVector& p) const {
    return centre(p) + p[static_cast<std::size_t>(info().gap)];
}

double Integrator::stop_position_derivative(const ParameterVector& p, const ParameterVector& dp) const {
    return centre_derivative(p, dp) + dp[static_cast<std::size_t>(info().gap)];
}

StateRange Integrator::internal_range(const ParameterVector&, double) const { return {}; }

double Cost::periods() const { return phase / (2.0 * std::numbers::pi); }

System System::at_omega(double omega) const {
    System other = *this;
    other.parameters[static_cast<std::size_t>(integrator->info().omega)] = omega;
    return other;
}

System System::with(const ParameterVector& p) const {
    System other = *this;
    other.parameters = p;
    return other;
}

Status Cost::allowance() const {
    if (cancelled && cancelled()) { return Status::cancelled; }
    return steps < step_budget ? Status::ok : Status::budget_spent;
}

void System::run(const Request& request, Result& result) const {
    if (cost == nullptr) {
        integrator->run(parameters, request, result);
        return;
    }
    const Status allowance = cost->allowance();
    if (allowance != Status::ok) {
        reset(result);
        result.status = allowance;
        return;
    }
    Request limited = request;
    limited.max_steps = std::min(request.max_steps, cost->step_budget - cost->steps);
    if (limited.cancelled == nullptr) { limited.cancelled = &cost->cancelled; }
    integrator->run(parameters, limited, result);
    // Whose limit it was decides what the caller does: a run that is too long by itself is a failed motion, a spent
    // budget ends the evaluation.
    if (result.status == Status::too_many_steps && limited.max_steps < request.max_steps) {
        result.status = Status::budget_spent;
    }
    cost->phase += request.duration < 0.0 ? -request.duration : request.duration;
    cost->runs += 1;
    cost->steps += result.steps;
}

void System::run_ensemble(const EnsembleRequest& request, std::span<EnsembleMember> members) const {
    if (cost == nullptr) {
        integrator->run_ensemble(parameters, request, members);
        return;
    }
    const Status allowance = cost->allowance();
    if (allowance != Status::ok) {
        check(request, members.size());
        for (std::size_t i = 0; i < request.states.size(); ++i) { members[i] = {allowance, request.states[i], 0, 0}; }
        return;
    }
    // Starts do not know of each other's steps, so what is left of the budget bounds each of them and not their sum: an
    // ensemble may overspend it once, and after that no run begins.
    EnsembleRequest limited = request;
    limited.max_steps = std::min(request.max_steps, cost->step_budget - cost->steps);
    if (limited.cancelled == nullptr) { limited.cancelled = &cost->cancelled; }
    integrator->run_ensemble(parameters, limited, members);
    cost->phase += request.duration * static_cast<double>(request.states.size());
    for (EnsembleMember& member : members.first(request.states.size())) {
        cost->steps += member.steps;
        if (member.status == Status::too_many_steps && limited.max_steps < request.max_steps) {
            member.status = Status::budget_spent;
        }
    }
}

void Integrator::run_ensemble(const ParameterVector& parameters, const EnsembleRequest& request,
                              std::span<EnsembleMember> members) const {
    check(request, members.size());
    Request one;
    one.theta = request.theta;
    one.duration = request.duration;
    one.stop = request.stop;
    one.max_events = request.max_events;
    one.max_steps = request.max_steps;
    one.cancelled = request.cancelled;
    Result result;
    for (std::size_t i = 0; i < request.states.size(); ++i) {
        one.state = request.states[i];
        run(parameters, one, result);
        // A contact that was under way at the start is no entry met, as in the lanes.
        const auto entered = [](const Contact& contact) { return !contact.open_in; };
        members[i] = {result.status, result.state,
                      static_cast<int>(std::count_if(result.contacts.begin(), result.contacts.end(), entered)),
                      result.steps};
    }
}

}  // namespace percuss::flow
