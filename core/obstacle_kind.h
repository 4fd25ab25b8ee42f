#pragma once

/// \file
/// Interface of a kind of obstacles.

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

/// Position and motion of a rigid obstacle at a time, by its reference point o, about which it turns.
/// Constraint::drift is computed from it as for a flat boundary.
struct ObstacleMotion {
  std::array<double, 3> point{};         ///< o [m]
  std::array<double, 3> velocity{};      ///< of o [m/s]
  std::array<double, 3> acceleration{};  ///< of o [m/s^2]
  double angle = 0.0;                    ///< turned from how the obstacle is described [rad]
  double cosine = 1.0;                   ///< of the angle
  double sine = 0.0;                     ///< of the angle
  double spin = 0.0;                     ///< [rad/s]
  double angular_acceleration = 0.0;     ///< [rad/s^2]
  bool velocity_given = false;           ///< by the user, not by differences of the place
  bool spin_given = false;               ///< likewise
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

  /// True if the obstacle has a prescribed motion. For one at rest gap() is called; for a moving one place()
  /// once for each time, and moved_gap() for each point.
  [[nodiscard]] virtual bool moves(Index /*slot*/) const { return false; }
  /// Position and motion of a moving obstacle at a time [s]. Not finite where its functions are not.
  [[nodiscard]] virtual ObstacleMotion place(Index /*slot*/, double /*time*/) const { return {}; }
  /// Appends the times [s], in their order, at which the velocity of a moving obstacle jumps or its motion
  /// has a kink. place() at such a time gives the motion after it. The place itself does not jump.
  virtual void breaks(Index /*slot*/, std::vector<double>& /*out*/) const {}

  /// Distance of a point from an obstacle at rest. \param point 2 or 3 numbers [m]
  [[nodiscard]] virtual Gap gap(Index slot, const double* point) const = 0;
  /// Distance of a point from a moving obstacle, with the motion from place().
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
  /// Adds all data that distinguish the obstacles of this kind (except functions).
  virtual void fingerprint(Fingerprint& print) const = 0;
};

}  // namespace carom
