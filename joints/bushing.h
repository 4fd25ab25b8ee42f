#pragma once

/// \file
/// Compliant joint of two rigid bodies.

#include <carom/core/force_element.h>
#include <carom/joints/line_of_action.h>
#include <carom/joints/mean_line.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace carom::planar {

/// Compliant joint between points of two rigid bodies, or one and the ground, elastic in all directions at
/// once. In the frame of the body `from`,
///
///     d = (R^T (x_to - x_from), angle_to - angle_from) - rest,     V = d^T K d / 2,
///
/// with R the rotation of `from`. The force -R (K d)_xy acts on `to` at its point, the torque -(K d)_angle
/// beside it. `from` gets the opposites, the force at the same place of space, the point of `to`: this is the
/// gradient of V (R turns with `from`), and moments balance. The dashpot is C times the rate of d likewise.
struct Bushing {
  static constexpr Role role = Role::force;
  static constexpr int dimension = 2;
  static constexpr std::string_view label = "bushing";
  static constexpr StoredEnergy stored = StoredEnergy::elastic;

  End<2> from{};                      ///< a rigid body or ground, whose frame is that of K and C (required)
  End<2> to{};                        ///< a rigid body or ground (required)
  Mat<3> stiffness = Mat<3>::Zero();  ///< K over (x, y, angle), symmetric, no eigenvalue < 0
                                      ///< [N/m, N/rad; N m/m, N m/rad]
  Mat<3> damping = Mat<3>::Zero();    ///< C, likewise, times s
  Vec<3> rest = Vec<3>::Zero();       ///< d is zero here [m, m, rad]

  /// The bodies it joins.
  [[nodiscard]] std::vector<BodyId> bodies() const { return {from.body, to.body}; }
  /// Throws ModelError for ends or matrices that cannot be.
  void check(const PartCheck& check) const {
    check_end(check, from, "from");
    check_end(check, to, "to");
    check_angular_ends(check, from.body, to.body);
    check_matrix(check, stiffness, "stiffness");
    check_matrix(check, damping, "damping");
    for (int i = 0; i < 3; ++i) {
      check.finite(rest[i], "rest[" + std::to_string(i) + "]", i < 2 ? "m" : "rad");
    }
  }
  /// Books spring and dashpot.
  void loads(const ElementView<2>& at, ElementLoads<2>& out) const {
    const Placement now(*this, at);
    book(now, symmetric(stiffness) * now.deflection, symmetric(damping) * now.rate, out);
  }
  /// Books spring and dashpot over a step: with the mean of the frame's axes, and the growth of d for its
  /// rate, the loads do exactly the work by which the potential falls.
  void mean_loads(const ElementStep<2>& step, ElementLoads<2>& out) const {
    const Placement before(*this, step.start);
    const Placement after(*this, step.end);
    Placement mean = before;
    mean.cosine = 0.5 * (before.cosine + after.cosine);
    mean.sine = 0.5 * (before.sine + after.sine);
    mean.distance = 0.5 * (before.distance + after.distance);
    mean.deflection = 0.5 * (before.deflection + after.deflection);
    mean.rate = (after.deflection - before.deflection) / step.step;
    Vec<3> elastic = symmetric(stiffness) * mean.deflection;
    Vec<3> viscous = symmetric(damping) * mean.rate;
    const double ratio = MeanAngle(step, from.body, to.body).ratio;
    elastic[2] *= ratio;
    viscous[2] *= ratio;
    book(mean, elastic, viscous, out);
  }
  /// d^T K d / 2 [J].
  [[nodiscard]] double potential(const ElementView<2>& at) const {
    const Vec<3> d = Placement(*this, at).deflection;
    return 0.5 * d.dot(symmetric(stiffness) * d);
  }
  /// Adds ends and numbers.
  void fingerprint(Fingerprint& print) const {
    add_to(print, from);
    add_to(print, to);
    print.add({stiffness.data(), 9});
    print.add({damping.data(), 9});
    print.add({rest.data(), 3});
  }

private:
  // d and its rate.
  struct Placement {
    Placement(const Bushing& part, const ElementView<2>& at) {
      if (part.from.body != ground) {
        const double* r = at.context().evaluation.rotation.data() + at.oriented(part.from.body).rotation;
        cosine = r[0];
        sine = r[1];
      }
      distance = at.position(part.to) - at.position(part.from);
      const RelativeAngle relative(at, part.from.body, part.to.body);
      const double spin = part.from.body == ground ? 0.0 : at.spin(part.from.body);
      // Seen from the turning frame.
      const Vec<2> velocity =
          at.velocity(part.to) - at.velocity(part.from) - Space<2>::lever_velocity(&spin, distance);
      deflection << to_frame(distance), relative.angle;
      deflection -= part.rest;
      rate << to_frame(velocity), relative.rate;
    }
    [[nodiscard]] Vec<2> to_frame(const Vec<2>& a) const {
      return {cosine * a[0] + sine * a[1], cosine * a[1] - sine * a[0]};
    }
    [[nodiscard]] Vec<2> to_fixed(const Vec<2>& a) const {
      return {cosine * a[0] - sine * a[1], sine * a[0] + cosine * a[1]};
    }

