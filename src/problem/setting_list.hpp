#pragma once
/// \file
/// The merged settings of a problem while they are being interpreted, and the troubles met on the way.

#include "problem/problem_error.hpp"
#include "problem/setting.hpp"

#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace percuss::problem {

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

    /// The setting of a key, or null.
    /// Of a repeatable one the entry with this number, or the first when there are not as many.
    [[nodiscard]] const Setting* find(std::string_view key, std::size_t entry = 0) const {
        const Setting* first = nullptr;
        for (const Setting& setting : settings_) {
            if (setting.key != key) { continue; }
            if (entry-- == 0) { return &setting; }
            first = first == nullptr ? &setting : first;
        }
        return first;
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

}  // namespace percuss::problem
