#include "model/spring/spring.hpp"
#include "model/suspension.hpp"

#include <cmath>
#include <numbers>

namespace percuss::model::spring {

namespace {

using std::numbers::pi;

constexpr std::array table = {
    positive_key(key::mass, "spring-mass.mass", "kg", "moving mass m"),
    key_at_least(0.0, key::damping, "spring-mass.damping", "N s/m", "damping c of the suspension"),
    key_at_least(
        -unbounded_key, key::stiffness, "spring-mass.stiffness", "N/m",
        "linear stiffness k1 of the suspension, above 0 unless cubic is above 0: two wells where it is negative"),
    any_key(key::cubic, "spring-mass.cubic", "N/m^3", "cubic stiffness k3 of the suspension", 0.0),
    any_key(key::bias, "spring-mass.bias", "N", "constant force F0 on the mass towards the stop: gravity, a preload",
            0.0),
    key_at_least(0.0, key::force, "spring-mass.force", "N", "amplitude F of the driving force").with(Role::drive),
    positive_key(key::omega, "spring-mass.omega", "rad/s", "angular drive frequency, in place of drive.frequency")
        .with(Role::frequency),
};

constexpr std::array keys = {key::mass,         key::damping,         key::stiffness, key::cubic,
                             key::bias,         key::force,           Key::stop_gap,  Key::stop_stiffness,
                             Key::stop_damping, Key::drive_frequency, key::omega};

/// m x'' + c x' + k1 x + k3 x^3 + f_stop = F cos(theta) divided by m X / T^2, with x = X y and t = T tau.
struct Scaling {
    template <class T>
    static ScaledValues<T> scale(const Values<T>& v) {
        const T& mass = v[key::mass];
        const T& k1 = v[key::stiffness];
        const T& k3 = v[key::cubic];
        const T unit = unit_of_length(v, v[key::force], k1, k3);

        ScaledValues<T> out;
        out.length = unit;
        out.time = unit_of_time(mass, k1, k3, unit);
        const T per_stiffness = out.time * out.time / mass;
        const T per_damping = out.time / mass;
        out.force = unit / per_stiffness;

        auto& p = out.parameters;
        p[damping] = v[key::damping] * per_damping;
        p[stiffness] = k1 * per_stiffness;
        p[cubic] = k3 * unit * unit * per_stiffness;
        p[force] = v[key::force] / out.force;
        p[bias] = v[key::bias] / out.force;
        p[gap] = v[Key::stop_gap] / unit;
        p[stop_stiffness] = v[Key::stop_stiffness] * per_stiffness;
        p[stop_damping] = v[Key::stop_damping] * per_damping;
        p[omega] = (2.0 * pi * v[Key::drive_frequency] + v[key::omega]) * out.time;  // one of them is zero
        return out;
    }
};

const Scene& scene_of(const Specification&) { return scene; }

bool may_be_absent(const Specification&, Key) { return false; }

void check(const Specification& spec, std::vector<std::string>& found) {
    check_suspension(spec, key::stiffness, key::cubic, found);
    // Which of them counts would have to be guessed.
    if (spec.has(Key::drive_frequency) && spec.has(key::omega)) {
        found.emplace_back("drive.frequency and spring-mass.omega are both given: give one of them");
    }
}

constexpr std::array<StateInfo, states> state_infos = {{{"x", "m", {1, 0, 0, {}}}, {"x'", "m/s", {1, -1, 0, {}}}}};

double cosine(double phase) { return std::cos(phase); }
constexpr std::array<DriveSignal, 1> drives = {{{"drive_force", "N", cosine}}};

constexpr std::array<std::string_view, 1> sections = {"spring-mass."};
constexpr std::array frequencies = {Key::drive_frequency, key::omega};

}  // namespace

constinit const Actuator actuator = {
    .type = "spring-mass",
    .kind = "a spring-mass problem",
    .sections = sections,
    .sections_in_words = "[spring-mass]",
    .nondimensional = false,
    .follows_type = true,
    .own_keys = table,
    .keys = keys,
    .frequencies = frequencies,
    .drive_word = "force",
    .drives = drives,
    .states = state_infos,
    .positive_states = "",
    .parameters = names,
    .roles = roles,
    .quantities = {},
    .quantities_only_for = "",
    .scale = scale_with<Scaling>,
    .scale_derivative = scale_derivative_with<Scaling>,
    .scene = scene_of,
    .may_be_absent = may_be_absent,
    .check = check,
};

}  // namespace percuss::model::spring
