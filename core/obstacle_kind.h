#pragma once

/// \file
/// What a kind of obstacle tells the rest of the library.

#include <carom/core/export.h>
#include <carom/core/fingerprint.h>
#include <carom/core/ids.h>

#include <array>
#include <memory>
#include <string_view>

namespace carom {

/// Distance from an obstacle and its gradient.
struct Gap {
  double distance = 0.0;           ///< positive outside, negative inside [m]
  std::array<double, 3> normal{};  ///< unit gradient, from the obstacle into free space
};

/// All obstacles of one kind.
class CAROM_API ObstacleKind {
public:
  virtual ~ObstacleKind() = default;
  [[nodiscard]] virtual std::unique_ptr<ObstacleKind> clone() const = 0;  ///< a copy
  virtual void remove(Index slot) = 0;  ///< removes an obstacle; later ones move up

  [[nodiscard]] virtual std::string_view label() const = 0;         ///< name used in messages
  [[nodiscard]] virtual int dimension() const = 0;                  ///< 2 or 3
  [[nodiscard]] virtual Index size() const = 0;                     ///< number of obstacles
  [[nodiscard]] virtual MaterialId material(Index slot) const = 0;  ///< its material
  /// Distance of a point from the obstacle. \param point 2 or 3 numbers [m]
  [[nodiscard]] virtual Gap gap(Index slot, const double* point) const = 0;
  /// True if gap() finds any of `count` points, `stride` numbers apart, at a distance <= `margin` [m].
  [[nodiscard]] virtual bool any_within(Index slot, const double* points, Index stride, Index count,
                                        double margin) const {
    for (Index i = 0; i < count; ++i) {
      if (gap(slot, points + i * stride).distance <= margin) return true;
    }
    return false;
  }
  /// Adds all that distinguishes this kind's obstacles.
  virtual void fingerprint(Fingerprint& print) const = 0;
};

}  // namespace carom
