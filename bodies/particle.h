#pragma once

/// \file
/// Particles: bodies with a position only.

#include <carom/core/body_kind.h>
#include <carom/core/part.h>
#include <carom/core/part_check.h>
#include <carom/core/space.h>

#include <cstdint>
#include <limits>

namespace carom {

namespace generic {

/// A point mass. Coordinates: its position; velocities: its velocity.
template <int D>
struct Particle {
  static constexpr Role role = Role::body;
  /// Its type, for System::add().
  [[nodiscard]] CAROM_API static PartType<BodyKind> part_type();

  double mass = std::numeric_limits<double>::quiet_NaN();  ///< > 0 [kg]
  Vec<D> position = filled<D>(0.0);                        ///< at the start [m]
  Vec<D> velocity = filled<D>(0.0);                        ///< at the start [m/s]
  bool contact = true;                                     ///< touches obstacles
  MaterialId material{};                                   ///< for laws between materials
  ContactFilter filter{};                                  ///< what it may touch
};

}  // namespace generic

namespace planar {
using Particle = generic::Particle<2>;  ///< generic::Particle in the plane
}
namespace spatial {
using Particle = generic::Particle<3>;  ///< generic::Particle in space
}

}  // namespace carom
