#pragma once

/// \file
/// Joints with a fixed distance or ratio: massless rigid rod, pair of gears.

#include <carom/joints/joint.h>

#include <limits>
#include <string_view>
#include <vector>

namespace carom::planar {

/// A massless rigid rod between two ends that can turn freely at both. It has no coordinate. The force on
/// `to` is along the rod.
struct CAROM_API Rod {
  static constexpr Role role = Role::joint;
  static constexpr std::string_view label = "rod";
  static constexpr Index row_count = 1;
  /// Its type, for System::add().
  [[nodiscard]] static PartType<JointKind> part_type();

  End<2> from{};                                             ///< a body or ground (required)
  End<2> to{};                                               ///< a body or ground (required)
  double length = std::numeric_limits<double>::quiet_NaN();  ///< [m]; as described unless given

  /// Its constraint parts. Throws ModelError for an invalid end or length.
  [[nodiscard]] std::vector<ConstraintPart> constraints(const PartCheck& check) const;
};

/// A pair of gears: a_to + ratio a_from, angles relative to the carrier, keeps its value in the described
/// positions. Gears with external teeth turn in opposite directions, ratio = r_from/r_to > 0; a negative
/// ratio is for a ring gear or a belt.
struct CAROM_API Gear {
  static constexpr Role role = Role::joint;
  static constexpr std::string_view label = "gear pair";
  static constexpr Index row_count = 1;
  /// Its type, for System::add().
  [[nodiscard]] static PartType<JointKind> part_type();

  BodyId from{};                                            ///< a rigid body (required)
  BodyId to{};                                              ///< a rigid body (required)
  double ratio = std::numeric_limits<double>::quiet_NaN();  ///< r_from/r_to, not 0 (required)
  BodyId carrier = ground;                                  ///< carries both axles: a rigid body or ground

  /// Its constraint parts. Throws ModelError for an invalid body or ratio.
  [[nodiscard]] std::vector<ConstraintPart> constraints(const PartCheck& check) const;
};

}  // namespace carom::planar
