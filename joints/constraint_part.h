#pragma once

/// \file
/// The constraint parts of planar joints: scalar conditions between the ends of two bodies.
///
///     point     e.d = 0          along an axis e of the fixed frame,  d = p_to - p_from
///     line      a.d - f(t) = 0   along an axis a fixed to `from`
///     angle     sum c_k angle_k - f(t) = 0
///     distance  |d| - f(t) = 0
///
/// A line may contain angles (rolling).

#include <carom/core/end.h>
#include <carom/core/export.h>
#include <carom/core/part_check.h>
#include <carom/core/space.h>

#include <cstdint>
#include <span>

namespace carom::planar {

/// One constraint part: a scalar condition between two ends, as described.
struct ConstraintPart {
  /// How the distance d between the ends enters.
  enum class Form : std::uint8_t { angles, fixed_axis, axis_of_from, distance };

  Form form = Form::angles;      ///< how the distance enters
  End<2> from{};                 ///< a body or ground
  End<2> to{};                   ///< a body or ground
  Vec<2> axis = filled<2>(0.0);  ///< of unit length, in the fixed frame or that of `from`
  double turn_from = 0.0;        ///< coefficient of the angle of `from` [1, m]
  double turn_to = 0.0;          ///< coefficient of the angle of `to` [1, m]
  BodyId carrier = ground;       ///< a third body whose angle may enter
  double turn_carrier = 0.0;     ///< coefficient of the angle of `carrier` [1, m]
  double offset = 0.0;           ///< is subtracted [m, rad]
};

/// Demands `count` constraint parts, all between the same ends.
CAROM_API void check_constraint_parts(const PartCheck& check, std::span<const ConstraintPart> constraints,
                                      Index count);

}  // namespace carom::planar
