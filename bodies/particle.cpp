#include <carom/bodies/particle.h>

#include <carom/core/numerics/pair.h>

#include <algorithm>

namespace carom::generic {

template <int D>
void ParticleKind<D>::add(const Particle<D>& part, const PartCheck& check) {
  check.positive(part.mass, "mass", "kg");
  check.finite({part.position.data(), D}, "position", "m");
  check.finite({part.velocity.data(), D}, "velocity", "m/s");
  check.material(part.material);
  masses_.push_back(part.mass);
  position_.push_back(part.position);
  velocity_.push_back(part.velocity);
  contact_.push_back(part.contact ? 1 : 0);
  material_.push_back(part.material);
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

namespace {

/// Change by a sweep, two numbers at a time.
class PairChange {
public:
  void take(Pair difference, Pair number) {
    difference = magnitude(difference);
    change_ = larger(difference, change_);
    size_ = larger(magnitude(number), size_);
    // A maximum may drop what is no number, a sum keeps it.
    sum_ += difference;
  }
  void add_to(SweepChange& change) const {
    const double numbers = sum_[0] + sum_[1];
    for (int lane = 0; lane < 2; ++lane) {
      change.take(numbers != numbers ? numbers : change_[lane], numbers != numbers ? numbers : size_[lane]);
    }
  }

private:
  Pair change_{}, size_{}, sum_{};
};

/// One sweep over two numbers. \param half h / 2, \param inverse h / (2 m)
template <bool Response>
inline void sweep_pair(const SweepArrays& a, Index at, Pair half, Pair inverse) {
  const Pair v0 = load_pair(a.v0 + at);
  Pair change_of_v =
      inverse * (load_pair(a.load0 + at) + load_pair(a.load1 + at)) + load_pair(a.carried + at);
  if constexpr (Response) change_of_v += load_pair(a.response + at);
  const Pair v = v0 + change_of_v;
  store_pair(a.cut + at, change_of_v - (v - v0));
  store_pair(a.q1 + at, load_pair(a.q0 + at) + half * (v0 + v));
  store_pair(a.v1 + at, v);
}

inline void sweep_number(const SweepArrays& a, Index at, double half, double inverse) {
  const double change_of_v =
      inverse * (a.load0[at] + a.load1[at]) + a.carried[at] + (a.response ? a.response[at] : 0.0);
  const double v = a.v0[at] + change_of_v;
  a.cut[at] = static_cast<float>(change_of_v - (v - a.v0[at]));
  a.q1[at] = a.q0[at] + half * (a.v0[at] + v);
  a.v1[at] = v;
}

/// Calls f(place, factor) for pairs of numbers of particles that can be taken two by two (all of one mass, or
/// planar), `factor` being `over_mass` divided by the mass. Returns how many numbers were done.
template <int D, class F>
inline Index for_pairs(Range slots, const Column<double>& masses, double over_mass, F&& f) {
  const Index numbers = slots.size() * D;
  Index at = 0;
  if (masses.uniform()) {
    const Pair factor = both(over_mass / masses[0]);
    for (; at + 1 < numbers; at += 2) f(at, factor);
  } else if constexpr (D == 2) {
    const double* const mass = masses.data() + slots.begin;
    for (; at < numbers; at += 2) f(at, both(over_mass / mass[at / 2]));
  }
  return at;
}

}  // namespace

template <int D>
void ParticleKind<D>::sweep(Range slots, double step, const SweepArrays& arrays) const {
  const SweepArrays a = arrays;  // a copy that no store can change: its pointers stay in registers
  const double half = 0.5 * step;
  const Index numbers = slots.size() * D;
  Index at = 0;
  if (a.response != nullptr) {
    at = for_pairs<D>(slots, masses_, half,
                      [&](Index place, Pair inverse) { sweep_pair<true>(a, place, both(half), inverse); });
  } else {
    at = for_pairs<D>(slots, masses_, half,
                      [&](Index place, Pair inverse) { sweep_pair<false>(a, place, both(half), inverse); });
  }
  for (; at < numbers; ++at) sweep_number(a, at, half, half / masses_[slots.begin + at / D]);
}

template <int D>
void ParticleKind<D>::next_change(Range slots, double weight, double step, const LoadArrays& a,
                                  SweepChange& change) const {
  const Index numbers = slots.size() * D;
  PairChange seen;
  const Pair h = both(step);
  Index at = for_pairs<D>(slots, masses_, weight * step, [&](Index place, Pair factor) {
    seen.take(factor * (load_pair(a.led_to + place) - load_pair(a.made_with + place)),
              larger(magnitude(load_pair(a.q1 + place)), magnitude(h * load_pair(a.v1 + place))));
  });
  seen.add_to(change);
  for (; at < numbers; ++at) {
    const double factor = weight * step / masses_[slots.begin + at / D];
    change.take(factor * (a.led_to[at] - a.made_with[at]), a.q1[at]);
    change.take(0.0, step * a.v1[at]);
  }
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

template class ParticleKind<2>;
template class ParticleKind<3>;

}  // namespace carom::generic
