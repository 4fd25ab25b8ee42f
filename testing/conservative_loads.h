#pragma once

/// \file
/// A check of force elements: their conservative loads belong to their potential.

#include <carom/core/system.h>
#include <carom/testing/verdict.h>

namespace carom::energy_test {

/// At the described state, the conservative loads are minus the gradient of the potential energy, each within
/// `tolerance` [N, N m]: this finds a wrong sign, a forgotten lever or a wrong factor. The verdict shows the
/// loads that differ. Throws ModelError as Assembly, and for a tolerance that is negative or not finite.
[[nodiscard]] Verdict check_conservative_loads(const System& system, double tolerance);

}  // namespace carom::energy_test
