#pragma once
/// \file
/// Numbers that other programs computed, copied from the project's reference collection (dea.json, known-answers.json).
///
/// dea.json: the dielectric elastomer actuator at the nondimensional defaults of Wu, Cai, Gao, Cao, Appl. Syst. Innov.
/// 2022, 5, 122, section 3.1, by a Gragg-Bulirsch-Stoer integrator in long double and a DOP853 integrator with
/// variational equations. The orbit at omega = 1.9 is good to 1e-14, the others to about 1e-12, everything else to the
/// digits given. known-answers.json: published oscillators, by exact matrix-exponential propagation and AUTO-07p.

#include "flow/flow.hpp"

#include <array>
#include <complex>
#include <string_view>
#include <vector>

namespace percuss::test {

/// lambda_p mu_ratio alpha_A alpha_B delta_A delta_B l g k delta_i phi_pp layers omega
inline constexpr flow::ParameterVector paper_defaults = {1.1, 1.0,    3.0, 2.0, 0.3, 60.0, 0.8,
                                                         0.1, 2500.0, 2.0, 0.4, 1.0, 1.9};

/// dea.json, "orbits": states at theta = 0.
struct ReferenceOrbit {
    std::string_view name;
    double omega;
    int period;
    flow::State state;
    double peak_force;
    double amplitude;  ///< zero: not given
    int contacts;
    double max_multiplier;
    double max_multiplier_error;  ///< absolute: half a unit of the last digit given, or what the note says
};
inline constexpr std::array<ReferenceOrbit, 6> reference_orbits = {{
    {"1.9",
     1.9,
     1,
     {0.28441053480900, -0.04807487486239, 1.17803265118641, 1.19639597555165},
     4.73731309181,
     0.110756049472569,
     1,
     0.88573446803,
     4e-10},
    {"2.2 impacting, stable",
     2.2,
     1,
     {0.24433288829767, -0.09712338303067, 1.16699726842616, 1.21157473484297},
     9.721692402,
     0.135653538626,
     1,
     0.90712398,
     5e-9},
    {"2.2 impacting, unstable",
     2.2,
     1,
     {0.47860247948540, -0.15990109872096, 1.17691386448086, 1.19845644637760},
     4.917806357,
     0.117564521197,
     1,
     2.64292692,
     5e-9},
    {"2.2 non-impacting, stable",
     2.2,
     1,
     {0.43717580936204, -0.00920081852185, 1.18507565744412, 1.18498227358562},
     0.0,
     0.037411255806,
     0,
     0.89820161,
     5e-9},
    {"3.0 non-impacting, stable",
     3.0,
     1,
     {0.41090395464036, -0.00136890359622, 1.18476545344551, 1.18475676192469},
     0.0,
     0.010913517625,
     0,
     0.92433408,
     5e-9},
    {"1.78 period 3, stable",
     1.78,
     3,
     {0.29736803916883, 0.00169336011957, 1.18102762349808, 1.19292177583379},
     5.40627738,
     0.0,
     2,
     0.67176820,
     5e-9},
}};

/// More of the orbit at 1.9. Contact: [tau, velocity], tau from theta = 0.
namespace at_1_9 {
inline constexpr double x_max = 0.50189332198089;
inline constexpr double x_min = 0.280381223035752;
inline constexpr double entry_tau = 1.769365946172;
inline constexpr double entry_velocity = 0.102971965449496;
inline constexpr double exit_tau = 1.83003348997329;
inline constexpr double exit_velocity = -0.0969072098012401;
/// Good to 4e-10 of the modulus.
inline const std::array<std::complex<double>, 4> multipliers = {
    {{0.88573446803, 0.0}, {0.84712674709, 0.0}, {-0.10218488568, 0.80397229482}, {-0.10218488568, -0.80397229482}}};
}  // namespace at_1_9

/// dea.json, "boundaries".
namespace boundary_reference {
inline constexpr double grazing_lower = 1.583113016312;
inline constexpr double grazing_upper = 1.93541550079;
inline constexpr double fold_near_grazing_upper = 1.93541549515;
inline constexpr double fold_offset_upper = 5.64e-9;  ///< absolute, in omega
inline constexpr double fold_upper = 2.586046250529;
inline constexpr double fold_upper_peak_force = 19.6493335974;
inline constexpr double flip = 1.745872449920;
}  // namespace boundary_reference

/// dea.json, "edge": at margin 0, total derivatives of [omega_edge, peak_force, amplitude] by central differences,
/// about six digits.
namespace edge_reference {
inline constexpr double omega = 1.93541550079;
inline constexpr double peak_force = 5.2530196539;
inline constexpr double amplitude = 0.1128652856;
inline constexpr std::array<double, 3> d_gap = {-1.7715443, 0.1817176, 0.953207};
inline constexpr std::array<double, 3> d_stiffness = {0.0, 0.001008722, -5.767e-07};
inline constexpr std::array<double, 3> d_phi_pp = {0.6720970, 26.83842, 0.09115237};
/// gap, peak force
inline constexpr std::array<std::array<double, 2>, 6> peak_force_vs_gap = {
    {{0.02, 6.38376}, {0.04, 5.28795}, {0.06, 5.22728}, {0.1, 5.25302}, {0.15, 5.20118}, {0.2, 5.01939}}};
/// phi_pp, omega, peak force
inline constexpr std::array<std::array<double, 3>, 5> vs_phi_pp = {{{0.25, 1.844950, 1.75757},
                                                                    {0.3, 1.873532, 2.83686},
                                                                    {0.35, 1.903221, 3.98323},
                                                                    {0.45, 1.970484, 6.67643},
                                                                    {0.5, 2.008494, 8.28445}}};
/// k, peak force
inline constexpr std::array<std::array<double, 2>, 3> peak_force_vs_k = {
    {{100.0, 1.22518}, {2500.0, 5.25302}, {25000.0, 16.15996}}};
}  // namespace edge_reference

/// known-answers.json, "soft_impact": x'' + 0.02 x' + x + 29 max(x - 1, 0) = f cos(w t).
namespace soft_impact {
/// c k1 k3 F gap k delta_i omega
inline constexpr flow::ParameterVector parameters = {0.02, 1.0, 0.0, 0.152380952381, 1.0, 29.0, 0.0, 1.5};
inline constexpr double grazing_lower = 0.921269296626;
inline constexpr double grazing_upper = 1.072782775353;
inline constexpr double fold_upper = 1.572209937;
inline constexpr double fold_upper_contact_time = 0.56361554;
inline constexpr double fold_near_grazing = 1.07278197774;
/// f, w of the upper fold
inline constexpr std::array<std::array<double, 2>, 4> fold_curve = {
    {{0.16, 1.577666242}, {0.2, 1.599768196}, {0.25, 1.617786939}, {0.4, 1.645498393}}};
inline constexpr double multiplier_omega = 1.5652620209;
inline const std::complex<double> multiplier = {0.95805878, 0.07055949};
}  // namespace soft_impact

}  // namespace percuss::test
