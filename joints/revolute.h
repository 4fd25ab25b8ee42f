#pragma once

/// \file
/// Joints that keep a point of one body on a point of another: pin and weld.

#include <carom/joints/joint.h>

#include <limits>
#include <string_view>
#include <vector>

namespace carom::planar {

/// The conditions that two ends coincide, along the axes of the fixed frame: their multipliers are the force
/// on `to` [N].
[[nodiscard]] CAROM_API std::vector<ConstraintPart> point_constraints(const End<2>& from, const End<2>& to);
/// The angle of `to` relative to `from` minus `offset`.
[[nodiscard]] CAROM_API ConstraintPart angle_constraint(BodyId from, BodyId to, double offset);

/// A pin: the two ends coincide. Its coordinate is the angle of `to` relative to `from`, full turns counted;
/// it is zero in the described positions unless `zero_angle` sets another zero.
struct CAROM_API Revolute {
  static constexpr Role role = Role::joint;
  static constexpr std::string_view label = "revolute joint";
  static constexpr Index row_count = 2;
  /// Its type, for System::add().
  [[nodiscard]] static PartType<JointKind> part_type();

  End<2> from{};  ///< a body or ground (required)
  End<2> to{};    ///< a body or ground (required)
  double zero_angle =
      std::numeric_limits<double>::quiet_NaN();  ///< angle of `to` minus that of `from` at coordinate 0 [rad]

  /// Its constraint parts. Throws ModelError for invalid ends.
  [[nodiscard]] std::vector<ConstraintPart> constraints(const PartCheck& check) const;
  /// Its angle; 0 for particles, which have none.
  [[nodiscard]] ConstraintPart coordinate(const PartCheck& check) const;
};

/// A weld: the two ends coincide and the angle between the bodies is fixed, as described unless `angle` is
/// given.
struct CAROM_API Weld {
  static constexpr Role role = Role::joint;
  static constexpr std::string_view label = "weld";
  static constexpr Index row_count = 3;
  /// Its type, for System::add().
  [[nodiscard]] static PartType<JointKind> part_type();

  End<2> from{};                                            ///< a rigid body or ground (required)
  End<2> to{};                                              ///< a rigid body or ground (required)
  double angle = std::numeric_limits<double>::quiet_NaN();  ///< angle of `to` minus that of `from` [rad]

  /// Its constraint parts. Throws ModelError for invalid ends.
  [[nodiscard]] std::vector<ConstraintPart> constraints(const PartCheck& check) const;
};

}  // namespace carom::planar
