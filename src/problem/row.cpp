#include "problem/row.hpp"

#include "model/units.hpp"
#include "problem/row_types.hpp"

namespace percuss::problem {

Echo number_echo(double value, std::string_view unit) {
    return {model::format_quantity(value, unit), value, unit == "1" ? "" : std::string(unit), ""};
}

std::string in_words(Whole range) {
    return "whole number, at least " + std::to_string(range.lowest) +
           (range.highest == largest_count ? "" : ", at most " + std::to_string(range.highest));
}

std::string in_words(Between range) {
    return "above " + model::number_text(range.above) + ", below " + model::number_text(range.below);
}

const Row* find_row(std::span<const Section> sections, std::string_view name) {
    for (const Section& section : sections) {
        for (const Row& row : section.rows) {
            if (row.name == name) { return &row; }
        }
    }
    return nullptr;
}

}  // namespace percuss::problem
