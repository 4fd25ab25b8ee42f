#pragma once

/// \file
/// Names of contacts for people.

#include <carom/core/constraint.h>
#include <carom/core/export.h>

#include <string>

namespace carom {

class System;

/// "particle 'lower' on half-plane #0", "disc 'rim' (feature 0) of rigid body #1 on half-plane #0", "disc #0
/// (feature 0) of rigid body #1 on disc #1 (feature 1) of rigid body #2", "stop #2 (upper)". Parts that were removed from the system keep their names; "no contact" for a key made by
/// default. Throws ModelError for a key whose features no part of this system ever had. Keys hold no trace of
/// their system: one of another system is named by the parts that have its serial numbers here.
[[nodiscard]] CAROM_API std::string contact_name(const System& system, const ConstraintKey& key);

}  // namespace carom
