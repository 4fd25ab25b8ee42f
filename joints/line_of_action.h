#pragma once

/// \file
/// Two ends as an element between them sees them: along a line, or as an angle.

#include <carom/core/element_derivatives.h>
#include <carom/core/end.h>
#include <carom/core/export.h>
#include <carom/core/force_element.h>
#include <carom/core/system.h>

#include <cmath>
#include <limits>
#include <vector>

namespace carom {

/// The described start of a body: its coordinates and velocities. For laws that are tried as they enter.
struct CAROM_API DescribedStart {
  /// Of one body.
  DescribedStart(const System& system, BodyId body);

  std::vector<double> q, v;  ///< [m, rad], [m/s, rad/s]
};

namespace generic {

/// Demands two different ends that can be.
template <int D>
void check_line_ends(const PartCheck& check, const End<D>& from, const End<D>& to) {
  check_end(check, from, "from");
  check_end(check, to, "to");
  check.different_ends(from.body, to.body);
}

/// Books a spring and a dashpot between two ends, given the forces on `from`; those on `to` are opposite.
template <int D>
void book_pull(ElementLoads<D>& out, const End<D>& from, const End<D>& to, const Vec<D>& elastic,
               const Vec<D>& viscous) {
  out.conservative(from, elastic);
  out.conservative(to, -elastic);
  out.dissipative(from, viscous);
  out.dissipative(to, -viscous);
}

/// Whether two ends stand at one place, but for the rounding of what their positions are added up from, and
/// do not move against each other faster than `fastest` [m/s]. The line between them has no direction then.
template <int D>
[[nodiscard]] bool at_one_place(const EvaluationContext& at, const Attachment<D>& from,
                                const Attachment<D>& to, double fastest) {
  constexpr double rounding = 8.0 * std::numeric_limits<double>::epsilon();
  const Vec<D> from_lever = from.lever(at.evaluation), to_lever = to.lever(at.evaluation);
  const Vec<D> a = from.position(at.state, from_lever), b = to.position(at.state, to_lever);
  const double size = a.norm() + b.norm() + from_lever.norm() + to_lever.norm();
  if (!((b - a).norm() <= rounding * size)) return false;
  return !((to.velocity(at.state, to_lever) - from.velocity(at.state, from_lever)).norm() > fastest);
}

/// Whether a law that is asked for lengths > 0 only does not vanish with the length, judged at two lengths
/// that are small against all that is built.
template <class Law>
[[nodiscard]] bool stays_without_length(const Law& law) {
  constexpr double tiny = 1e-12, small = 1e-6;  // [m]
  // Laws that fall at least as the square root of the length come below 1e-3.
  constexpr double vanishing = 1e-2;
  return !(std::abs(law(tiny)) <= vanishing * std::abs(law(small)));
}

/// The line between two ends: with d from `from` to `to`, the length |d|, d/|d| and the rate of the length.
/// Where the ends coincide there is no direction: it is zero, and so is the rate.
template <int D>
struct LineOfAction {
  LineOfAction(const Vec<D>& distance, const Vec<D>& relative_velocity)
      : length(distance.norm()), velocity(relative_velocity) {
    if (length == 0.0) return;
    direction = distance / length;
    rate = direction.dot(relative_velocity);
  }
  LineOfAction(const ElementView<D>& at, const End<D>& from, const End<D>& to)
      : LineOfAction(at.position(to) - at.position(from), at.velocity(to) - at.velocity(from)) {}

  /// The line as the bodies are described, before anything moves.
  static LineOfAction described(const System& system, const End<D>& from, const End<D>& to) {
    Vec<D> distance = filled<D>(0.0), velocity = filled<D>(0.0);
    const auto add = [&](const End<D>& end, double sign) {
      if (end.body == ground) {
        distance += sign * end.point;
        return;
      }
      const DescribedStart start(system, end.body);
      distance += sign * Eigen::Map<const Vec<D>>(start.q.data());
      velocity += sign * Eigen::Map<const Vec<D>>(start.v.data());
      if constexpr (Space<D>::has_orientation) {
        if (end.point.isZero(0.0)) return;
        double rotation[Space<D>::rotation_size];
        Space<D>::rotation(start.q.data() + D, rotation);
        const Vec<D> lever = Space<D>::rotate(rotation, end.point);
        distance += sign * lever;
        velocity += sign * Space<D>::lever_velocity(start.v.data() + D, lever);
      }
    };
    add(to, 1.0);
    add(from, -1.0);
    return {distance, velocity};
  }

  /// Books the derivatives of an element that pulls its ends together with the tension T(l, dl/dt) [N]: the
  /// force on `to` is -T d/l. Nothing where there is no direction. Ends: End<D> or Attachment<D>. \param
  /// by_length dT/dl [N/m] \param by_rate dT/d(dl/dt) [N s/m]
  template <class E>
  void add_pull(ElementDerivatives<D>& out, const E& from, const E& to, double tension, double by_length,
                double by_rate) const {
    if (length == 0.0) return;
    const Mat<D> along = direction * direction.transpose();
    const Mat<D> turning = (Mat<D>::Identity() - along) / length;  // d(direction)/d(distance)
    const Mat<D> by_distance =
        -by_length * along - by_rate * direction * (turning * velocity).transpose() - tension * turning;
    out.opposite_forces(from, to, -tension * direction, by_distance, -by_rate * along);
  }

  double length = 0.0;                ///< [m]
  double rate = 0.0;                  ///< [m/s]
  Vec<D> direction = filled<D>(0.0);  ///< from `from` to `to`
  Vec<D> velocity = filled<D>(0.0);   ///< of `to` relative to `from` [m/s]
};

}  // namespace generic

namespace planar {

/// The angle of one rigid body (or the ground) relative to another, and its rate. Angles of bodies count
/// their turns, so it does too.
struct CAROM_API RelativeAngle {
  RelativeAngle(const ElementView<2>& at, BodyId from, BodyId to);
  /// The angle as the bodies are described, before anything moves.
  RelativeAngle(const System& system, BodyId from, BodyId to);

  double angle = 0.0;  ///< of `to` less that of `from` [rad]
  double rate = 0.0;   ///< [rad/s]
};

/// Demands two different ends, each a rigid body or the ground.
CAROM_API void check_angular_ends(const PartCheck& check, BodyId from, BodyId to);

}  // namespace planar

}  // namespace carom
