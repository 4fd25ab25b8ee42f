#pragma once

/// \file
/// Bounds of the gap of two bodies by the places and velocities of their centres of mass alone.

#include <carom/contact/detection/contact_pair.h>
#include <carom/contact/detection/detector.h>
#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/core/layout.h>
#include <carom/core/state.h>

namespace carom {

/// Bounds of the gap of a pair of a vertex and an outline of two bodies.
struct CAROM_API BodyPairBound {
  BodySlot a, b;          ///< body of the vertex, and of the outline
  double lever = 0.0;     ///< of the vertex from the centre of mass of `a` [m]
  double reach = 0.0;     ///< of the outline from that of `b`, with its rounding [m]
  double radius = 0.0;    ///< of the rounding of the vertex [m]
  double rounding = 0.0;  ///< of both [m]; 0: the corners are sharp
  bool round = false;     ///< the outline has one vertex: the gap is a distance of two points less a constant
  bool central = false;   ///< likewise, and these are the centres of mass

  /// Not more than the gap, and equal to it of discs around their centres of mass [m].
  [[nodiscard]] double least_gap(const StateView& state) const;
  /// Not less than the speed at which the gap may change, wherever the bodies are, at these velocities [m/s].
  [[nodiscard]] double most_speed(const double* velocities) const;
};

/// The bounds of a pair of two bodies.
[[nodiscard]] CAROM_API BodyPairBound bound_of(const Assembly& assembly, const Detector& detector,
                                               const ContactPair& pair);

}  // namespace carom
