#include <carom/bodies/particle_kind.h>
#include <carom/core/numerics/pair.h>

#include <algorithm>

namespace carom::generic {

template <int D>
void ParticleKind<D>::add(const Particle<D>& part, const PartCheck& check) {
  check.positive(part.mass, "mass", "kg");
  check.finite({part.position.data(), D}, "position", "m");
  check.finite({part.velocity.data(), D}, "velocity", "m/s");
  check.material(part.material);
  if (part.contact) check.filter(part.filter);
  masses_.push_back(part.mass);
  position_.push_back(part.position);
  velocity_.push_back(part.velocity);
  contact_.push_back(part.contact ? 1 : 0);
  material_.push_back(part.material);
  filter_.push_back(part.filter);
}

template <int D>
std::unique_ptr<BodyKind> ParticleKind<D>::clone() const {
  return std::make_unique<ParticleKind>(*this);
}

template <int D>
std::unique_ptr<BodyKind> ParticleKind<D>::arranged(std::span<const Index> order) const {
  auto packed = std::make_unique<ParticleKind>();
  for (const Index slot : order) packed->masses_.push_back(masses_[slot]);
  packed->masses_.shrink();
  return packed;
}

template <int D>
void ParticleKind<D>::remove(Index slot) {
  masses_.erase(slot);
  position_.erase(slot);
  velocity_.erase(slot);
  contact_.erase(slot);
  material_.erase(slot);
  filter_.erase(slot);
}

template <int D>
void ParticleKind<D>::initial(Index slot, double* q, double* v) const {
  Eigen::Map<Vec<D>>{q} = position_[slot];
  Eigen::Map<Vec<D>>{v} = velocity_[slot];
}

template <int D>
void ParticleKind<D>::advance(Range slots, const double* q0, const double* delta, double* q1) const {
  const Index numbers = slots.size() * D;
  for (Index i = 0; i < numbers; ++i) q1[i] = q0[i] + delta[i];
}

template <int D>
void ParticleKind<D>::coordinate_rates(Range slots, const double* /*q*/, const double* v,
                                       double* rates) const {
  std::copy_n(v, slots.size() * D, rates);
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
  const double* const mass = masses_.data() + masses_.stride() * slots.begin;
  const Index stride = masses_.stride();
  PairSum sum;
  Index i = 0;
  for (; i + 1 < slots.size(); i += 2, v += 2 * D) {
    Pair square = both(0.0);
    for (int d = 0; d < D; ++d) square += Pair{v[d] * v[d], v[D + d] * v[D + d]};
    sum.add(0.5 * load_pair(mass + i * stride) * square);
  }
  if (i < slots.size()) {
    double square = 0.0;
    for (int d = 0; d < D; ++d) square += v[d] * v[d];
    sum.add(Pair{0.5 * mass[i * stride] * square, 0.0});
  }
  return sum.value();
}

template <int D>
void ParticleKind<D>::add_weight(Range slots, const double* g, double* load) const {
  for (Index slot = slots.begin; slot < slots.end; ++slot, load += D) {
    for (int d = 0; d < D; ++d) load[d] += masses_[slot] * g[d];
  }
}

template <int D>
double ParticleKind<D>::weight_potential(Range slots, const double* g, const double* q) const {
  const double* const mass = masses_.data() + masses_.stride() * slots.begin;
  const Index stride = masses_.stride();
  const auto height = [g](const double* x) {
    double sum = 0.0;
    for (int d = 0; d < D; ++d) sum += g[d] * x[d];
    return sum;
  };
  PairSum sum;
  Index i = 0;
  for (; i + 1 < slots.size(); i += 2, q += 2 * D) {
    sum.add(-load_pair(mass + i * stride) * Pair{height(q), height(q + D)});
  }
  if (i < slots.size()) sum.add(Pair{-mass[i * stride] * height(q), 0.0});
  return sum.value();
}

template <int D>
void ParticleKind<D>::fingerprint(Fingerprint& print) const {
  for (Index slot = 0; slot < size(); ++slot) {
    print.add(masses_[slot]);
    print.add(std::uint64_t{contact_[slot]});
    print.add(std::uint64_t{material_[slot].serial});
  }
}

template <int D>
PartType<BodyKind> Particle<D>::part_type() {
  return PartType<BodyKind>::of<ParticleKind<D>, Particle>();
}

template PartType<BodyKind> Particle<2>::part_type();
template PartType<BodyKind> Particle<3>::part_type();
template class ParticleKind<2>;
template class ParticleKind<3>;

}  // namespace carom::generic
