#include <carom/bodies/rigid_body_kind.h>
#include <carom/core/numerics/pair.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom::generic {

PartType<BodyKind> RigidBody<2>::part_type() { return PartType<BodyKind>::of<RigidBodyKind<2>, RigidBody>(); }

void RigidBodyKind<2>::add(const RigidBody<2>& part, const PartCheck& check) {
  check.positive(part.mass.mass, "mass", "kg");
  if (std::isnan(part.mass.inertia)) {
    check.refuse(
        "moment of inertia", "nan kg m^2, it is missing",
        "mass properties made by disc(), rod(), box(), ring(), solid_sphere(), thin_shell(), polygon() "
        "or compose(), e.g. RigidBody{.mass = disc(1.0, 0.5)}");
  }
  check.positive(part.mass.inertia, "moment of inertia", "kg m^2");
  // The body's frame has the centre of mass as origin; what is left by composing parts is rounding.
  const double gyration_radius = std::sqrt(part.mass.inertia / part.mass.mass);
  const Vec<2>& centre = part.mass.centre;
  if (!(centre.norm() <= 1e3 * std::numeric_limits<double>::epsilon() * gyration_radius)) {
    check.refuse("centre of mass", "(" + to_text(centre[0]) + ", " + to_text(centre[1]) + ") m",
                 "the origin of the body's frame: use centred(), and shift the shapes by minus this centre");
  }
  check.finite({part.position.data(), 2}, "position", "m");
  check.finite(part.angle, "angle", "rad");
  check.finite({part.velocity.data(), 2}, "velocity", "m/s");
  check.finite(part.spin, "spin", "rad/s");
  masses_.push_back({part.mass.mass, part.mass.inertia, gyration_radius});
  parts_.push_back(part);
}

std::unique_ptr<BodyKind> RigidBodyKind<2>::clone() const { return std::make_unique<RigidBodyKind>(*this); }

std::unique_ptr<BodyKind> RigidBodyKind<2>::arranged(std::span<const Index> order) const {
  auto packed = std::make_unique<RigidBodyKind>();
  packed->masses_.reserve(order.size());
  for (const Index slot : order) packed->masses_.push_back(masses_[slot]);
  return packed;
}

void RigidBodyKind<2>::remove(Index slot) {
  masses_.erase(masses_.begin() + slot);
  parts_.erase(parts_.begin() + slot);
}

void RigidBodyKind<2>::initial(Index slot, double* q, double* v) const {
  const RigidBody<2>& part = parts_[slot];
  Eigen::Map<Vec<2>>{q} = part.position;
  q[2] = part.angle;
  Eigen::Map<Vec<2>>{v} = part.velocity;
  v[2] = part.spin;
}

void RigidBodyKind<2>::rotations(Range slots, const double* q, double* rotation) const {
  for (Index i = 0; i < slots.size(); ++i) {
    const double angle =
        q[3 * i + 2];  // apart from what is written, sine and cosine cost little more than one
    Space<2>::rotation(&angle, rotation + 2 * i);
  }
}

void RigidBodyKind<2>::advance(Range slots, const double* q0, const double* delta, double* q1) const {
  for (Index i = 0; i < 3 * slots.size(); i += 3) {
    q1[i] = q0[i] + delta[i];
    q1[i + 1] = q0[i + 1] + delta[i + 1];
    Space<2>::advance_orientation(q0 + i + 2, delta + i + 2, q1 + i + 2);
  }
}

void RigidBodyKind<2>::coordinate_rates(Range slots, const double* /*q*/, const double* v,
                                        double* rates) const {
  std::copy_n(v, 3 * slots.size(), rates);
}

void RigidBodyKind<2>::apply_inverse_mass(Range slots, const double* f, double* a) const {
  for (Index slot = slots.begin; slot < slots.end; ++slot, f += 3, a += 3) {
    const Inertia& mass = masses_[slot];
    a[0] = f[0] / mass.mass;
    a[1] = f[1] / mass.mass;
    a[2] = f[2] / mass.inertia;
  }
}

void RigidBodyKind<2>::apply_mass(Range slots, const double* v, double* p) const {
  for (Index slot = slots.begin; slot < slots.end; ++slot, v += 3, p += 3) {
    const Inertia& mass = masses_[slot];
    p[0] = v[0] * mass.mass;
    p[1] = v[1] * mass.mass;
    p[2] = v[2] * mass.inertia;
  }
}

double RigidBodyKind<2>::kinetic_energy(Range slots, const double* v) const {
  const auto of_one = [&](const Inertia& body, const double* at) {
    return Pair{0.5 * body.mass * (at[0] * at[0] + at[1] * at[1]), 0.5 * body.inertia * at[2] * at[2]};
  };
  if (slots.size() == 1) {  // the same without sums, which a step of one body would wait for
    const Pair energy = of_one(masses_[slots.begin], v);
    return energy[0] + energy[1];
  }
  PairSum moving, spinning;  // two bodies side by side
  Index slot = slots.begin;
  for (; slot + 1 < slots.end; slot += 2, v += 6) {
    const Inertia &a = masses_[slot], &b = masses_[slot + 1];
    const Pair x{v[0], v[3]}, y{v[1], v[4]}, spin{v[2], v[5]};
    moving.add(0.5 * Pair{a.mass, b.mass} * (x * x + y * y));
    spinning.add(0.5 * Pair{a.inertia, b.inertia} * spin * spin);
  }
  if (slot < slots.end) {
    const Pair last = of_one(masses_[slot], v);
    moving.add(Pair{last[0], 0.0});
    spinning.add(Pair{last[1], 0.0});
  }
  moving.add(spinning);
  return moving.accurate_value();
}

void RigidBodyKind<2>::add_weight(Range slots, const double* g, double* load) const {
  for (Index slot = slots.begin; slot < slots.end; ++slot, load += 3) {
    load[0] += masses_[slot].mass * g[0];
    load[1] += masses_[slot].mass * g[1];
  }
}

double RigidBodyKind<2>::weight_potential(Range slots, const double* g, const double* q) const {
  const auto potential = [&](Index i) {
    const double* const at = q + 3 * i;
    return -masses_[slots.begin + i].mass * (g[0] * at[0] + g[1] * at[1]);
  };
  if (slots.size() == 1) return potential(0);
  PairSum sum;
  Index i = 0;
  for (; i + 1 < slots.size(); i += 2) sum.add(Pair{potential(i), potential(i + 1)});
  if (i < slots.size()) sum.add(Pair{potential(i), 0.0});
  return sum.accurate_value();
}

void RigidBodyKind<2>::fingerprint(Fingerprint& print) const {
  for (const Inertia& mass : masses_) {
    print.add(mass.mass);
    print.add(mass.inertia);
  }
}

}  // namespace carom::generic
