#pragma once
/// \file
/// How a long computation learns that it must end early.

#include <functional>

namespace percuss::numerics {

/// True once the caller wants no more: a deadline is over, or a signal has come. Asked often and from any thread, so it
/// must be cheap (tens of nanoseconds) and safe to call concurrently. An empty function means never.
using CancelRequest = std::function<bool()>;

}  // namespace percuss::numerics
