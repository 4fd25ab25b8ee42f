#pragma once

/// \file
/// What a kind of obstacle tells the rest of the library.

#include <carom/core/export.h>
#include <carom/core/fingerprint.h>
#include <carom/core/ids.h>

#include <array>
#include <memory>
#include <string_view>
#include <vector>

namespace carom {

/// Distance from an obstacle and its gradient.
struct Gap {
  double distance = 0.0;           ///< positive outside, negative inside [m]
  std::array<double, 3> normal{};  ///< unit gradient, from the obstacle into free space
};

/// Where a rigid obstacle is at a time and how it moves: by the point o that it turns about. Contact::drift
/// is made of it as for a flat boundary.
struct ObstacleMotion {
  std::array<double, 3> point{};         ///< o [m]
  std::array<double, 3> velocity{};      ///< of o [m/s]
  std::array<double, 3> acceleration{};  ///< of o [m/s^2]
  double angle = 0.0;                    ///< turned from how the obstacle is described [rad]
  double cosine = 1.0;                   ///< of the angle
  double sine = 0.0;                     ///< of the angle
  double spin = 0.0;                     ///< [rad/s]
  double angular_acceleration = 0.0;     ///< [rad/s^2]
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

  /// True if the obstacle moves as prescribed. Where one at rest is, gap() says; of one that moves place()
  /// is asked once per time and moved_gap() as often as it takes.
  [[nodiscard]] virtual bool moves(Index /*slot*/) const { return false; }
  /// Where a moving obstacle is at a time [s] and how it moves. Not finite where its functions are not.
  [[nodiscard]] virtual ObstacleMotion place(Index /*slot*/, double /*time*/) const { return {}; }
  /// Appends the times [s], in their order, at which the velocity of a moving obstacle jumps or its motion
  /// has a kink. place() at such a time is what holds after it.
  virtual void breaks(Index /*slot*/, std::vector<double>& /*out*/) const {}

  /// Distance of a point from an obstacle at rest. \param point 2 or 3 numbers [m]
  [[nodiscard]] virtual Gap gap(Index slot, const double* point) const = 0;
  /// Distance of a point from a moving obstacle; the motion is what place() said.
  [[nodiscard]] virtual Gap moved_gap(Index slot, const ObstacleMotion& /*motion*/,
                                      const double* point) const {
    return gap(slot, point);
  }
  /// True if gap() finds any of `count` points, `stride` numbers apart, at a distance <= `margin` [m].
  [[nodiscard]] virtual bool any_within(Index slot, const double* points, Index stride, Index count,
                                        double margin) const {
    for (Index i = 0; i < count; ++i) {
      if (gap(slot, points + i * stride).distance <= margin) return true;
    }
    return false;
  }
  /// Likewise with moved_gap().
  [[nodiscard]] virtual bool any_within_moved(Index slot, const ObstacleMotion& motion, const double* points,
                                              Index stride, Index count, double margin) const {
    for (Index i = 0; i < count; ++i) {
      if (moved_gap(slot, motion, points + i * stride).distance <= margin) return true;
    }
    return false;
  }
  /// Adds all that distinguishes this kind's obstacles (functions cannot).
  virtual void fingerprint(Fingerprint& print) const = 0;
};

}  // namespace carom
