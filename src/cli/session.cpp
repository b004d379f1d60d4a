#include "cli/session.hpp"

#include "cli/exit_code.hpp"
#include "kernels/kernels.hpp"

#include <cstdio>
#include <stdexcept>
#include <utility>

namespace percuss::cli {

namespace {

constexpr std::string_view no_folder = "none";

std::filesystem::path folder_path(const Arguments& arguments, const verbs::ProblemFile& problem) {
    return arguments.out ? std::filesystem::path(*arguments.out)
                         : std::filesystem::path("results") / (problem.name + "-" + arguments.verb);
}

}  // namespace

void print(const std::string& text) {
    if (std::fputs(text.c_str(), stdout) < 0 || std::fflush(stdout) != 0) {
        throw std::runtime_error("stdout cannot be written");
    }
}

Session::Session(const Arguments& arguments, verbs::FrequencyUse use)
    : problem_(verbs::read_problem(arguments.problem, arguments.keys, use)),
      quiet_(arguments.quiet),
      json_(arguments.json) {
    verbs::StudyProblem& study = problem_.study;
    study.seed = arguments.seed.value_or(study.seed);
    study.jobs = arguments.jobs.value_or(study.jobs);
    record_.instruction_set = kernels::instruction_set_in_use(study.design.solver.instruction_set);
    record_.started = verbs::time_stamp();
    if (arguments.out != no_folder) {
        folder_ = std::make_unique<verbs::ResultFolder>(folder_path(arguments, problem_), arguments.verb, problem_.name,
                                                        arguments.force);
    }
}

void Session::start(std::vector<std::string> files) {
    if (folder_) { folder_->start(std::move(files), problem_, record_); }
}

void Session::write(const std::string& name, const std::string& content) const {
    if (folder_) { folder_->write(name, content); }
}

std::unique_ptr<results::RowSink> Session::table(const std::string& name) const {
    return folder_ ? folder_->table(name) : nullptr;
}

int Session::conclude(verbs::Ending ending, const std::string& document, const results::Presentation& presentation) {
    write("result.json", document);
    if (folder_) { write("report.html", verbs::report_page(presentation, problem_, record_.instruction_set)); }
    finish(ending);
    print(json_ ? document : results::plain_text(presentation));
    return exit_code(ending);
}

void Session::finish(verbs::Ending ending) {
    if (!folder_) { return; }
    record_.finished = verbs::time_stamp();
    record_.ending = ending_text(ending);
    const bool cut_short = ending == verbs::Ending::interrupted;
    folder_->finish(cut_short ? verbs::RunState::interrupted : verbs::RunState::finished, problem_, record_);
    if (!quiet_) { std::fprintf(stderr, "percuss: results in %s\n", folder_->path().c_str()); }
}

}  // namespace percuss::cli
