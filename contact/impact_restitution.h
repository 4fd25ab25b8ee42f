#pragma once

/// \file
/// One restitution for a whole impact: friction in joints takes part with that of the contact that strikes.

#include <carom/core/constraint.h>
#include <carom/core/export.h>

#include <span>

namespace carom {

/// Gives friction in joints the normal restitution of the contact that approaches fastest. Impulses P over
/// velocities gamma change the kinetic energy by P.(gamma^- + gamma^+)/2; with one e over all rows none of
/// the laws |P| <= bound, P against (e gamma^- + gamma^+)/(1 + e) can make that positive, whatever the bounds
/// (docs/joints.md). Without restitution friction in joints could, beside a contact with e > 0. Where nothing
/// approaches faster than `least_speed` it gets none: it holds joints for good there.
/// \param velocities of all bodies \param least_speed [m/s]
CAROM_API void share_impact_restitution(std::span<Constraint> contacts, const double* velocities,
                                        double least_speed);

}  // namespace carom
