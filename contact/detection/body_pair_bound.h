#pragma once

/// \file
/// Bounds of gaps by the places and velocities of the centres of mass alone.

#include <carom/contact/detection/box.h>
#include <carom/contact/detection/contact_pair.h>
#include <carom/contact/detection/outlines.h>
#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/core/layout.h>
#include <carom/core/state.h>

#include <cstddef>

namespace carom {

/// Bounds of the gap of a pair of two bodies, from the places and velocities of their centres of mass; or of
/// a body `a` and an outline, or a vertex of one, on ground.
struct CAROM_API BodyPairBound {
  std::size_t pair = 0;   ///< its place in the list of pairs that this bound belongs to
  BodySlot a, b;          ///< body of the vertex, and of the outline
  double lever = 0.0;     ///< of the vertex from the centre of mass of `a` [m]
  double reach = 0.0;     ///< of the outline from that of `b`, with its rounding [m]
  double radius = 0.0;    ///< of the rounding of the vertex [m]
  double rounding = 0.0;  ///< sum of the vertex and the outline [m]; 0: the corners are sharp
  bool round = false;     ///< the outline has one vertex: the gap is a distance of two points less a constant
  bool central = false;   ///< the gap is a distance of two centres of mass less a constant

  Box<2> box;              ///< around what is on ground, in its frame; `reach` is from the origin of that
  double hollow = 0.0;     ///< radius of a circle on ground that the body is inside of; 0: there is none [m]
  bool on_ground = false;  ///< there is no body `b`

  /// False of two points: a point and a corner close when the point closes with the outline of the corner.
  [[nodiscard]] bool closes_alone() const { return !round || rounding > 0.0 || hollow > 0.0; }
  /// Not more than the gap, and equal to it of discs around their centres of mass [m]. \param motion of the
  /// shape on ground, null if there is none or it is at rest
  [[nodiscard]] double least_gap(const StateView& state, const GroundMotion* motion) const;
  /// Not less than the speed at which the gap may change, wherever the bodies are, at these velocities [m/s].
  [[nodiscard]] double most_speed(const double* velocities, const GroundMotion* motion) const;
  /// Not less than the change of that speed at these accelerations [m/s^2].
  [[nodiscard]] double most_acceleration(const double* accelerations, const GroundMotion* motion) const;
};

/// The bounds of a pair with an outline (ContactPair::has_outline()).
[[nodiscard]] CAROM_API BodyPairBound bound_of_pair(const Outlines& outlines, const ContactPair& pair);

}  // namespace carom
