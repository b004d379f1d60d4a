#include "results/shard.hpp"

#include <array>
#include <charconv>
#include <stdexcept>

namespace percuss::results {
namespace {

constexpr const char* allowed = R"(allowed are "i/N" with whole numbers, i from 0 to N - 1, and "auto")";

std::optional<std::int64_t> whole_number(std::string_view text) {
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value < 0) { return std::nullopt; }
    return value;
}

/// The variable as a number; nothing when it is not set or empty.
std::optional<std::int64_t> number_of(const Environment& environment, const char* name) {
    const auto text = environment(name);
    if (!text || text->empty()) { return std::nullopt; }
    const auto value = whole_number(*text);
    if (!value) {
        throw std::invalid_argument(std::string("shard auto: ") + name + R"( = ")" + *text +
                                    R"(" is not a whole number; give "i/N" instead)");
    }
    return value;
}

Shard checked(std::int64_t index, std::int64_t count, const std::string& source) {
    if (count >= 1 && index < count) { return {index, count}; }
    throw std::invalid_argument(source + ": shard " + std::to_string(index) + " of " + std::to_string(count) + "; " +
                                allowed);
}

std::optional<Shard> of_slurm_array(const Environment& environment) {
    const auto id = number_of(environment, "SLURM_ARRAY_TASK_ID");
    if (!id) { return std::nullopt; }
    const auto count = number_of(environment, "SLURM_ARRAY_TASK_COUNT");
    if (!count) {
        throw std::invalid_argument(
            R"(shard auto: SLURM_ARRAY_TASK_ID is set but SLURM_ARRAY_TASK_COUNT is not; give "i/N" instead)");
    }
    const std::int64_t smallest = number_of(environment, "SLURM_ARRAY_TASK_MIN").value_or(0);
    const std::int64_t largest = number_of(environment, "SLURM_ARRAY_TASK_MAX").value_or(smallest + *count - 1);
    if (*count == 1 && *id != 0) {
        // Most likely one task of a larger array, run again: to take it for the whole table would be a costly surprise.
        throw std::invalid_argument("shard auto: a Slurm array of the one task " + std::to_string(*id) +
                                    R"( does not say which shard that is; give "i/N" instead)");
    }
    const std::int64_t step = *count > 1 ? (largest - smallest) / (*count - 1) : 1;
    const bool even = step >= 1 && *id >= smallest && (*id - smallest) % step == 0 &&
                      largest == smallest + step * (*count - 1) && *id <= largest;
    if (!even) {
        throw std::invalid_argument("shard auto: the ids of the Slurm array (" + std::to_string(*count) + " from " +
                                    std::to_string(smallest) + " to " + std::to_string(largest) + ", this one " +
                                    std::to_string(*id) + R"() are not evenly spaced; give "i/N" instead)");
    }
    return checked((*id - smallest) / step, *count, "shard auto, Slurm array");
}

std::optional<Shard> of_ranks(const Environment& environment, const char* rank_name, const char* size_name) {
    const auto rank = number_of(environment, rank_name);
    const auto size = number_of(environment, size_name);
    if (!rank && !size) { return std::nullopt; }
    if (!rank || !size) {
        throw std::invalid_argument(std::string("shard auto: of ") + rank_name + " and " + size_name +
                                    R"( only one is set; give "i/N" instead)");
    }
    return checked(*rank, *size, std::string("shard auto, ") + rank_name);
}

Shard of_environment(const Environment& environment) {
    std::optional<Shard> open_mpi = of_ranks(environment, "OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE");
    // Open MPI's launcher may set the PMI names too; they then tell of the same processes.
    if (!open_mpi) { open_mpi = of_ranks(environment, "PMI_RANK", "PMI_SIZE"); }
    const std::array numberings = {of_slurm_array(environment), open_mpi};

    std::optional<Shard> found;
    for (const auto& numbering : numberings) {
        if (!numbering) { continue; }
        if (found && !found->is_whole() && !numbering->is_whole()) {
            throw std::invalid_argument(
                R"(shard auto: the task is one of a Slurm array and one of several MPI ranks; give "i/N" instead)");
        }
        // A numbering of one process says nothing: Slurm sets PMI_SIZE = 1 for each task of an array.
        if (!found || found->is_whole()) { found = numbering; }
    }
    if (!found) {
        throw std::invalid_argument(
            "shard auto: none of SLURM_ARRAY_TASK_ID, OMPI_COMM_WORLD_RANK and PMI_RANK is set; "
            R"(give "i/N" instead)");
    }
    return *found;
}

}  // namespace

std::vector<std::int64_t> blocks_of(const Shard& shard, std::int64_t rows) {
    std::vector<std::int64_t> blocks;
    for (std::int64_t k = shard.index; k < blocks_of(rows); k += shard.count) { blocks.push_back(k); }
    return blocks;
}

std::string text_of(const Shard& shard) { return std::to_string(shard.index) + "/" + std::to_string(shard.count); }

Shard parse_shard(std::string_view text, const Environment& environment) {
    if (text == "auto") { return of_environment(environment); }
    const std::string source = "shard \"" + std::string(text) + "\"";
    const auto slash = text.find('/');
    if (slash != std::string_view::npos) {
        const auto index = whole_number(text.substr(0, slash));
        const auto count = whole_number(text.substr(slash + 1));
        if (index && count) { return checked(*index, *count, source); }
    }
    throw std::invalid_argument(source + ": " + allowed);
}

}  // namespace percuss::results
