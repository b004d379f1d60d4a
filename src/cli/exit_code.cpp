#include "cli/exit_code.hpp"

#include <array>

namespace percuss::cli {

namespace {

using verbs::Ending;

struct Row {
    Ending ending;
    int code;
};

constexpr std::array table = {Row{Ending::verified, exit_done}, Row{Ending::refused, exit_bad_input},
                              Row{Ending::infeasible, 3},       Row{Ending::not_certified, 4},
                              Row{Ending::budget, 4},           Row{Ending::some_failed, 5},
                              Row{Ending::interrupted, 130}};

}  // namespace

int exit_code(Ending ending) {
    for (const Row& row : table) {
        if (row.ending == ending) { return row.code; }
    }
    return exit_internal_error;
}

}  // namespace percuss::cli
