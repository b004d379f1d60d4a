#include "model/coil/coil.hpp"
#include "model/suspension.hpp"

#include <cmath>
#include <numbers>

namespace percuss::model::coil {

namespace {

using std::numbers::pi;

constexpr std::array table = {
    positive_key(key::mass, "voice-coil.mass", "kg", "moving mass m"),
    key_at_least(0.0, key::damping, "voice-coil.damping", "N s/m", "damping c of the suspension"),
    key_at_least(
        -unbounded_key, key::stiffness, "voice-coil.stiffness", "N/m",
        "linear stiffness k1 of the suspension, above 0 unless cubic is above 0: two wells where it is negative"),
    any_key(key::cubic, "voice-coil.cubic", "N/m^3", "cubic stiffness k3 of the suspension", 0.0),
    any_key(key::bias, "voice-coil.bias", "N", "constant force F0 on the mass towards the stop: gravity, a preload",
            0.0),
    positive_key(key::force_constant, "voice-coil.force_constant", "N/A", "force constant Bl of the coil, also V s/m"),
    positive_key(key::resistance, "voice-coil.resistance", "ohm", "resistance R of the coil"),
    positive_key(key::inductance, "voice-coil.inductance", "H", "inductance Le of the coil"),
    key_at_least(0.0, key::voltage, "voice-coil.voltage", "V", "amplitude V of the driving voltage").with(Role::drive),
};

constexpr std::array keys = {key::mass,           key::damping,      key::stiffness,      key::cubic,   key::bias,
                             key::force_constant, key::resistance,   key::inductance,     key::voltage, Key::stop_gap,
                             Key::stop_stiffness, Key::stop_damping, Key::drive_frequency};

/// The first equation divided by m X / T^2, the second by Le I / T, with x = X y, t = T tau, i = I j, Bl I = m X / T^2.
struct Scaling {
    template <class T>
    static ScaledValues<T> scale(const Values<T>& v) {
        const T& mass = v[key::mass];
        const T& k1 = v[key::stiffness];
        const T& k3 = v[key::cubic];
        const T& bl = v[key::force_constant];
        const T unit = unit_of_length<T>(v, bl * v[key::voltage] / v[key::resistance], k1, k3);

        ScaledValues<T> out;
        out.length = unit;
        out.time = unit_of_time(mass, k1, k3, unit);
        const T per_stiffness = out.time * out.time / mass;
        const T per_damping = out.time / mass;
        const T per_inductance = out.time / v[key::inductance];
        out.force = unit / per_stiffness;
        out.own[current_scale] = out.force / bl;

        auto& p = out.parameters;
        p[damping] = v[key::damping] * per_damping;
        p[stiffness] = k1 * per_stiffness;
        p[cubic] = k3 * unit * unit * per_stiffness;
        p[resistance] = v[key::resistance] * per_inductance;
        p[coupling] = bl * bl * per_damping * per_inductance;
        p[voltage] = v[key::voltage] * per_inductance / out.own[current_scale];
        p[bias] = v[key::bias] / out.force;
        p[gap] = v[Key::stop_gap] / unit;
        p[stop_stiffness] = v[Key::stop_stiffness] * per_stiffness;
        p[stop_damping] = v[Key::stop_damping] * per_damping;
        p[omega] = 2.0 * pi * v[Key::drive_frequency] * out.time;
        return out;
    }
};

const Scene& scene_of(const Specification&) { return scene; }

bool may_be_absent(const Specification&, Key) { return false; }

void check(const Specification& spec, std::vector<std::string>& found) {
    check_suspension(spec, key::stiffness, key::cubic, found);
}

constexpr std::array<StateInfo, states> state_infos = {
    {{"x", "m", {1, 0, 0, {}}}, {"x'", "m/s", {1, -1, 0, {}}}, {"i", "A", {0, 0, 0, {1}}}}};

double cosine(double phase) { return std::cos(phase); }
constexpr std::array<DriveSignal, 1> drives = {{{"voltage", "V", cosine}}};

constexpr ScalePowers of_power = {1, -1, 1, {}};
constexpr std::array<OwnQuantity, 3> quantities = {{
    {"coil_current", "A", "largest modulus of the current", OwnQuantity::From::peak, current, {0, 0, 0, {1}}},
    {"coil_heat", "W", "mean power R i^2 that warms the coil", OwnQuantity::From::mean, heat, of_power},
    {"electric_power", "W", "mean power V cos(theta) i drawn", OwnQuantity::From::mean, power, of_power},
}};

constexpr std::array<std::string_view, 1> sections = {"voice-coil."};
constexpr std::array frequencies = {Key::drive_frequency};

}  // namespace

constinit const Actuator actuator = {
    .type = "voice-coil",
    .kind = "a voice-coil problem",
    .sections = sections,
    .sections_in_words = "[voice-coil]",
    .nondimensional = false,
    .follows_type = true,
    .own_keys = table,
    .keys = keys,
    .frequencies = frequencies,
    .drive_word = "voltage",
    .drives = drives,
    .states = state_infos,
    .positive_states = "",
    .parameters = names,
    .roles = roles,
    .quantities = quantities,
    .quantities_only_for = "exists only for voice coils",
    .scale = scale_with<Scaling>,
    .scale_derivative = scale_derivative_with<Scaling>,
    .scene = scene_of,
    .may_be_absent = may_be_absent,
    .check = check,
};

}  // namespace percuss::model::coil
