#include "results/csv_table.hpp"

#include "model/number_text.hpp"

#include <cmath>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace percuss::results {

namespace {

/// A cell as RFC 4180 wants it: in quotes where it holds a comma, a quote or a line end, quotes doubled.
std::string quoted(const std::string& cell) {
    if (cell.find_first_of(",\"\n\r") == std::string::npos) { return cell; }
    std::string text = "\"";
    for (const char c : cell) { text += c == '"' ? "\"\"" : std::string(1, c); }
    return text + "\"";
}

/// "name [unit]".
std::string title(const Column& column) {
    const bool is_pure = column.unit.empty() || column.unit == "1";
    return quoted(is_pure ? column.name : column.name + " [" + column.unit + "]");
}

}  // namespace

CsvTable::CsvTable(std::filesystem::path file)
    : file_(std::move(file)),
      partial_(file_.string() + std::string(partial_ending)),
      stream_(partial_, std::ios::binary) {
    if (!stream_) { throw std::runtime_error(partial_.string() + " cannot be written"); }
}

CsvTable::~CsvTable() {
    stream_.close();
    std::error_code error;
    if (is_discarded_) {
        std::filesystem::remove(partial_, error);
    } else if (stream_) {
        std::filesystem::rename(partial_, file_, error);
    }
}

void CsvTable::header(std::span<const Column> columns) {
    if (width_ != 0) { throw std::logic_error("csv: the header is written once"); }
    width_ = columns.size();
    for (std::size_t i = 0; i < width_; ++i) { stream_ << (i == 0 ? "" : ",") << title(columns[i]); }
    end_line();
}

void CsvTable::row(std::span<const double> values) {
    if (values.size() != width_) { throw std::logic_error("csv: a row must be as wide as the header"); }
    for (std::size_t i = 0; i < width_; ++i) {
        stream_ << (i == 0 ? "" : ",");
        // NaN is absence: an empty cell. Texts are exact, so that nothing is lost by a table.
        if (!std::isnan(values[i])) { stream_ << model::exact_text(values[i]); }
    }
    end_line();
}

void CsvTable::row(std::span<const std::string> cells) {
    if (cells.size() != width_) { throw std::logic_error("csv: a row must be as wide as the header"); }
    for (std::size_t i = 0; i < width_; ++i) { stream_ << (i == 0 ? "" : ",") << quoted(cells[i]); }
    end_line();
}

void CsvTable::discard() { is_discarded_ = true; }

void CsvTable::end_line() {
    stream_ << '\n';
    if (!stream_) { throw std::runtime_error(partial_.string() + " cannot be written"); }
}

std::string cell(double value) { return std::isnan(value) ? "" : model::exact_text(value); }

std::string csv_text(const std::vector<Column>& columns, const std::vector<std::vector<std::string>>& rows) {
    std::string text;
    for (std::size_t i = 0; i < columns.size(); ++i) { text += (i == 0 ? "" : ",") + title(columns[i]); }
    text += '\n';
    for (const auto& row : rows) {
        for (std::size_t i = 0; i < row.size(); ++i) { text += (i == 0 ? "" : ",") + quoted(row[i]); }
        text += '\n';
    }
    return text;
}

}  // namespace percuss::results
