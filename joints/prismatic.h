#pragma once

/// \file
/// Joints that keep a point on a line: slide, pin in slot, rolling without slip.

#include <carom/joints/joint.h>

#include <limits>
#include <string_view>
#include <vector>

namespace carom::planar {

/// A slide: `to` moves along a line fixed to `from` without relative rotation. Its coordinate is the position
/// of the end of `to` along the axis, from the end of `from`, minus its value in the described positions; or
/// minus `zero_distance` if that is given.
struct CAROM_API Prismatic {
  static constexpr Role role = Role::joint;
  static constexpr std::string_view label = "prismatic joint";
  static constexpr Index row_count = 2;
  /// Its type, for System::add().
  [[nodiscard]] static PartType<JointKind> part_type();

  End<2> from{};  ///< a rigid body or ground: a point of the line (required)
  End<2> to{};    ///< a rigid body or ground: the point that slides (required)
  Vec<2> axis = filled<2>(std::numeric_limits<double>::quiet_NaN());  ///< of the line, in the frame of
                                                                      ///< `from`, any length > 0 (required)
  double angle = std::numeric_limits<double>::quiet_NaN();  ///< angle of `to` minus that of `from` [rad];
                                                            ///< unless given, as described
  double zero_distance = std::numeric_limits<double>::quiet_NaN();  ///< along the axis at coordinate 0 [m]

  /// Its constraint parts. Throws ModelError for an invalid end, axis or angle.
  [[nodiscard]] std::vector<ConstraintPart> constraints(const PartCheck& check) const;
  /// The distance along the axis.
  [[nodiscard]] ConstraintPart coordinate(const PartCheck& check) const;
};

/// A pin in a slot: the end of `to` stays on a line fixed to `from`; both may turn. Its coordinate is that of
/// Prismatic.
struct CAROM_API PointOnLine {
  static constexpr Role role = Role::joint;
  static constexpr std::string_view label = "point-on-line joint";
  static constexpr Index row_count = 1;
  /// Its type, for System::add().
  [[nodiscard]] static PartType<JointKind> part_type();

  End<2> from{};  ///< a rigid body or ground: a point of the line (required)
  End<2> to{};    ///< a body or ground: the pin (required)
  Vec<2> axis = filled<2>(std::numeric_limits<double>::quiet_NaN());  ///< of the line, in the frame of
                                                                      ///< `from`, any length > 0 (required)
  double zero_distance = std::numeric_limits<double>::quiet_NaN();    ///< along the axis at coordinate 0 [m]

  /// Its constraint parts. Throws ModelError for an invalid end or axis.
  [[nodiscard]] std::vector<ConstraintPart> constraints(const PartCheck& check) const;
  /// The distance along the axis.
  [[nodiscard]] ConstraintPart coordinate(const PartCheck& check) const;
};

/// Rolling without slip: a disc of `to` with its centre at the end of `to` rolls on a line fixed to `from`
/// through the end of `from`, on the side of the normal. Bilateral: it neither lifts off nor slips. Its
/// coordinate is the position of the centre along the line (the normal turned clockwise) minus its value in
/// the described positions. Reaction: the force at the line, given at the centre with its moment.
struct CAROM_API Rolling {
  static constexpr Role role = Role::joint;
  static constexpr std::string_view label = "rolling joint";
  static constexpr Index row_count = 2;
  /// Its type, for System::add().
  [[nodiscard]] static PartType<JointKind> part_type();

  End<2> from{};  ///< a rigid body or ground: a point of the line (required)
  End<2> to{};    ///< a rigid body: the centre of the disc (required)
  Vec<2> normal = filled<2>(std::numeric_limits<double>::quiet_NaN());  ///< of the line, in the frame of
                                                                        ///< `from`, any length > 0 (required)
  double radius = std::numeric_limits<double>::quiet_NaN();             ///< of the disc [m] (required)

  /// Its constraint parts. Throws ModelError for an invalid end, normal or radius.
  [[nodiscard]] std::vector<ConstraintPart> constraints(const PartCheck& check) const;
  /// The distance along the line.
  [[nodiscard]] ConstraintPart coordinate(const PartCheck& check) const;
};

}  // namespace carom::planar
