#pragma once

/// \file
/// Rows of a contact between two convex outlines, of two bodies, or of a body and a shape on ground.
///
/// The problem: with the unit normal n from b to a, and t = n turned clockwise, the velocities along the rows
/// are n.u and t.u, where u is the velocity of a against b at one point of space c, midway between the two
/// surfaces (else friction would do work on a gap). n.u is the rate of the gap. At constant velocities of the
/// bodies they change because c moves, and because n turns: with the body that owns the edge, or, between two
/// vertices, with the line between them. That is Constraint::drift.

#include <carom/contact/detection/gap_point.h>
#include <carom/core/constraint.h>
#include <carom/core/export.h>
#include <carom/core/ground_shape_kind.h>
#include <carom/core/layout.h>
#include <carom/core/space.h>
#include <carom/core/state.h>

#include <array>

namespace carom {

/// One side of a contact: which velocities move it.
struct RowSide {
  Index body = none;               ///< in the order of assembly; `none` of a shape on ground
  Index v = 0;                     ///< first of its velocities
  int columns = 0;                 ///< its velocities: 3, 2 of a particle, none of a shape on ground
  Vec<2> centre = Vec<2>::Zero();  ///< centre of mass, or the point about which a shape on ground turns [m]
};

/// One side of a contact: which velocities move it, and how it moves.
struct CAROM_API PairSide : RowSide {
  double radius = 0.0;                   ///< of its outline [m]
  Vec<2> velocity = Vec<2>::Zero();      ///< of the centre [m/s]
  double spin = 0.0;                     ///< [rad/s]
  Vec<2> acceleration = Vec<2>::Zero();  ///< as prescribed, of a shape on ground; else zero [m/s^2]
  double angular_acceleration = 0.0;     ///< as prescribed, of a shape on ground; else zero [rad/s^2]
  double surface_speed = 0.0;            ///< of a conveyor, along the tangent [m/s]

  /// A body. \param place in the order of assembly \param radius of its outline
  [[nodiscard]] static PairSide of_body(const BodySlot& slot, Index place, double radius,
                                        const StateView& state);
  /// A shape on ground that is at rest.
  [[nodiscard]] static PairSide at_rest(double radius);
  /// A shape on ground that moves as prescribed.
  [[nodiscard]] static PairSide of_motion(const GroundMotion& motion, double radius);

  /// Velocity of its material at a point of space [m/s].
  [[nodiscard]] Vec<2> velocity_at(const Vec<2>& point) const {
    return velocity + Space<2>::lever_velocity(&spin, Vec<2>(point - centre));
  }
  /// Rate of that velocity at a point that moves [m/s^2]. \param point_rate its velocity [m/s]
  [[nodiscard]] Vec<2> velocity_rate_at(const Vec<2>& point, const Vec<2>& point_rate) const {
    return acceleration + Space<2>::lever_velocity(&angular_acceleration, Vec<2>(point - centre)) +
           Space<2>::lever_velocity(&spin, Vec<2>(point_rate - velocity));
  }
  /// Acceleration of its material at a point of space [m/s^2].
  [[nodiscard]] Vec<2> acceleration_at(const Vec<2>& point) const {
    return velocity_rate_at(point, velocity_at(point));
  }
};

/// Writes bodies (that of `a` first), rows, gap, Jacobian, surface velocity (of a shape on ground, also in
/// the place of that at the end of the step) and drift; `out` is as made by default. What it does not write:
/// key, law, friction. \param a a body \param b another one, or a shape on ground
CAROM_API void fill_pair_rows(const PairSide& a, const PairSide& b, const GapPoint& at, Constraint& out);

/// Writes bodies, rows, gap and Jacobian only, for whoever asks for no drift; no side is a shape on ground
/// that moves.
CAROM_API void fill_rows(const RowSide& a, const RowSide& b, const GapPoint& at, Constraint& out);

/// Writes the surface velocity at the end of a time step, of the place that is touched then: the one touched
/// now, which goes with the shape on ground, and by how far the contact slides along that. Of a face of the
/// shape, whose normal turns with it, also what that makes of the sliding. \param a the body, `b` the shape
/// now \param after its motion at the end \param step length of the step [s]
CAROM_API void add_motion_after(const PairSide& a, const PairSide& b, const GapPoint& at,
                                const GroundMotion& now, const GroundMotion& after, double step,
                                Constraint& out);

/// Point at which both sides touch: midway between their surfaces [m].
[[nodiscard]] inline Vec<2> meeting_point(const GapPoint& at) { return 0.5 * (at.point_a + at.point_b); }

/// The first two of three numbers.
[[nodiscard]] inline Vec<2> planar_part(const std::array<double, 3>& numbers) {
  return {numbers[0], numbers[1]};
}

}  // namespace carom
