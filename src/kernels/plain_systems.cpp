#include "kernels/plain_systems.hpp"

#include "kernels/scene_table.hpp"
#include "model/plain.hpp"
#include "numerics/forward_lanes.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <stdexcept>
#include <string>

namespace percuss::kernels {
namespace {

using flow::Direction;
using flow::ParameterVector;
using flow::Powers;
using flow::State;
using numerics::ForwardLanes;

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

template <model::PlainModel Model>
constexpr int count_of = static_cast<int>(Model::scene.parameters.size());

/// A point of the motion whose every number carries N derivatives, one per direction.
template <model::PlainModel Model, int N>
struct Lifted {
    using T = ForwardLanes<N>;
    std::array<T, at(count_of<Model>)> p;
    std::array<T, at(Model::scene.states)> state;
    T theta;

    Lifted(const ParameterVector& parameters, double phase, const State& y, std::span<const Direction> directions) {
        for (int i = 0; i < count_of<Model>; ++i) {
            p[at(i)] = T(parameters[at(i)]);
            for (std::size_t j = 0; j < directions.size(); ++j) { p[at(i)].d[j] = directions[j].parameter[at(i)]; }
        }
        for (int i = 0; i < Model::scene.states; ++i) {
            state[at(i)] = T(y[at(i)]);
            for (std::size_t j = 0; j < directions.size(); ++j) { state[at(i)].d[j] = directions[j].state[at(i)]; }
        }
        theta = T(phase);
        for (std::size_t j = 0; j < directions.size(); ++j) { theta.d[j] = directions[j].phase; }
    }
};

/// What the levels above must know of a scene under a contact law.
flow::SystemInfo info_of(const model::Scene& scene, model::ContactLaw law) {
    flow::SystemInfo info;
    info.states = scene.states;
    info.parameters = static_cast<int>(scene.parameters.size());
    info.omega = scene.roles.omega;
    info.gap = scene.roles.gap;
    info.stiffness = scene.roles.stop_stiffness;
    info.damping = scene.roles.stop_damping;
    info.drive = scene.roles.drive;
    std::copy(scene.parameters.begin(), scene.parameters.end(), info.names.begin());
    info.mirror = scene.mirror;
    info.mirror_sign = scene.mirror_sign;
    info.peaks = scene.peaks;
    info.means = static_cast<int>(scene.means.size());
    info.releases_on_force = model::contact_rules(law).releases_on_force;
    info.has_stop = model::has_stop(law);
    return info;
}

template <model::PlainModel Model>
class PlainSystem final : public flow::RightHandSide {
public:
    explicit PlainSystem(model::ContactLaw law) : info_(info_of(Model::scene, law)), law_(law) {}

    [[nodiscard]] const flow::SystemInfo& info() const override { return info_; }
    [[nodiscard]] model::ContactLaw contact_law() const override { return law_; }
    [[nodiscard]] bool meaningful(const State& state) const override { return Model::meaningful(state); }
    [[nodiscard]] State rest_state(const ParameterVector& p) const override { return Model::rest_state(p); }
    [[nodiscard]] flow::StateRange internal_range(const ParameterVector& p, double reach) const override {
        return Model::internal_range(p, reach);
    }
    [[nodiscard]] double linear_resonance(const ParameterVector& p) const override {
        return Model::linear_resonance(p);
    }
    [[nodiscard]] double fastest_decay(const ParameterVector& p) const override { return Model::fastest_decay(p); }
    [[nodiscard]] bool symmetric(const ParameterVector& p) const override { return Model::symmetric(p); }
    [[nodiscard]] double centre(const ParameterVector& p) const override { return Model::centre(p); }
    /// The centre is linear in the parameters.
    [[nodiscard]] double centre_derivative(const ParameterVector&, const ParameterVector& dp) const override {
        return Model::centre(dp);
    }

    void rates(const ParameterVector& p, double theta, const State& state, bool touching,
               std::span<const Direction> directions, State& rate, State* rate_d) const override {
        if (directions.empty()) {
            Model::rate(p.data(), theta, state.data(), touching, rate.data());
            return;
        }
        with_lanes(directions.size(), [&]<int N>() {
            const Lifted<Model, N> point(p, theta, state, directions);
            std::array<ForwardLanes<N>, at(Model::scene.states)> out;
            Model::rate(point.p.data(), point.theta, point.state.data(), touching, out.data());
            for (int i = 0; i < Model::scene.states; ++i) {
                rate[at(i)] = out[at(i)].value;
                for (std::size_t j = 0; j < directions.size(); ++j) { rate_d[j][at(i)] = out[at(i)].d[j]; }
            }
        });
    }

