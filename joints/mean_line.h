#pragma once

/// \file
/// A line of action over a step (docs/method.md, section 6): a force F along `direction`, minus a tension T,
/// does the work -T (l1 - l0) exactly, and its torques at both ends cancel exactly.

#include <carom/core/export.h>
#include <carom/joints/line_of_action.h>

#include <cmath>

namespace carom::generic {

/// With d from `from` to `to` at the start (0) and the end (1) of a step:  (d0 + d1)/(l0 + l1),  which is
/// shorter than a unit vector where the line turns. Zero where both ends of the step or opposite lines meet.
template <int D>
struct MeanLine {
  MeanLine(const Vec<D>& d0, const Vec<D>& d1)
      : start(d0.norm()), end(d1.norm()), length(0.5 * (start + end)), distance(0.5 * (d0 + d1)) {
    if (length == 0.0) return;
    direction = distance / length;
    // l1 - l0 without its cancellation.
    growth = (d1 - d0).dot(distance) / length;
  }
  MeanLine(const ElementStep<D>& step, const End<D>& from, const End<D>& to)
      : MeanLine(step.start.position(to) - step.start.position(from),
                 step.end.position(to) - step.end.position(from)) {}

  /// Mean of a tension T(l) over the way from l0 to l1, given T and its potential V: (V(l1) - V(l0))/(l1 -
  /// l0). Over a short way, where that quotient is rounding, by Simpson's rule.
  template <class Force, class Potential>
  [[nodiscard]] double mean_tension(Force&& force, Potential&& potential) const {
    // The quotient's rounding is epsilon / short_way of the force, the rule's error its fourth power / 2880.
    constexpr double short_way = 1e-4;
    if (std::abs(growth) > short_way * length) return (potential(end) - potential(start)) / growth;
    return (force(start) + 4.0 * force(length) + force(end)) / 6.0;
  }

  double start = 0.0, end = 0.0;      ///< l0, l1 [m]
  double length = 0.0;                ///< (l0 + l1)/2 [m]
  double growth = 0.0;                ///< l1 - l0 [m]
  Vec<D> distance;                    ///< (d0 + d1)/2 [m]
  Vec<D> direction = filled<D>(0.0);  ///< (d0 + d1)/(l0 + l1)
};

}  // namespace carom::generic

namespace carom::planar {

/// The relative angle of two bodies over a step in which they turn by 2 atan(h w/2).
struct CAROM_API MeanAngle {
  MeanAngle(const ElementStep<2>& step, BodyId from, BodyId to);

  double start = 0.0, end = 0.0;  ///< at the ends of the step [rad]
  double rate = 0.0;              ///< mean relative spin [rad/s]
  double ratio = 1.0;             ///< (end - start)/(h rate): how much slower the angle grows
};

}  // namespace carom::planar
