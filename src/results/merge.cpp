#include "results/merge.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <system_error>

namespace percuss::results {
namespace {

/// Compares bits, so that -0 is not 0 and NaN is NaN.
bool same(const Cell& a, const Cell& b) {
    const auto* x = std::get_if<double>(&a);
    const auto* y = std::get_if<double>(&b);
    if (x == nullptr || y == nullptr) { return a == b; }
    return (std::isnan(*x) && std::isnan(*y)) || std::bit_cast<std::uint64_t>(*x) == std::bit_cast<std::uint64_t>(*y);
}

/// As far as both have rows.
bool agree(const RowBlock& a, const RowBlock& b) {
    const std::size_t shared = std::min(a.rows.size(), b.rows.size());
    for (std::size_t i = 0; i < shared; ++i) {
        if (!std::equal(a.rows[i].begin(), a.rows[i].end(), b.rows[i].begin(), b.rows[i].end(), same)) { return false; }
    }
    return true;
}

void add_blocks(const Journal& source, Journal& target, MergeReport& report) {
    source.for_each_block([&](const RowBlock& block) {
        const auto stored = target.blocks().find(block.number);
        const bool is_new = stored == target.blocks().end();
        if (!is_new) {
            if (!agree(target.read(block.number), block)) {
                throw JournalError(JournalFault::conflict,
                                   source.file().string() + " differs in block " + std::to_string(block.number) +
                                       " from a journal merged before it; the shards were not computed with the same "
                                       "program on the same kind of machine: run one of them again");
            }
            ++report.overlaps;
        }
        if (is_new || stored->second < static_cast<std::int64_t>(block.rows.size())) { target.write(block); }
    });
}

std::vector<BlockRange> ranges_of(const std::vector<std::int64_t>& blocks) {
    std::vector<BlockRange> ranges;
    for (const std::int64_t block : blocks) {
        if (!ranges.empty() && ranges.back().last + 1 == block) {
            ranges.back().last = block;
        } else {
            ranges.push_back({block, block});
        }
    }
    return ranges;
}

}  // namespace

MergeReport merge_journals(const std::vector<std::filesystem::path>& sources, const std::filesystem::path& target) {
    if (sources.empty()) { throw std::invalid_argument("merge: no journals given"); }
    for (const auto& source : sources) {
        std::error_code error;
        if (std::filesystem::equivalent(source, target, error)) {
            throw std::invalid_argument("merge: " + source.string() + " is both a source and the target");
        }
    }

    MergeReport report;
    Journal whole(target, Journal(sources.front()).work());
    report.rows_wanted = whole.rows_wanted();
    for (const auto& file : sources) {
        const Journal source(file);
        check_same_work(whole, source);
        report.rows_wanted = std::max(report.rows_wanted, source.rows_wanted());
        add_blocks(source, whole, report);
    }
    whole.set_rows_wanted(report.rows_wanted);

    for (const auto& file : sources) {
        const Journal source(file);
        const std::size_t lacking = source.missing_blocks(report.rows_wanted).size();
        if (lacking > 0) {
            report.lacking.push_back(file.string() + " (shard " + text_of(source.shard()) +
                                     "): " + std::to_string(lacking) + " blocks");
        }
    }
    for (const auto& [block, rows] : whole.blocks()) { report.rows += rows; }
    report.missing = ranges_of(whole.missing_blocks(report.rows_wanted));
    return report;
}

}  // namespace percuss::results
