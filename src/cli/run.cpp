#include "cli/run.hpp"

#include "cli/arguments.hpp"
#include "cli/exit_code.hpp"
#include "cli/help.hpp"
#include "cli/interrupt.hpp"
#include "cli/progress.hpp"
#include "problem/problem_error.hpp"

#include <chrono>
#include <cstdio>
#include <exception>
#include <memory>
#include <new>
#include <stdexcept>

namespace percuss::cli {

namespace {

using Clock = std::chrono::steady_clock;

/// Prints a message as one line, whatever the user's input put into it.
void complain(std::string message) {
    for (char& c : message) {
        if (static_cast<unsigned char>(c) < ' ') { c = ' '; }
    }
    std::fprintf(stderr, "percuss: %s\n", message.c_str());
}

void print(const std::string& text) {
    if (std::fputs(text.c_str(), stdout) < 0 || std::fflush(stdout) != 0) {
        throw std::runtime_error("stdout cannot be written");
    }
}

std::string help_text(const Arguments& arguments) {
    const std::size_t width = terminal_width();
    switch (arguments.help) {
        case Topic::verb: return verb_help(*arguments.verb, width);
        case Topic::keys: return keys_help(width);
        case Topic::quantities: return quantities_help(width);
        case Topic::general:
        case Topic::none: break;
    }
    return general_help(width);
}

/// True once a signal has come or the time limit (seconds from now) is over.
numerics::CancelRequest cancel_request(const std::optional<double>& time_limit) {
    const auto begun = Clock::now();
    return [time_limit, begun] {
        return interrupted() ||
               (time_limit && std::chrono::duration<double>(Clock::now() - begun).count() >= *time_limit);
    };
}

/// Why the exit code is not 0, in one line.
std::string complaint(const verbs::Outcome& outcome) {
    if (outcome.status.empty() || outcome.status == outcome.reason) { return outcome.reason; }
    return outcome.status + (outcome.reason.empty() ? "" : ": " + outcome.reason);
}

int run_verb(Arguments arguments) {
    watch_for_interrupts();
    auto progress = std::make_unique<Progress>(arguments.quiet);
    arguments.run.observer = progress->observer();
    arguments.run.cancelled = cancel_request(arguments.time_limit);
    arguments.run.interrupted = interrupted;
    verbs::Session session(*arguments.verb, arguments.run);
    const verbs::Outcome outcome = arguments.verb->run(session);
    progress.reset();  // clears the bar before anything else is printed
    const std::string folder = session.conclude(outcome);
    if (!folder.empty() && !arguments.quiet) { std::fprintf(stderr, "percuss: results in %s\n", folder.c_str()); }
    print(arguments.json ? outcome.document : results::plain_text(outcome.presentation));
    const int code = exit_code(outcome.ending);
    if (code != exit_done) { complain(complaint(outcome)); }
    return code;
}

int run_arguments(const Arguments& arguments) {
    if (arguments.version) {
        print("percuss " PERCUSS_VERSION "\n");
        return exit_done;
    }
    if (arguments.help != Topic::none) {
        print(help_text(arguments));
        return exit_done;
    }
    return run_verb(arguments);
}

}  // namespace

int run(std::span<const std::string> arguments) {
    try {
        return run_arguments(parse_arguments(arguments));
    } catch (const problem::ProblemError& error) {
        complain(error.what());
        return exit_bad_input;
    } catch (const std::invalid_argument& error) {
        complain(error.what());
        return exit_bad_input;
    } catch (const std::bad_alloc&) { complain("out of memory"); } catch (const std::exception& error) {
        complain(std::string("internal error: ") + error.what());
    }
    return exit_internal_error;
}

}  // namespace percuss::cli
