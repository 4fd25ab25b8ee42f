#pragma once

/// \file
/// The methods that integrate smooth phases.

#include <cstdint>

namespace carom {

/// Methods of integration. Free flight under constant fields needs none: whatever the method, it is the exact
/// parabola (BallisticFlow).
enum class FlowMethod : std::uint8_t {
  explicit_runge_kutta,  ///< SUNDIALS' ARKODE, order 5: cheap restarts, for motion that is not stiff
  adams,                 ///< SUNDIALS' CVODE, Adams-Moulton with fixed point: long smooth phases
  bdf,                   ///< SUNDIALS' CVODE, BDF with Newton's method, sparse matrices: stiff force elements
  one_step               ///< our own explicit Runge-Kutta, order 5: the least overhead, for small components
};

}  // namespace carom
