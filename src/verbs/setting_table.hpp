#pragma once
/// \file
/// Every key a problem file may have.

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace percuss::verbs {

struct SettingInfo {
    std::string name;      ///< "stop.gap"
    std::string unit;      ///< the SI unit of a bare number; empty for text and pure numbers
    std::string allowed;   ///< "above 0", "ipopt | slsqp"
    std::string fallback;  ///< default; empty if required
    std::string meaning;
    bool repeatable = false;
};

/// All keys, section by section.
std::span<const SettingInfo> setting_table();

/// The entry with this name, or null.
const SettingInfo* find_setting(std::string_view name);

/// "a | b | c".
std::string alternatives(std::span<const std::string> names);

}  // namespace percuss::verbs
