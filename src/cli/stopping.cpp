#include "cli/stopping.hpp"

#include "cli/interrupt.hpp"

#include <chrono>

namespace percuss::cli {

using Clock = std::chrono::steady_clock;
using verbs::Ending;

verbs::StopRequest stop_request(const std::optional<double>& time_limit) {
    const auto begun = Clock::now();
    return [time_limit, begun] {
        return interrupted() ||
               (time_limit && std::chrono::duration<double>(Clock::now() - begun).count() >= *time_limit);
    };
}

Ending told_apart(Ending ending) {
    const bool unfinished =
        ending == Ending::interrupted || ending == Ending::budget || ending == Ending::not_certified;
    if (unfinished && interrupted()) { return Ending::interrupted; }
    return ending == Ending::interrupted ? Ending::budget : ending;
}

}  // namespace percuss::cli
