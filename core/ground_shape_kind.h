#pragma once

/// \file
/// Interface of a kind of shapes on ground: shapes fixed to the ground, or moved as prescribed.

#include <carom/core/shape_kind.h>

#include <array>
#include <vector>

namespace carom {

/// Distance from a shape and its gradient.
struct Gap {
  double distance = 0.0;           ///< positive outside, negative inside [m]
  std::array<double, 3> normal{};  ///< unit gradient, from the shape into free space
};

/// Position and motion of a shape on ground at a time, by its reference point o, about which it turns.
/// Constraint::drift is computed from it as for a flat boundary.
struct GroundMotion {
  std::array<double, 3> point{};         ///< o [m]
  std::array<double, 3> velocity{};      ///< of o [m/s]
  std::array<double, 3> acceleration{};  ///< of o [m/s^2]
  double angle = 0.0;                    ///< turned from how the shape is described [rad]
  double cosine = 1.0;                   ///< of the angle
  double sine = 0.0;                     ///< of the angle
  double spin = 0.0;                     ///< [rad/s]
  double angular_acceleration = 0.0;     ///< [rad/s^2]
  bool velocity_given = false;           ///< by the user, not by differences of the place
  bool spin_given = false;               ///< likewise
};

/// All shapes on ground of one kind. Points of bodies touch them; they touch nothing themselves.
class CAROM_API GroundShapeKind : public ShapeKind {
public:
  [[nodiscard]] BodyId body(Index /*slot*/) const final { return ground; }
  void rounded_points(Index /*slot*/, std::vector<RoundedPoint>& /*out*/) const final {}

  /// True if the shape has a prescribed motion. For one at rest gap() is called; for a moving one place()
  /// once for each time, and moved_gap() for each point.
  [[nodiscard]] virtual bool moves(Index /*slot*/) const { return false; }
  /// Position and motion of a moving shape at a time [s]. Not finite where its functions are not.
  [[nodiscard]] virtual GroundMotion place(Index /*slot*/, double /*time*/) const { return {}; }
  /// Appends the times [s], in their order, at which the velocity of a moving shape jumps or a function of
  /// its motion is not smooth. place() at such a time gives the motion after it. The place itself does not
  /// jump.
  virtual void discontinuity_times(Index /*slot*/, std::vector<double>& /*out*/) const {}

  /// Distance of a point from a shape at rest. \param point 2 or 3 numbers [m]
  [[nodiscard]] virtual Gap gap(Index slot, const double* point) const = 0;
  /// Distance of a point from a moving shape, with the motion from place().
  [[nodiscard]] virtual Gap moved_gap(Index slot, const GroundMotion& /*motion*/, const double* point) const {
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
  [[nodiscard]] virtual bool any_within_moved(Index slot, const GroundMotion& motion, const double* points,
                                              Index stride, Index count, double margin) const {
    for (Index i = 0; i < count; ++i) {
      if (moved_gap(slot, motion, points + i * stride).distance <= margin) return true;
    }
    return false;
  }
};

}  // namespace carom
