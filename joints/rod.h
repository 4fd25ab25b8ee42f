#pragma once

/// \file
/// Joints that keep a distance or a ratio: rigid rod without mass, pair of gears.

#include <carom/joints/joint.h>

#include <limits>
#include <string_view>
#include <vector>

namespace carom::planar {

/// A rigid rod without mass between two ends, free to turn at both. It has no coordinate. The force on
/// `to` is along the rod.
struct CAROM_API Rod {
  static constexpr Role role = Role::joint;
  static constexpr std::string_view label = "rod";
  static constexpr Index row_count = 1;

  End<2> from{};                                             ///< a body or ground (required)
  End<2> to{};                                               ///< a body or ground (required)
  double length = std::numeric_limits<double>::quiet_NaN();  ///< [m]; as described unless given

  /// What it binds. Throws ModelError for ends or a length that cannot be.
  [[nodiscard]] std::vector<Binding> bindings(const PartCheck& check) const;
};

/// A pair of gears: with the angles a against that of the carrier, a_to + ratio a_from stays what it is as
/// described. Gears that mesh outside turn against each other, ratio = r_from/r_to > 0; a negative ratio is
/// that of a gear within a ring, or of a belt.
struct CAROM_API Gear {
  static constexpr Role role = Role::joint;
  static constexpr std::string_view label = "gear pair";
  static constexpr Index row_count = 1;

  BodyId from{};                                            ///< a rigid body (required)
  BodyId to{};                                              ///< a rigid body (required)
  double ratio = std::numeric_limits<double>::quiet_NaN();  ///< r_from/r_to, not 0 (required)
  BodyId carrier = ground;                                  ///< what both turn on: a rigid body or ground

  /// What it binds. Throws ModelError for bodies or a ratio that cannot be.
  [[nodiscard]] std::vector<Binding> bindings(const PartCheck& check) const;
};

}  // namespace carom::planar
