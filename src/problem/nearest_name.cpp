#include "problem/nearest_name.hpp"

#include <algorithm>
#include <limits>
#include <vector>

namespace percuss::problem {

namespace {

/// "gap" of "stop.gap".
std::string_view last_part(std::string_view name) {
    const auto dot = name.rfind('.');
    return dot == std::string_view::npos ? name : name.substr(dot + 1);
}

}  // namespace

std::size_t edit_distance(std::string_view a, std::string_view b) {
    // Row i holds the distances from the first i letters of a to every beginning of b.
    std::vector<std::size_t> before_previous(b.size() + 1);
    std::vector<std::size_t> previous(b.size() + 1);
    std::vector<std::size_t> current(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) { current[j] = j; }
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::swap(before_previous, previous);
        std::swap(previous, current);
        current[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t replaced = previous[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            current[j] = std::min({previous[j] + 1, current[j - 1] + 1, replaced});
            // Two letters in the wrong order are one slip, not two.
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
                current[j] = std::min(current[j], before_previous[j - 2] + 1);
            }
        }
    }
    return current[b.size()];
}

std::string nearest_name(std::string_view word, std::span<const std::string> names) {
    std::string best;
    std::size_t best_distance = std::numeric_limits<std::size_t>::max();
    for (const std::string& name : names) {
        // Twice the distance; a match of the last part alone costs half an edit more than the same match in full.
        const std::size_t whole = 2 * edit_distance(word, name);
        const std::size_t part = 2 * edit_distance(last_part(word), last_part(name)) + 1;
        const std::size_t distance = std::min(whole, part);
        if (distance < best_distance) {
            best_distance = distance;
            best = name;
        }
    }
    return best;
}

}  // namespace percuss::problem
