#include <carom/joints/condition_derivatives.h>

namespace carom::planar {

void differentiate_line(const ConditionGeometry& at, bool swings, std::span<const EndMotion> motions,
                        JointRowDerivative& out) {
  const Vec<2>& a = at.a;
  const Vec<2> across = turned(a);
  const double spin = at.spin, along = a.dot(at.between), sideways = across.dot(at.apart);
  for (std::size_t p = 0; p < motions.size(); ++p) {
    const EndMotion& of = motions[p];
    for (std::size_t r = 0; r < motions.size(); ++r) {
      const EndMotion& by = motions[r];
      double& entry = out.jacobian[p][r];
      if (p == r) entry = a.dot(of.bend);
      if (swings) {
        entry +=
            across.dot(of.path) * by.swing + across.dot(by.path) * of.swing - along * of.swing * by.swing;
      }
    }
    // d1 and d2 change by these, and with a velocity d1 by d_p, d2 by twice the first.
    const Vec<2> first = of.rate * of.bend, second = of.rate * of.rate * turned(of.bend);
    double& by_position = out.drift_by_position[p];
    double& by_velocity = out.drift_by_velocity[p];
    by_position = a.dot(second);
    by_velocity = 2.0 * a.dot(first);
    if (swings) {
      by_position += 2.0 * spin * across.dot(first) - spin * spin * a.dot(of.path) +
                     of.swing * (across.dot(at.drift) - 2.0 * spin * a.dot(at.apart) -
                                 spin * spin * across.dot(at.between));
      by_velocity += 2.0 * spin * across.dot(of.path) + of.swing * 2.0 * (sideways - spin * along);
    }
  }
}

void differentiate_distance(const ConditionGeometry& at, std::span<const EndMotion> motions,
                            JointRowDerivative& out) {
  const Vec<2>& a = at.a;
  const Vec<2> across = turned(a);
  const double length = at.between.norm(), sideways = across.dot(at.apart);
  for (std::size_t p = 0; p < motions.size(); ++p) {
    const EndMotion& of = motions[p];
    for (std::size_t r = 0; r < motions.size(); ++r) {
      double& entry = out.jacobian[p][r];
      if (p == r) entry = a.dot(of.bend);
      entry += across.dot(of.path) * across.dot(motions[r].path) / length;
    }
    // As for a line.
    const Vec<2> first = of.rate * of.bend, second = of.rate * of.rate * turned(of.bend);
    const double tilt = across.dot(of.path) / length;  // da = tilt a'
    double& by_position = out.drift_by_position[p];
    double& by_velocity = out.drift_by_velocity[p];
    by_position = a.dot(second);
    by_velocity = 2.0 * a.dot(first);
    by_position += tilt * across.dot(at.drift) +
                   2.0 * sideways / length * (across.dot(first) - tilt * a.dot(at.apart)) -
                   sideways * sideways / (length * length) * a.dot(of.path);
    by_velocity += 2.0 * sideways * tilt;
  }
}

}  // namespace carom::planar
