#include <carom/core/assembly.h>
#include <carom/core/compensated_sum.h>
#include <carom/joints/gravity.h>

namespace carom::generic {

template <int D>
void GravityKind<D>::add(const Gravity<D>& part, const PartCheck& check) {
  check.finite({part.acceleration.data(), D}, "acceleration", "m/s^2");
  parts_.push_back(part);
}

template <int D>
std::unique_ptr<ForceKind> GravityKind<D>::clone() const {
  return std::make_unique<GravityKind>(*this);
}

template <int D>
std::unique_ptr<ForceKind> GravityKind<D>::arranged(std::span<const Index> order, const Layout&) const {
  auto copy = std::make_unique<GravityKind>();
  for (const Index slot : order) copy->parts_.push_back(parts_[slot]);
  return copy;
}

template <int D>
void GravityKind<D>::evaluate(const EvaluationContext& at, Range elements, const Loads& loads) const {
  for (Index element = elements.begin; element < elements.end; ++element) {
    const Vec<D>& g = parts_[element].acceleration;
    const double* mass = at.assembly.masses().data() + at.assembly.islands()[at.island].bodies.begin;
    at.assembly.for_bodies(at.island, [&](const BodyKind& kind, Range slots, Index, Index v, Index) {
      double* load = loads.conservative + v;
      const Index stride = kind.v_size();
      for (Index i = 0; i < slots.size(); ++i, ++mass, load += stride) {
        for (int d = 0; d < D; ++d) load[d] += *mass * g[d];
      }
    });
  }
}

template <int D>
double GravityKind<D>::potential(const EvaluationContext& at, Range elements) const {
  CompensatedSum sum;
  for (Index element = elements.begin; element < elements.end; ++element) {
    const Vec<D>& g = parts_[element].acceleration;
    const double* mass = at.assembly.masses().data() + at.assembly.islands()[at.island].bodies.begin;
    at.assembly.for_bodies(at.island, [&](const BodyKind& kind, Range slots, Index q, Index, Index) {
      const double* position = at.state.q + q;
      const Index stride = kind.q_size();
      for (Index i = 0; i < slots.size(); ++i, ++mass, position += stride) {
        double height = 0.0;
        for (int d = 0; d < D; ++d) height += g[d] * position[d];
        sum.add(-*mass * height);
      }
    });
  }
  return sum.value();
}

template <int D>
void GravityKind<D>::fingerprint(Fingerprint& print) const {
  for (const Gravity<D>& part : parts_) print.add({part.acceleration.data(), static_cast<std::size_t>(D)});
}

template class GravityKind<2>;
template class GravityKind<3>;

}  // namespace carom::generic
