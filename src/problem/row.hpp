#pragma once
/// \file
/// One row per setting: its name, unit, range, default and meaning, and how it is read into a struct of options and
/// told back from it. Rows stand beside the struct that they set; help, parsing, echo and hash all follow them.

#include "model/specification.hpp"
#include "problem/setting_list.hpp"

#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <typeindex>
#include <vector>

namespace percuss::problem {

/// What a setting may depend on besides its own text: the actuator, which is read before all other sections.
struct Context {
    const model::Specification& actuator;
};

/// A value told back.
struct Echo {
    std::string text;                                         ///< for people
    double value = std::numeric_limits<double>::quiet_NaN();  ///< SI or nondimensional; NaN for text
    std::string unit = {};                                    ///< of the value; empty for pure numbers and text
    std::string exact = {};  ///< for the hash where the text is rounded; empty: as the value, or the text
};

/// A number with its unit, "1" or "" for pure numbers.
Echo number_echo(double value, std::string_view unit);

struct Row {
    std::string name;      ///< "stop.gap"
    std::string unit;      ///< the SI unit of a bare number; empty for text and pure numbers
    std::string allowed;   ///< "above 0", "ipopt | slsqp"
    std::string fallback;  ///< default; empty if required
    std::string meaning;
    /// Reads the setting into the options. Throws ProblemError naming key, value and what is allowed.
    std::function<void(void* options, const Setting&, const Context&)> set;
    /// The values in force, one unless repeatable; none where there is nothing to tell.
    std::function<std::vector<Echo>(const void* options, const Context&)> get;
    /// What an entry of a repeatable key is about ("amplitude <="): an option replaces the entry of the file about the
    /// same. Absent: the key may be given once.
    std::function<std::string(std::string_view value)> subject = {};

    [[nodiscard]] bool repeatable() const { return static_cast<bool>(subject); }
    [[nodiscard]] std::string_view section() const { return std::string_view(name).substr(0, name.find('.')); }
};

/// The rows of a struct of options, and where a fresh one comes from.
struct Section {
    std::type_index options;
    std::function<std::shared_ptr<void>()> make;
    std::vector<Row> rows;
    /// Given for a section of the problem itself: its struct is part of design::Problem.
    bool of_problem = false;
    /// Settings are read in the order of the rows, since one may depend on those above it, or in that of the file.
    bool in_file_order = false;
};

template <class Options>
Section section_of(std::vector<Row> rows) {
    return {typeid(Options), [] { return std::make_shared<Options>(); }, std::move(rows), false, false};
}

/// The row of this name, or null.
const Row* find_row(std::span<const Section> sections, std::string_view name);

}  // namespace percuss::problem
