#include "results/presentation.hpp"

#include <algorithm>

namespace percuss::results {

namespace {

constexpr std::size_t column_gap = 2;

/// Number of characters shown, for UTF-8.
std::size_t width_of(const std::string& text) {
    return static_cast<std::size_t>(std::count_if(
        text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

void append_line(const std::vector<std::string>& cells, const std::vector<std::size_t>& widths, std::string& text) {
    std::string line = "  ";
    for (std::size_t i = 0; i < cells.size(); ++i) {
        line += cells[i];
        if (i + 1 < cells.size()) { line.append(widths[i] - width_of(cells[i]) + column_gap, ' '); }
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
}

void append_table(const Block& block, std::string& text) {
    std::vector<std::size_t> widths(block.columns.size());
    for (std::size_t i = 0; i < widths.size(); ++i) {
        widths[i] = width_of(block.columns[i]);
        for (const auto& row : block.rows) { widths[i] = std::max(widths[i], width_of(row.at(i))); }
    }
    append_line(block.columns, widths, text);
    for (const auto& row : block.rows) { append_line(row, widths, text); }
}

}  // namespace

std::string plain_text(const Presentation& presentation) {
    std::string text = presentation.title + "\n";
    for (const Block& block : presentation.blocks) {
        text += "\n";
        if (!block.heading.empty()) { text += block.heading + "\n"; }
        if (!block.sentence.empty()) { text += block.sentence + "\n"; }
        if (!block.columns.empty()) { append_table(block, text); }
    }
    return text;
}

}  // namespace percuss::results
