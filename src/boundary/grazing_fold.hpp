#pragma once
/// \file
/// The fold that stands beside a grazing point on the impacting side, located in the entry speed v, in which the branch
/// is smooth.

#include "boundary/boundary.hpp"
#include "orbit/contact_sequence.hpp"

namespace percuss::boundary {

struct GrazingFold {
    enum class Status : std::uint8_t {
        not_run,
        found,    ///< a fold at entry speed `speed`
        at_once,  ///< the impacting branch leaves the grazing point against the free one: the fold is the point itself
        none,     ///< no fold up to `reach`: impacts set in without a jump
        failed,
    };
    Status status = Status::not_run;
    double speed = 0.0;   ///< entry speed at the fold, nondimensional
    double omega = 0.0;   ///< drive frequency of the fold
    double offset = 0.0;  ///< (omega_grazing - omega_fold)/omega_grazing
    double reach = 0.0;   ///< relative distance below grazing that was searched
    orbit::ContactSequence sequence;
};

/// grazing: a converged upper grazing point (the free orbit touches as the frequency falls). `reach`: how far below it,
/// relative, a fold is of interest.
GrazingFold find_fold_beside(const flow::System& system, const Boundary& grazing, double reach);

/// Entry point of the impacting branch: the grazing orbit as a contact sequence with zero speed.
orbit::ContactSequence grazing_sequence(const flow::System& system, const orbit::ReturnMap& map,
                                        const Boundary& grazing);

}  // namespace percuss::boundary
