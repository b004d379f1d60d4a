#pragma once
/// \file
/// A table that a study writes, kept in memory.

#include "verbs/study.hpp"

#include <stdexcept>
#include <string>
#include <vector>

namespace percuss::test {

class MemoryTable : public results::RowSink {
public:
    void header(std::span<const results::Column> columns) override { columns_.assign(columns.begin(), columns.end()); }
    void row(std::span<const double> values) override { rows_.emplace_back(values.begin(), values.end()); }

    [[nodiscard]] const std::vector<std::vector<double>>& rows() const { return rows_; }
    [[nodiscard]] std::string unit(const std::string& name) const { return columns_[index(name)].unit; }
    [[nodiscard]] double at(std::size_t row, const std::string& name) const { return rows_.at(row).at(index(name)); }
    [[nodiscard]] std::vector<double> column(const std::string& name) const {
        std::vector<double> values;
        for (std::size_t i = 0; i < rows_.size(); ++i) { values.push_back(at(i, name)); }
        return values;
    }

private:
    [[nodiscard]] std::size_t index(const std::string& name) const {
        for (std::size_t i = 0; i < columns_.size(); ++i) {
            if (columns_[i].name == name) { return i; }
        }
        throw std::out_of_range("no column " + name);
    }
    std::vector<results::Column> columns_;
    std::vector<std::vector<double>> rows_;
};

}  // namespace percuss::test
