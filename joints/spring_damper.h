#pragma once

/// \file
/// Linear spring with a dashpot in parallel.

#include <carom/core/end.h>
#include <carom/core/force_kind.h>
#include <carom/core/numerics/pair.h>
#include <carom/core/part.h>

#include <limits>
#include <vector>

namespace carom {

namespace generic {

/// Spring and dashpot between two ends, along the line between them: with d from `from` to `to`, l = |d|,
/// the force on `to` is -(k (l - L) + c dl/dt) d/l. At l = 0 the direction is undefined: for L = 0 the
/// spring's force is zero there by continuity, for L > 0 it is set to zero, as is the dashpot's. No run
/// begins where k L > 0 and l = 0 (ModelError).
template <int D>
struct SpringDamper {
  static constexpr Role role = Role::force;
  /// Its type, for System::add().
  [[nodiscard]] CAROM_API static PartType<ForceKind> part_type();

  End<D> from{};             ///< required
  End<D> to{};               ///< required
  double stiffness = 0.0;    ///< k >= 0 [N/m]
  double damping = 0.0;      ///< c >= 0 [N s/m]
  double free_length = 0.0;  ///< L >= 0 [m]
};

}  // namespace generic

namespace planar {
using SpringDamper = generic::SpringDamper<2>;  ///< generic::SpringDamper in the plane
}
namespace spatial {
using SpringDamper = generic::SpringDamper<3>;  ///< generic::SpringDamper in space
}

}  // namespace carom
