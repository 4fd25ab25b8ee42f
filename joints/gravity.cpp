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
  const auto& bodies = at.assembly.layout()->bodies();
  const auto& masses = at.assembly.masses();
  for (Index element = elements.begin; element < elements.end; ++element) {
    const Vec<D>& g = parts_[element].acceleration;
    for (Index body = at.bodies.begin; body < at.bodies.end; ++body) {
      double* const load = loads.conservative + bodies[body].v;
      for (int i = 0; i < D; ++i) load[i] += masses[body] * g[i];
    }
  }
}

template <int D>
double GravityKind<D>::potential(const EvaluationContext& at, Range elements) const {
  const auto& bodies = at.assembly.layout()->bodies();
  const auto& masses = at.assembly.masses();
  CompensatedSum sum;
  for (Index element = elements.begin; element < elements.end; ++element) {
    const Vec<D>& g = parts_[element].acceleration;
    for (Index body = at.bodies.begin; body < at.bodies.end; ++body) {
      sum.add(-masses[body] * g.dot(Eigen::Map<const Vec<D>>(at.state.q + bodies[body].q)));
    }
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
