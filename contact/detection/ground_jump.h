#pragma once

/// \file
/// Jumps of the velocity of shapes on ground at the discontinuities of their motion.

#include <carom/core/constraint.h>
#include <carom/core/export.h>
#include <carom/core/ground_shape_kind.h>
#include <carom/core/ids.h>

#include <array>
#include <span>

namespace carom {

/// The velocity of one shape jumps. Of the plane.
struct GroundJump {
  double time = 0.0;                 ///< when [s]
  Index serial = none;               ///< serial number of the shape
  std::array<double, 2> point{};     ///< o then, about which it turns [m]
  std::array<double, 2> velocity{};  ///< by how much that of o jumps [m/s]
  double spin = 0.0;                 ///< by how much its spin does [rad/s]
};

/// By how much the velocity of the place that a constraint touches jumps along its rows, the sum over jumps
/// of its shape [m/s]. \param q coordinates of its body
[[nodiscard]] CAROM_API std::array<double, 3> jump_along_rows(std::span<const GroundJump> jumps,
                                                              const Constraint& constraint, const double* q);

}  // namespace carom