    void powers(const ParameterVector& p, double theta, const State& state, std::span<const Direction> directions,
                Powers& value, Powers* value_d) const override {
        if (directions.empty()) {
            Model::powers(p.data(), theta, state.data(), value.drive, value.loss);
            return;
        }
        with_lanes(directions.size(), [&]<int N>() {
            const Lifted<Model, N> point(p, theta, state, directions);
            ForwardLanes<N> drive;
            ForwardLanes<N> loss;
            Model::powers(point.p.data(), point.theta, point.state.data(), drive, loss);
            value = {drive.value, loss.value};
            for (std::size_t j = 0; j < directions.size(); ++j) { value_d[j] = {drive.d[j], loss.d[j]}; }
        });
    }

    [[nodiscard]] double peak(int signal, int part, const ParameterVector& p, double theta, const State& state,
                              std::span<const Direction> directions, double* value_d) const override {
        double value = 0.0;
        if constexpr (!Model::scene.peaks.empty()) {
            if (directions.empty()) { return Model::peak(signal, part, p.data(), theta, state.data()); }
            with_lanes(directions.size(), [&]<int N>() {
                const Lifted<Model, N> point(p, theta, state, directions);
                const ForwardLanes<N> out = Model::peak(signal, part, point.p.data(), point.theta, point.state.data());
                value = out.value;
                for (std::size_t j = 0; j < directions.size(); ++j) { value_d[j] = out.d[j]; }
            });
        }
        return value;
    }

    void means(const ParameterVector& p, double theta, const State& state, std::span<const Direction> directions,
               flow::Means& value, flow::Means* value_d) const override {
        value = {};
        if constexpr (!Model::scene.means.empty()) {
            for (std::size_t k = 0; k < Model::scene.means.size(); ++k) {
                const int which = static_cast<int>(k);
                if (directions.empty()) {
                    value[k] = Model::mean(which, p.data(), theta, state.data());
                    continue;
                }
                with_lanes(directions.size(), [&]<int N>() {
                    const Lifted<Model, N> point(p, theta, state, directions);
                    const ForwardLanes<N> out = Model::mean(which, point.p.data(), point.theta, point.state.data());
                    value[k] = out.value;
                    for (std::size_t j = 0; j < directions.size(); ++j) { value_d[j][k] = out.d[j]; }
                });
            }
        }
    }

private:
    /// Calls the function with the smallest compiled number of lanes that holds `count` directions.
    template <class Function>
    static void with_lanes(std::size_t count, Function&& function) {
        // One is for slopes along the motion, four for the Jacobian of up to four states, the rest for the directions
        // of a request.
        if (count <= 1) {
            function.template operator()<1>();
        } else if (count <= 4) {
            function.template operator()<4>();
        } else {
            function.template operator()<flow::max_lanes>();
        }
    }

    flow::SystemInfo info_;
    model::ContactLaw law_;
};

/// The plain system of the scene at this index of the list.
template <class... S>
std::shared_ptr<const flow::RightHandSide> make(model::SceneList<S...>, std::size_t index, model::ContactLaw law) {
    using Maker = std::shared_ptr<const flow::RightHandSide> (*)(model::ContactLaw);
    constexpr std::array<Maker, sizeof...(S)> makers = {
        [](model::ContactLaw l) -> std::shared_ptr<const flow::RightHandSide> {
            return std::make_shared<PlainSystem<typename S::Plain>>(l);
        }...};
    return makers.at(index)(law);
}

/// Place of a scene in the list, told by its address. Throws std::invalid_argument for one that is not in it.
template <class... S>
std::size_t index_in(model::SceneList<S...>, const model::Scene& scene) {
    const std::array<const model::Scene*, sizeof...(S)> listed = {&S::Plain::scene...};
    const auto found = std::find(listed.begin(), listed.end(), &scene);
    if (found == listed.end()) {
        throw std::invalid_argument("scene '" + std::string(scene.name) + "': no kernels are compiled for it");
    }
    return static_cast<std::size_t>(found - listed.begin());
}

}  // namespace

std::size_t scene_index(const model::Scene& scene) { return index_in(model::Scenes{}, scene); }

std::shared_ptr<const flow::RightHandSide> make_plain_system(const model::Scene& scene, model::ContactLaw law) {
    return make(model::Scenes{}, scene_index(scene), law);
}

}  // namespace percuss::kernels
