#pragma once
/// \file
/// When a study must end early, and what its ending then means.

#include "study/study.hpp"

#include <optional>

namespace percuss::cli {

/// True once a signal has come or the time limit (seconds from now) is over.
study::StopRequest stop_request(const std::optional<double>& time_limit);

/// A study that was stopped cannot know by what: with a signal it was interrupted, without one its time was over.
study::Ending told_apart(study::Ending ending);

}  // namespace percuss::cli