    double cosine = 1.0, sine = 0.0;
    Vec<2> distance;
    Vec<3> deflection, rate;
  };

  void book(const Placement& at, const Vec<3>& elastic, const Vec<3>& viscous, ElementLoads<2>& out) const {
    const auto split = [&](const Vec<3>& load, auto&& force_at, auto&& torque_on) {
      const Vec<2> force = at.to_fixed(load.head<2>());
      force_at(to, -force);
      torque_on(to.body, -load[2]);
      force_at(from, force);  // moved to the point of `to` by the torque of the distance
      torque_on(from.body, load[2] + at.distance[0] * force[1] - at.distance[1] * force[0]);
    };
    split(
        elastic, [&](const End<2>& end, const Vec<2>& force) { out.conservative(end, force); },
        [&](BodyId body, double torque) { out.conservative_torque(body, torque); });
    split(
        viscous, [&](const End<2>& end, const Vec<2>& force) { out.dissipative(end, force); },
        [&](BodyId body, double torque) { out.dissipative_torque(body, torque); });
  }

  // Halves differ by rounding at most (check); loads and potential must see one and the same matrix.
  static Mat<3> symmetric(const Mat<3>& matrix) { return 0.5 * (matrix + matrix.transpose()); }

  static void check_matrix(const PartCheck& check, const Mat<3>& matrix, const std::string& name) {
    constexpr double tolerance = 1e-12;
    const auto entry = [&](int i, int j) {
      return name + "(" + std::to_string(i) + ", " + std::to_string(j) + ")";
    };
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) check.finite(matrix(i, j), entry(i, j), "");
    }
    for (int i = 0; i < 3; ++i) {
      check.non_negative(matrix(i, i), entry(i, i), "");
      for (int j = 0; j < i; ++j) {
        const double size = std::max(std::abs(matrix(i, j)), std::abs(matrix(j, i)));
        if (std::abs(matrix(i, j) - matrix(j, i)) > tolerance * size) {
          check.refuse(entry(i, j), to_text(matrix(i, j)),
                       entry(j, i) + ", " + to_text(matrix(j, i)) + ": a symmetric matrix");
        }
      }
    }
    // Principal minors after scaling the diagonal to one, which makes them free of units.
    Vec<3> scaled = Vec<3>::Zero();  // entries (1, 0), (2, 0), (2, 1)
    for (int i = 1; i < 3; ++i) {
      for (int j = 0; j < i; ++j) {
        const double bound = std::sqrt(matrix(i, i)) * std::sqrt(matrix(j, j));
        if (std::abs(matrix(i, j)) > bound * (1.0 + tolerance)) {
          check.refuse(entry(i, j), to_text(matrix(i, j)),
                       "at most " + to_text(bound) + " in size, else the matrix has a negative eigenvalue");
        }
        if (bound > 0.0) scaled[i + j - 1] = matrix(i, j) / bound;
      }
    }
    const double determinant = 1.0 + 2.0 * scaled.prod() - scaled.squaredNorm();
    if (determinant < -tolerance) {
      check.refuse("scaled determinant of " + name, to_text(determinant),
                   ">= 0, else the matrix has a negative eigenvalue");
    }
  }
};

}  // namespace carom::planar
