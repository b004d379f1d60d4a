#pragma once
/// \file
/// Results arranged for people: sentences and tables of text, the same for the terminal and for the report page.

#include "problem/problem_file.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace percuss::results {

/// A heading with a table below, or a sentence when there are no columns.
struct Block {
    std::string heading;
    std::string sentence;
    std::vector<std::string> columns;
    std::vector<std::vector<std::string>> rows;
};

struct Presentation {
    std::string title;
    std::vector<Block> blocks;
};

/// For a terminal: tables with aligned columns. Sentences and last columns are wrapped at `width` characters; 0: never.
std::string plain_text(const Presentation& presentation, std::size_t width = 0);

// Pieces of presentations. What is absent (NaN) is shown as a dash.

inline constexpr const char* missing = "-";
inline constexpr int omega_digits = 12;

Block sentence(std::string words);
/// "status: failed (why)".
Block status_sentence(std::string_view status, std::string_view reason);
/// Without headings over nothing.
void drop_empty_blocks(Presentation& presentation);

std::string number(double value, int digits = 6);
std::string quantity_text(const problem::ProblemFile& problem, design::Quantity quantity, double value);
/// A length, or whatever else has this SI unit; plain for nondimensional problems.
std::string value_text(const problem::ProblemFile& problem, double value, std::string_view unit);

/// The unit that people read a value of this SI unit in ("mm" for 0.45e-3 m), and its size in that SI unit.
struct ShownUnit {
    std::string name;
    double size = 1.0;
};
ShownUnit shown_unit(double value, std::string_view unit);

/// The SI unit of a quantity or key, empty where values are plain numbers.
std::string unit_of(const problem::ProblemFile& problem, design::Quantity quantity);
std::string unit_of(const problem::ProblemFile& problem, model::Key key);
/// `unit` for problems in SI, nothing for nondimensional ones.
std::string si_unit(const problem::ProblemFile& problem, std::string_view unit);

/// Names of the entries of a state, with their SI units.
struct StateEntry {
    std::string name;
    std::string unit;
};
std::vector<StateEntry> state_entries(const problem::ProblemFile& problem);

/// The settings of the problem, for the report page.
Block settings_block(const problem::ProblemFile& problem);

}  // namespace percuss::results
