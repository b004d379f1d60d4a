#include "cli/exit_code.hpp"

namespace percuss::cli {

using verbs::Ending;

int exit_code(Ending ending) {
    switch (ending) {
        case Ending::verified: return exit_done;
        case Ending::infeasible: return exit_infeasible;
        case Ending::not_certified:
        case Ending::budget: return exit_not_certified;
        case Ending::some_failed: return exit_some_failed;
        case Ending::interrupted: return exit_interrupted;
        case Ending::not_run: break;
    }
    return exit_internal_error;
}

std::string_view ending_text(Ending ending) {
    switch (ending) {
        case Ending::verified: return "verified";
        case Ending::infeasible: return "infeasible";
        case Ending::not_certified: return "not-certified";
        case Ending::budget: return "budget";
        case Ending::some_failed: return "some-failed";
        case Ending::interrupted: return "interrupted";
        case Ending::not_run: break;
    }
    return "not-run";
}

}  // namespace percuss::cli
