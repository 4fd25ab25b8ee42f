#include <carom/joints/bushing.h>
#include <carom/joints/line_of_action.h>
#include <carom/joints/mean_line.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace carom::generic {

namespace {

using planar::check_angular_ends;
using planar::MeanAngle;
using planar::RelativeAngle;

// d and its rate.
struct Placement {
  Placement(const Bushing<2>& part, const ElementView<2>& at) {
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

void book(const Bushing<2>& part, const Placement& at, const Vec<3>& elastic, const Vec<3>& viscous,
          ElementLoads<2>& out) {
  const auto split = [&](const Vec<3>& load, auto&& force_at, auto&& torque_on) {
    const Vec<2> force = at.to_fixed(load.head<2>());
    force_at(part.to, -force);
    torque_on(part.to.body, -load[2]);
    force_at(part.from, force);  // moved to the point of `to` by the torque of the distance
    torque_on(part.from.body, load[2] + at.distance[0] * force[1] - at.distance[1] * force[0]);
  };
  split(
      elastic, [&](const End<2>& end, const Vec<2>& force) { out.conservative(end, force); },
      [&](BodyId body, double torque) { out.conservative_torque(body, torque); });
  split(
      viscous, [&](const End<2>& end, const Vec<2>& force) { out.dissipative(end, force); },
      [&](BodyId body, double torque) { out.dissipative_torque(body, torque); });
}

// How d and its rate change with s = (x, y, angle of `from`; x, y, angle of `to`). With u from the centre
// of `from` to the point of `to`, r the lever of that point and J the turn by a right angle,
//     dd = R^T (dx_to - dx_from + J r dangle_to - J u dangle_from),   d(R^T) = -R^T J dangle_from.
struct Tangent : Placement {
  Tangent(const Bushing<2>& part, const ElementView<2>& at) : Placement(part, at) {
    u = distance + at.attach(part.from).lever(at.context().evaluation);
    r = at.attach(part.to).lever(at.context().evaluation);
    const auto motion = [&](BodyId body, int i) {
      if (body == ground) return;
      const Index v = bodies[i] = at.oriented(body).v;
      velocity.segment<3>(3 * i) = Eigen::Map<const Vec<3>>(at.context().state.v + v);
    };
    motion(part.from.body, 0);
    motion(part.to.body, 1);
  }
  // dd/ds.
  [[nodiscard]] Mat<3, 6> of_deflection() const {
    Mat<3, 6> b = Mat<3, 6>::Zero();
    for (int i = 0; i < 2; ++i) {
      b.block<2, 1>(0, i) = -to_frame(Vec<2>::Unit(i));
      b.block<2, 1>(0, 3 + i) = to_frame(Vec<2>::Unit(i));
    }
    b.block<2, 1>(0, 2) = -to_frame(turned(u));
    b.block<2, 1>(0, 5) = to_frame(turned(r));
    b(2, 2) = -1.0;
    b(2, 5) = 1.0;
    return b;
  }
  // d(dd/dt)/ds, dd/dt = (dd/ds) ds/dt.
  [[nodiscard]] Mat<3, 6> of_rate() const {
    const double spin_from = velocity[2], spin_to = velocity[5];
    Mat<3, 6> b = Mat<3, 6>::Zero();
    for (int i = 0; i < 2; ++i) {
      b.block<2, 1>(0, i) = spin_from * to_frame(turned(Vec<2>::Unit(i)));
      b.block<2, 1>(0, 3 + i) = -b.block<2, 1>(0, i);
    }
    const Vec<2> apart = velocity.segment<2>(3) - velocity.head<2>();
    b.block<2, 1>(0, 2) = to_frame(spin_to * r - spin_from * u - turned(apart));
    b.block<2, 1>(0, 5) = (spin_from - spin_to) * to_frame(r);
    return b;
  }
  // d(B^T w)/ds at constant w.
  [[nodiscard]] Mat<6> bending(const Vec<3>& w) const {
    const Vec<2> force = to_fixed(w.head<2>());
    Mat<6> h = Mat<6>::Zero();
    h.block<2, 1>(0, 2) = -turned(force);
    h.block<2, 1>(3, 2) = turned(force);
    h(5, 2) = force.dot(r);
    h.block<1, 6>(2, 0) = h.block<6, 1>(0, 2).transpose().eval();
    h(2, 2) = -force.dot(u);
    h(5, 5) = -force.dot(r);
    return h;
  }
  static Vec<2> turned(const Vec<2>& a) { return {-a[1], a[0]}; }

  Vec<2> u, r;
  Vec<6> velocity = Vec<6>::Zero();  // ds/dt
  Index bodies[2] = {none, none};    // first velocity coordinate
};

// The two halves differ by rounding at most (check); loads and potential must use the same matrix.
Mat<3> symmetric(const Mat<3>& matrix) { return 0.5 * (matrix + matrix.transpose()); }

void check_matrix(const PartCheck& check, const Mat<3>& matrix, const std::string& name) {
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

}  // namespace

template <>
void Bushing<2>::check(const PartCheck& check) const {
  check_end(check, from, "from");
  check_end(check, to, "to");
  check_angular_ends(check, from.body, to.body);
  check_matrix(check, stiffness, "stiffness");
  check_matrix(check, damping, "damping");
  for (int i = 0; i < 3; ++i) {
    check.finite(rest[i], "rest[" + std::to_string(i) + "]", i < 2 ? "m" : "rad");
  }
}

template <>
void Bushing<2>::loads(const ElementView<2>& at, ElementLoads<2>& out) const {
  const Placement now(*this, at);
  book(*this, now, symmetric(stiffness) * now.deflection, symmetric(damping) * now.rate, out);
}

template <>
void Bushing<2>::mean_loads(const ElementStep<2>& step, ElementLoads<2>& out) const {
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
  book(*this, mean, elastic, viscous, out);
}

template <>
void Bushing<2>::derivatives(const ElementView<2>& at, ElementDerivatives<2>& out) const {
  const Tangent now(*this, at);
  const Mat<3> k = symmetric(stiffness), c = symmetric(damping);
  const Mat<3, 6> b = now.of_deflection(), b_rate = now.of_rate();
  const Mat<6> by_position =
      -b.transpose() * (k * b + c * b_rate) - now.bending(k * now.deflection + c * now.rate);
  const Mat<6> by_velocity = -b.transpose() * c * b;
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 6; ++column) {
      if (now.bodies[row / 3] == none || now.bodies[column / 3] == none) continue;
      out.entry(now.bodies[row / 3] + static_cast<Index>(row % 3),
                now.bodies[column / 3] + static_cast<Index>(column % 3), by_position(row, column),
                by_velocity(row, column));
    }
  }
}

template <>
double Bushing<2>::potential(const ElementView<2>& at) const {
  const Vec<3> d = Placement(*this, at).deflection;
  return 0.5 * d.dot(symmetric(stiffness) * d);
}

template <>
void Bushing<2>::fingerprint(Fingerprint& print) const {
  add_to(print, from);
  add_to(print, to);
  print.add({stiffness.data(), 9});
  print.add({damping.data(), 9});
  print.add({rest.data(), 3});
}

template <>
PartType<ForceKind> Bushing<2>::part_type() {
  return PartType<ForceKind>::of<ForceElementKind<Bushing<2>>, Bushing<2>>();
}

}  // namespace carom::generic
