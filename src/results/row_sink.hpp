#pragma once
/// \file
/// Where a table goes while it is being computed.

#include <span>
#include <string>

namespace percuss::results {

struct Column {
    std::string name;
    std::string unit;
};

/// A table being written row by row; columns are declared once with their units.
class RowSink {
public:
    RowSink() = default;
    RowSink(const RowSink&) = delete;
    RowSink& operator=(const RowSink&) = delete;
    virtual ~RowSink() = default;
    virtual void header(std::span<const Column> columns) = 0;
    virtual void row(std::span<const double> values) = 0;
};

}  // namespace percuss::results
