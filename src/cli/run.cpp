#include "cli/run.hpp"

#include "cli/exit_code.hpp"
#include "cli/help.hpp"
#include "cli/interrupt.hpp"
#include "cli/verbs.hpp"
#include "problem/problem_error.hpp"

#include <cstdio>
#include <exception>
#include <new>
#include <stdexcept>

namespace percuss::cli {

namespace {

/// Prints a message as one line, whatever the user's input put into it.
void complain(std::string message) {
    for (char& c : message) {
        if (static_cast<unsigned char>(c) < ' ') { c = ' '; }
    }
    std::fprintf(stderr, "percuss: %s\n", message.c_str());
}

int print(const std::string& text) {
    std::fputs(text.c_str(), stdout);
    return std::fflush(stdout) == 0 ? exit_done : exit_internal_error;
}

int run_verb(const Arguments& arguments) {
    if (arguments.version) { return print("percuss " PERCUSS_VERSION "\n"); }
    if (arguments.help) { return print(arguments.verb.empty() ? general_help() : verb_help(arguments.verb)); }
    watch_for_interrupts();
    if (arguments.verb == "check") { return check(arguments); }
    if (arguments.verb == "simulate") { return simulate(arguments); }
    if (arguments.verb == "sweep") { return sweep(arguments); }
    if (arguments.verb == "attractors") { return attractors(arguments); }
    if (arguments.verb == "orbit") { return orbit(arguments); }
    if (arguments.verb == "evaluate") { return evaluate(arguments); }
    if (arguments.verb == "branch") { return branch(arguments); }
    if (arguments.verb == "locus") { return locus(arguments); }
    if (arguments.verb == "optimise") { return optimise(arguments); }
    throw std::logic_error("verb " + arguments.verb + " is offered but not there");
}

}  // namespace

int run(std::span<const std::string> arguments) {
    try {
        return run_verb(parse_arguments(arguments));
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
