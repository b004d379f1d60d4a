#include "verbs/explore/exploration_text.hpp"

#include "problem/problem_error.hpp"
#include "verbs/explore/design_space.hpp"
#include "verbs/verbs.hpp"

#include <charconv>

namespace percuss::verbs {

namespace {

constexpr std::string_view samples_key = "explore.samples";
constexpr std::string_view seed_mark = "# seed ";

}  // namespace

std::string exploration_text(const problem::ProblemFile& problem, const std::string& instruction_set) {
    const Verb& verb = find_verb(explore_kind);
    const bool grows = sampling_of(problem.get<ExploreOptions>().sampling).extendable;
    const auto told = [&](const problem::ResolvedSetting& setting) {
        const problem::Row* row = problem::find_row(sections(), setting.name);
        return row != nullptr && reads(verb, *row) && !(grows && setting.name == samples_key);
    };
    return std::string(seed_mark) + std::to_string(problem.design.sampling.seed) + ", instruction set " +
           instruction_set + "\n" + problem::problem_text(problem, told);
}

problem::ProblemFile parse_exploration(const std::string& name, const std::string& text, std::int64_t samples) {
    const std::string samples_line = std::string(samples_key) + " = ";
    const bool has_samples = text.find("\n" + samples_line) != std::string::npos;
    problem::ProblemFile problem =
        parse_problem(name, has_samples ? text : text + samples_line + std::to_string(samples) + "\n");
    std::uint64_t seed = 0;
    const char* begin = text.data() + seed_mark.size();
    const bool is_marked = text.starts_with(seed_mark);
    if (!is_marked || std::from_chars(begin, text.data() + text.size(), seed).ec != std::errc()) {
        throw problem::ProblemError(name + ": the journal does not tell its seed");
    }
    problem.design.sampling.seed = seed;
    return problem;
}

}  // namespace percuss::verbs
