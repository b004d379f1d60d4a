#include "io/problem_sections.hpp"
#include "io/setting_values.hpp"

namespace percuss::io {

void read_attractors(const SettingList& settings, const model::Actuator& family, study::AttractorsStudy& study,
                     Troubles& troubles) {
    with(settings, "attractors.starts", troubles, [&](const Setting& s) { study.starts = parse_count(s, 1); });
    with(settings, "attractors.cycles", troubles,
         [&](const Setting& s) { study.cycles = parse_count(s, 1, 1'000'000); });
    with(settings, "attractors.lower", troubles,
         [&](const Setting& s) { study.lower = parse_state(s, states_of(family)); });
    with(settings, "attractors.upper", troubles,
         [&](const Setting& s) { study.upper = parse_state(s, states_of(family)); });
}

}  // namespace percuss::io
