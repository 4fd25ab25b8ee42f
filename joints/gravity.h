#pragma once

/// \file
/// Uniform gravity.

#include <carom/core/force_kind.h>
#include <carom/core/part.h>
#include <carom/core/part_check.h>
#include <carom/core/space.h>

#include <limits>
#include <vector>

namespace carom {

namespace generic {

/// Uniform gravity on every body. Potential energy -m g.x, zero at the origin.
template <int D>
struct Gravity {
  static constexpr Role role = Role::force;
  /// Its type, for System::add().
  [[nodiscard]] CAROM_API static PartType<ForceKind> part_type();

  Vec<D> acceleration = filled<D>(std::numeric_limits<double>::quiet_NaN());  ///< g [m/s^2]
};

}  // namespace generic

namespace planar {
using Gravity = generic::Gravity<2>;  ///< generic::Gravity in the plane
}
namespace spatial {
using Gravity = generic::Gravity<3>;  ///< generic::Gravity in space
}

}  // namespace carom
