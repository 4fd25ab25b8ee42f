#pragma once

/// \file
/// Place and directions of a contact in the fixed frame, and vectors of its numbers.

#include <carom/core/space.h>

#include <array>

namespace carom {

/// Where a contact touches, and the directions in the fixed frame that its numbers are along: the normal
/// first, then the tangents, which follow from it. A limit of a joint has a coordinate, but no direction in
/// space: all are zero.
struct ContactFrame {
  std::array<double, 3> point{};   ///< where it touches, when it was detected [m]; 0 of a limit
  std::array<double, 3> normal{};  ///< unit vector towards `body`, at detection; 0 of a limit
  int directions = 2;              ///< numbers that it has: 2 in the plane, 3 in space; 1 of a limit

  /// Unit vectors of the tangential directions. In the plane the first one alone, the normal turned
  /// clockwise; in space two, at right angles to each other and to the normal. 0 where there is none.
  [[nodiscard]] std::array<Vec<3>, 2> tangents() const;
  /// Vector in the fixed frame of numbers by direction, as records have them: of an impulse [N s] or a force
  /// [N], which acts on `body`, or of a velocity [m/s], of `body` against what it touches. Zero of a limit of
  /// a joint. The moment of rolling resistance is no part of it: that is along a spin, and a number of its
  /// own in the record.
  [[nodiscard]] Vec<3> vector_of(const std::array<double, 3>& by_direction) const;
};

inline std::array<Vec<3>, 2> ContactFrame::tangents() const {
  if (directions > 2) return Space<3>::tangent_frame(Vec<3>(normal.data()));
  std::array<Vec<3>, 2> out{Vec<3>::Zero(), Vec<3>::Zero()};
  if (directions == 2) out[0].head<2>() = Space<2>::tangent_frame(Vec<2>(normal[0], normal[1]))[0];
  return out;
}

inline Vec<3> ContactFrame::vector_of(const std::array<double, 3>& by_direction) const {
  if (directions < 2) return Vec<3>::Zero();
  const std::array<Vec<3>, 2> along = tangents();
  return by_direction[0] * Vec<3>(normal.data()) + by_direction[1] * along[0] + by_direction[2] * along[1];
}

}  // namespace carom
