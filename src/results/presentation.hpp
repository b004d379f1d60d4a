#pragma once
/// \file
/// Results arranged for people: sentences and tables of text, the same for the terminal and for the report page.

#include <string>
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

/// For a terminal: tables with aligned columns.
std::string plain_text(const Presentation& presentation);

}  // namespace percuss::results
