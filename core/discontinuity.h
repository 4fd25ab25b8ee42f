#pragma once

/// \file
/// Times at which laws of time jump or are not smooth, with the part whose law it is.

#include <carom/core/ids.h>

#include <algorithm>
#include <span>

namespace carom {

/// A time at which a law of time is not smooth, as its part says (`breaks`). One of the identities is valid.
struct Discontinuity {
  double time = 0.0;      ///< [s]
  ElementId element{};    ///< whose load jumps
  JointId joint{};        ///< the driver whose prescribed coordinate jumps
  ObstacleId obstacle{};  ///< the shape on ground whose prescribed motion jumps
  friend bool operator==(const Discontinuity&, const Discontinuity&) = default;
};

/// Discontinuities at one time, of a list in ascending order of times.
[[nodiscard]] inline std::span<const Discontinuity> discontinuities_at(std::span<const Discontinuity> list,
                                                                       double time) {
  const auto first = std::lower_bound(list.begin(), list.end(), time,
                                      [](const Discontinuity& at, double t) { return at.time < t; });
  const auto last = std::upper_bound(first, list.end(), time,
                                     [](double t, const Discontinuity& at) { return t < at.time; });
  return {first, last};
}

}  // namespace carom
