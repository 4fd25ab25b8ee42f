#pragma once

/// \file
/// Place and directions of a contact in the fixed frame, and vectors of its numbers.

#include <carom/core/space.h>

#include <array>
#include <cstddef>

namespace carom {

/// Where a contact touches, and the directions in the fixed frame that its numbers are along: the normal
/// first, then the tangents. All are zero of a limit of a joint, which has a coordinate but no direction in
/// space.
struct ContactFrame {
  std::array<double, 3> point{};   ///< where it touches, when it was detected [m]; 0 of a limit
  std::array<double, 3> normal{};  ///< unit vector towards `body`, at detection; 0 of a limit
  /// Unit vectors of the tangential directions. In the plane the first one alone, the normal turned
  /// clockwise; in space two, at right angles to each other and to the normal. 0 where there is none.
  std::array<std::array<double, 3>, 2> tangents{};

  /// Vector in the fixed frame of numbers by direction, as records have them: of an impulse [N s] or a force
  /// [N], which acts on `body`, or of a velocity [m/s], of `body` against what it touches. Zero of a limit of
  /// a joint. The moment of rolling resistance is no part of it: that is along a spin, and a number of its
  /// own in the record.
  [[nodiscard]] Vec<3> vector_of(const std::array<double, 3>& by_direction) const;
};

inline Vec<3> ContactFrame::vector_of(const std::array<double, 3>& by_direction) const {
  const auto component = [&](std::size_t i) {
    return by_direction[0] * normal[i] + by_direction[1] * tangents[0][i] + by_direction[2] * tangents[1][i];
  };
  return {component(0), component(1), component(2)};
}

}  // namespace carom
