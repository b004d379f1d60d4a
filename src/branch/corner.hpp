#pragma once
/// \file
/// Grazing points on a branch: where one contact more or less begins, and how the branch goes on from there.

#include "branch/locate.hpp"
#include "branch/trace.hpp"

#include <optional>

namespace percuss::branch {

struct Corner {
    Point at;  ///< the grazing motion
    double uncertainty = 0.0;
    int contact = 0;  ///< which of the grazing motion's contacts touches
    /// In front of the corner, on the side that the branch comes from. Leaving: the sequence with the contact at a very
    /// small speed. Entering: the grazing motion in the form without the contact.
    CurvePoint in_front;
    Departure onward;
    bool shorter_period = false;  ///< leaving: what remains repeats sooner, it belongs to a branch of shorter period
    std::optional<int> entering_contact;  ///< in the sequence of `onward`; none when a contact has left
};

/// The contact whose entry speed has become negative, if any: the one furthest beyond grazing.
std::optional<int> contact_leaving(const orbit::Motion& motion);

/// From `last` the piece has stepped to where this contact's entry speed is negative.
std::optional<Corner> leave_contact(const flow::ParameterFamily& family, Piece& piece, const CurvePoint& last,
                                    int contact, const TraceOptions& options);

/// From `last` the piece has stepped to where the hybrid flow meets a contact that the form does not have (`seen`).
std::optional<Corner> enter_contact(const flow::ParameterFamily& family, Piece& piece, const CurvePoint& last,
                                    const Point& seen, const TraceOptions& options);

}  // namespace percuss::branch
