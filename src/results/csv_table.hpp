#pragma once
/// \file

#include "results/row_sink.hpp"

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace percuss::results {

/// Files under construction have this ending.
inline constexpr std::string_view partial_ending = ".partial";

/// A row sink that writes comma-separated values: a header of "name [unit]" (units of pure numbers are left out), then
/// numbers that read back exactly; absent numbers are empty. The file has its name only once the table is destroyed.
/// Throws std::runtime_error when writing fails.
class CsvTable : public RowSink {
public:
    explicit CsvTable(std::filesystem::path file);
    ~CsvTable() override;
    CsvTable(const CsvTable&) = delete;
    CsvTable& operator=(const CsvTable&) = delete;

    void header(std::span<const Column> columns) override;
    void row(std::span<const double> values) override;

private:
    void end_line();

    std::filesystem::path file_;
    std::filesystem::path partial_;
    std::ofstream stream_;
    std::size_t width_ = 0;
};

/// A number as a cell that reads back exactly; empty for NaN.
std::string cell(double value);

/// A whole table as text in the same form; cells are written as they are.
std::string csv_text(const std::vector<Column>& columns, const std::vector<std::vector<std::string>>& rows);

}  // namespace percuss::results
