#include <carom/core/assembly.h>
#include <carom/core/numerics/compensated_sum.h>
#include <carom/joints/gravity_kind.h>

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
  const Range bodies = at.bodies.empty() ? at.assembly.components()[at.component].bodies : at.bodies;
  for (Index element = elements.begin; element < elements.end; ++element) {
    const double* const g = parts_[element].acceleration.data();
    at.assembly.for_bodies(bodies, [&](const BodyKind& kind, Range slots, Index, Index v, Index) {
      kind.add_weight(slots, g, loads.conservative + v);
    });
  }
}

template <int D>
double GravityKind<D>::potential(const EvaluationContext& at, Range elements) const {
  const Range bodies = at.bodies.empty() ? at.assembly.components()[at.component].bodies : at.bodies;
  CompensatedSum sum;
  if (bodies.size() == 1) {  // which a step of one body asks for each time: without a walk over kinds
    const BodySlot body = at.assembly.layout()->bodies()[bodies.begin];
    const BodyKind& kind = *at.assembly.body_kinds()[body.kind];
    for (Index element = elements.begin; element < elements.end; ++element) {
      const double* const g = parts_[element].acceleration.data();
      sum.add(kind.weight_potential({body.slot, body.slot + 1}, g, at.state.q + body.q));
    }
    return sum.value();
  }
  for (Index element = elements.begin; element < elements.end; ++element) {
    const double* const g = parts_[element].acceleration.data();
    at.assembly.for_bodies(bodies, [&](const BodyKind& kind, Range slots, Index q, Index, Index) {
      sum.add(kind.weight_potential(slots, g, at.state.q + q));
    });
  }
  return sum.value();
}

template <int D>
void GravityKind<D>::fingerprint(Fingerprint& print) const {
  for (const Gravity<D>& part : parts_) print.add({part.acceleration.data(), static_cast<std::size_t>(D)});
}

template <int D>
PartType<ForceKind> Gravity<D>::part_type() {
  return PartType<ForceKind>::of<GravityKind<D>, Gravity>();
}

template PartType<ForceKind> Gravity<2>::part_type();
template PartType<ForceKind> Gravity<3>::part_type();
template class GravityKind<2>;
template class GravityKind<3>;

}  // namespace carom::generic
