#include "results/presentation.hpp"

#include <algorithm>
#include <numeric>
#include <sstream>

namespace percuss::results {

namespace {

constexpr std::size_t column_gap = 2;

/// Number of characters shown, for UTF-8.
/// Bytes 10xxxxxx continue a character.
std::size_t width_of(const std::string& text) {
    return static_cast<std::size_t>(std::count_if(
        text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

/// Words on lines of at most `width` characters; 0: one line.
std::vector<std::string> wrapped(const std::string& text, std::size_t width) {
    if (width == 0 || width_of(text) <= width) { return {text}; }
    std::vector<std::string> lines = {""};
    std::istringstream words(text);
    for (std::string word; words >> word;) {
        if (!lines.back().empty() && width_of(lines.back()) + 1 + width_of(word) > width) { lines.emplace_back(); }
        lines.back() += (lines.back().empty() ? "" : " ") + word;
    }
    return lines;
}

/// One row; what does not fit is wrapped within its column.
void append_row(const std::vector<std::string>& cells, const std::vector<std::size_t>& widths, std::string& text) {
    std::vector<std::vector<std::string>> columns;
    std::size_t height = 1;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        columns.push_back(wrapped(cells[i], widths[i]));
        height = std::max(height, columns.back().size());
    }
    for (std::size_t k = 0; k < height; ++k) {
        std::string line = "  ";
        for (std::size_t i = 0; i < cells.size(); ++i) {
            const std::string cell = k < columns[i].size() ? columns[i][k] : "";
            line += cell;
            const std::size_t shown = width_of(cell);
            if (i + 1 < cells.size()) { line.append(std::max(widths[i], shown) - shown + column_gap, ' '); }
        }
        line.erase(line.find_last_not_of(' ') + 1);
        text += line + "\n";
    }
}

/// Takes from the widest columns until the table fits.
void narrow(std::vector<std::size_t>& widths, std::size_t width) {
    constexpr std::size_t narrowest = 12;
    const std::size_t gaps = 2 + column_gap * (widths.size() - 1);
    while (std::accumulate(widths.begin(), widths.end(), gaps) > width) {
        const auto widest = std::max_element(widths.begin(), widths.end());
        // Too many columns for the width: lines that are too long read better than words in pieces.
        if (*widest <= narrowest) { return; }
        // One at a time, so that columns of one width share the loss.
        --*widest;
    }
}

/// width 0: as wide as the cells are.
void append_table(const Block& block, std::size_t width, std::string& text) {
    std::vector<std::size_t> widths(block.columns.size());
    for (std::size_t i = 0; i < widths.size(); ++i) {
        widths[i] = width_of(block.columns[i]);
        for (const auto& row : block.rows) { widths[i] = std::max(widths[i], width_of(row.at(i))); }
    }
    if (width > 0) { narrow(widths, width); }
    append_row(block.columns, widths, text);
    for (const auto& row : block.rows) { append_row(row, widths, text); }
}

}  // namespace

std::string plain_text(const Presentation& presentation, std::size_t width) {
    const auto paragraph = [&](const std::string& words) {
        std::string lines;
        for (const std::string& line : wrapped(words, width)) { lines += line + "\n"; }
        return lines;
    };
    std::string text = paragraph(presentation.title);
    for (const Block& block : presentation.blocks) {
        text += "\n";
        if (!block.heading.empty()) { text += paragraph(block.heading); }
        if (!block.sentence.empty()) { text += paragraph(block.sentence); }
        if (!block.columns.empty()) { append_table(block, width, text); }
    }
    return text;
}

}  // namespace percuss::results
