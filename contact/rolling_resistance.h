#pragma once

/// \file
/// Rolling resistance of a planar contact: a moment |M| <= rho P_n against the relative spin of its bodies.

#include <carom/core/constraint.h>
#include <carom/core/export.h>

namespace carom {

/// Row of the rolling resistance of a contact, which it follows in every list: the spin of its first body
/// less that of the second; the ground stands still. Bodies without orientation have no spin.
[[nodiscard]] CAROM_API Constraint rolling_resistance(const Constraint& contact);

}  // namespace carom
