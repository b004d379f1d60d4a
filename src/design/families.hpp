#pragma once
/// \file
/// Continuation parameters as users name them: the drive frequency, or a key of the problem file.

#include "flow/parameter_family.hpp"
#include "model/specification.hpp"

namespace percuss::design {

/// What counts as order one in the displacement of motions that reach the stop: the gap.
double motion_size(const flow::System& system);

/// omega, nondimensional, with everything else as in `system`.
flow::ParameterFamily frequency_family(const flow::System& system);

/// One key of the specification, in its own unit; the drive frequency in Hz (or the nondimensional omega) is that of
/// `spec` and stays. unit: what counts as a change of order one. Throws std::invalid_argument for a key that is not of
/// the family or has no derivative.
flow::ParameterFamily key_family(const flow::System& system, const model::Specification& spec, model::Key key,
                                 double unit);

/// Two parameters: omega, nondimensional, and a key. The specification needs no frequency.
flow::ParameterFamily frequency_and_key_family(const flow::System& system, const model::Specification& spec,
                                               model::Key key, double unit);

}  // namespace percuss::design
