#include <carom/bodies/particle.h>
#include <carom/core/compensated_sum.h>

namespace carom::generic {

template <int D>
void ParticleKind<D>::add(const Particle<D>& part, const PartCheck& check) {
  check.positive(part.mass, "mass", "kg");
  check.finite({part.position.data(), D}, "position", "m");
  check.finite({part.velocity.data(), D}, "velocity", "m/s");
  check.material(part.material);
  masses_.push_back(part.mass);
  parts_.push_back(part);
}

template <int D>
std::unique_ptr<BodyKind> ParticleKind<D>::clone() const {
  return std::make_unique<ParticleKind>(*this);
}

template <int D>
std::unique_ptr<BodyKind> ParticleKind<D>::arranged(std::span<const Index> order) const {
  auto copy = std::make_unique<ParticleKind>();
  copy->masses_.reserve(order.size());
  copy->parts_.reserve(order.size());
  for (const Index slot : order) {
    copy->masses_.push_back(masses_[slot]);
    copy->parts_.push_back(parts_[slot]);
  }
  return copy;
}

template <int D>
void ParticleKind<D>::remove(Index slot) {
  masses_.erase(masses_.begin() + slot);
  parts_.erase(parts_.begin() + slot);
}

template <int D>
void ParticleKind<D>::initial(Index slot, double* q, double* v) const {
  Eigen::Map<Vec<D>>{q} = parts_[slot].position;
  Eigen::Map<Vec<D>>{v} = parts_[slot].velocity;
}

template <int D>
void ParticleKind<D>::advance(Range slots, const double* q0, const double* delta, double* q1) const {
  const Index numbers = slots.size() * D;
  for (Index i = 0; i < numbers; ++i) q1[i] = q0[i] + delta[i];
}

template <int D>
void ParticleKind<D>::sweep(Range slots, double step, const SweepArrays& a, SweepChange& change) const {
  const double half = 0.5 * step;
  SweepChange seen = change;
  Index at = 0;
  for (Index slot = slots.begin; slot < slots.end; ++slot) {
    const double inverse = half / masses_[slot];
    for (int i = 0; i < D; ++i, ++at) {
      const double change_of_v =
          inverse * (a.load0[at] + a.load1[at]) + a.carried[at] + (a.response ? a.response[at] : 0.0);
      const double v = a.v0[at] + change_of_v;
      const double q = a.q0[at] + half * (a.v0[at] + v);
      a.cut[at] = change_of_v - (v - a.v0[at]);
      seen.take((v - a.v1[at]) * step, v * step);
      seen.take(q - a.q1[at], q);
      a.v1[at] = v;
      a.q1[at] = q;
    }
  }
  change = seen;
}

template <int D>
void ParticleKind<D>::apply_inverse_mass(Range slots, const double* f, double* a) const {
  for (Index slot = slots.begin; slot < slots.end; ++slot, f += D, a += D) {
    for (int i = 0; i < D; ++i) a[i] = f[i] / masses_[slot];
  }
}

template <int D>
void ParticleKind<D>::apply_mass(Range slots, const double* v, double* p) const {
  for (Index slot = slots.begin; slot < slots.end; ++slot, v += D, p += D) {
    for (int i = 0; i < D; ++i) p[i] = v[i] * masses_[slot];
  }
}

template <int D>
double ParticleKind<D>::kinetic_energy(Range slots, const double* v) const {
  CompensatedSum sum;
  for (Index slot = slots.begin; slot < slots.end; ++slot, v += D) {
    double square = 0.0;
    for (int i = 0; i < D; ++i) square += v[i] * v[i];
    sum.add(0.5 * masses_[slot] * square);
  }
  return sum.value();
}

template <int D>
void ParticleKind<D>::fingerprint(Fingerprint& print) const {
  for (const Particle<D>& part : parts_) {
    print.add(part.mass);
    print.add(std::uint64_t{part.contact});
    print.add(std::uint64_t{part.material.serial});
  }
}

template class ParticleKind<2>;
template class ParticleKind<3>;

}  // namespace carom::generic
