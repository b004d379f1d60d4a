#pragma once
/// \file

namespace percuss::cli {

/// From now on the first SIGINT or SIGTERM only sets a flag, so that results so far can be kept; the second one ends
/// the program as usual.
void watch_for_interrupts();

/// Whether a signal has arrived.
bool interrupted();

}  // namespace percuss::cli
