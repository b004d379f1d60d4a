#pragma once
/// \file
/// The merged settings of a problem while they are being interpreted, and the troubles met on the way.

#include "problem/problem_error.hpp"
#include "verbs/settings.hpp"

#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace percuss::verbs {

/// Either throws at the first trouble or keeps a list of them.
class Troubles {
public:
    explicit Troubles(bool keep_going) : keep_going_(keep_going) {}

    void add(const std::string& message) {
        if (!keep_going_) { throw ProblemError(message); }
        list_.push_back(message);
    }

    /// Runs `action`; what it throws about the user's input is a trouble.
    template <class Action>
    void attempt(Action action) {
        try {
            action();
        } catch (const ProblemError& error) { add(error.what()); } catch (const std::invalid_argument& error) {
            add(error.what());
        }
    }

    [[nodiscard]] const std::vector<std::string>& list() const { return list_; }

private:
    bool keep_going_;
    std::vector<std::string> list_;
};

class SettingList {
public:
    explicit SettingList(std::vector<Setting> settings) : settings_(std::move(settings)) {}

    [[nodiscard]] const std::vector<Setting>& all() const { return settings_; }

    /// The setting of a key that is not repeatable, or null.
    [[nodiscard]] const Setting* find(std::string_view key) const {
        for (const Setting& setting : settings_) {
            if (setting.key == key) { return &setting; }
        }
        return nullptr;
    }

    /// Whether any key of a section is given; `section` ends with a dot.
    [[nodiscard]] const Setting* first_of_section(std::string_view section) const {
        for (const Setting& setting : settings_) {
            if (setting.key.starts_with(section)) { return &setting; }
        }
        return nullptr;
    }

private:
    std::vector<Setting> settings_;
};

/// The message of a value that cannot be used: "stop.gap = 5 kg: why".
inline ProblemError bad_value(const Setting& setting, const std::string& why) {
    return ProblemError(as_written(setting) + ": " + why);
}

}  // namespace percuss::verbs
