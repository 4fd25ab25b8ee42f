#pragma once

/// \file
/// Interface of a kind of shapes on ground: shapes fixed to the ground, or moved as prescribed.

#include <carom/core/shape_kind.h>

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace carom {

/// Points of which each is `stride` numbers behind the one before.
struct PointRow {
  static constexpr Index most = 64;  ///< that are looked at together

  const double* points = nullptr;  ///< of the first
  Index stride = 0;                ///< numbers from one to the next
  Index count = 0;                 ///< of points

  /// Coordinates of point i.
  [[nodiscard]] const double* point(Index i) const { return points + i * stride; }
};

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
  bool spin_given = false;               ///< by the user, not by differences of the angle
};

/// A piece of the boundary of a shape on ground in the plane. Places are measured from the point o about
/// which the shape turns (GroundMotion), as the shape is described.
struct GroundPiece {
  /// Forms of pieces.
  enum class Form : std::uint8_t {
    solid,  ///< a convex set: the vertices of its outline, counter-clockwise, each of them a corner
    face,  ///< one face of a polyline, free space on its right: the vertex before it, its tail, its head, and
           ///< the vertex behind it
    hollow  ///< everything but the inside of a circle: the circle's centre
  };
  Form form = Form::solid;       ///< what it is
  std::vector<Vec<2>> points{};  ///< as its form says [m]
  double radius = 0.0;           ///< of a solid's outline, or of the circle [m]
  bool tail_is_free = false;  ///< of a face: it has no neighbour at its tail, and the first point no meaning
  bool head_is_free = false;  ///< of a face: it has no neighbour at its head, and the last point no meaning
  double depth =
      std::numeric_limits<double>::infinity();  ///< of a face: how far below it the ground is solid [m]
};

/// All shapes on ground of one kind. Bodies touch them, with points or with outlines; they touch nothing
/// themselves.
class CAROM_API GroundShapeKind : public ShapeKind {
public:
  [[nodiscard]] BodyId body(Index /*slot*/) const final { return ground; }
  void rounded_points(Index /*slot*/, std::vector<RoundedPoint>& /*out*/) const final {}

  /// Appends the pieces that the outlines of bodies touch, in a fixed order. None: rounded points of bodies
  /// touch the shape, as gap() says. A shape that has pieces is infinitely far for gap().
  virtual void pieces(Index /*slot*/, std::vector<GroundPiece>& /*out*/) const {}
  /// Velocity of the surface of a shape in the plane along itself, beside that of its motion: of a conveyor.
  /// Positive to the right of someone who stands on it [m/s].
  [[nodiscard]] virtual double surface_speed(Index /*slot*/) const { return 0.0; }

  /// True if the shape has a prescribed motion. For one at rest gap() is called; for a moving one place()
  /// once for each time, and moved_gap() for each point.
  [[nodiscard]] virtual bool moves(Index /*slot*/) const { return false; }
  /// Position and motion of a moving shape at a time [s]. Not finite where its functions are not.
  [[nodiscard]] virtual GroundMotion place(Index /*slot*/, double /*time*/) const { return {}; }
  /// Appends the times [s], in their order, at which the velocity of a moving shape jumps or a function of
  /// its motion is not smooth. place() at such a time gives the motion after it. The place itself does not
  /// jump.
  virtual void discontinuity_times(Index /*slot*/, std::vector<double>& /*out*/) const {}

  /// True if the boundary that gap() describes is flat. Of others the curvature is found by differences of
  /// gap(), which is called twice more for each contact. That of pieces is exact.
  [[nodiscard]] virtual bool is_flat(Index /*slot*/) const { return false; }
  /// Distance of a point from a shape at rest. A distance that is no number, or a normal whose length is not
  /// 1 (to 1e-6), ends the run with a SolverError where the point touches. \param point 2 or 3 numbers [m]
  [[nodiscard]] virtual Gap gap(Index slot, const double* point) const = 0;
  /// Distance of a point from a moving shape, with the motion from place().
  [[nodiscard]] virtual Gap moved_gap(Index slot, const GroundMotion& /*motion*/, const double* point) const {
    return gap(slot, point);
  }
  /// Which of up to 64 points gap() finds at a distance <= `margin` [m], or at one that is no number: bit i
  /// of the point number i.
  [[nodiscard]] virtual std::uint64_t points_within(Index slot, const PointRow& row, double margin) const {
    std::uint64_t within = 0;
    for (Index i = 0; i < row.count; ++i) {
      within |= std::uint64_t{!(gap(slot, row.point(i)).distance > margin)} << i;
    }
    return within;
  }
  /// Which of up to 64 points moved_gap() finds at a distance <= `margin` [m], or at one that is no number:
  /// bit i of the point number i.
  [[nodiscard]] virtual std::uint64_t points_within_moved(Index slot, const GroundMotion& motion,
                                                          const PointRow& row, double margin) const {
    std::uint64_t within = 0;
    for (Index i = 0; i < row.count; ++i) {
      within |= std::uint64_t{!(moved_gap(slot, motion, row.point(i)).distance > margin)} << i;
    }
    return within;
  }
};

}  // namespace carom
