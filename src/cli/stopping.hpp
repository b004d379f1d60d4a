#pragma once
/// \file
/// When a study must end early, and what its ending then means.

#include "verbs/study.hpp"

#include <optional>

namespace percuss::cli {

/// True once a signal has come or the time limit (seconds from now) is over.
verbs::StopRequest stop_request(const std::optional<double>& time_limit);

/// A study that was stopped cannot know by what: with a signal it was interrupted, without one its time was over.
verbs::Ending told_apart(verbs::Ending ending);

}  // namespace percuss::cli
