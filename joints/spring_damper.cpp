#include <carom/core/assembly.h>
#include <carom/core/compensated_sum.h>
#include <carom/joints/line_of_action.h>
#include <carom/joints/spring_damper.h>

#include <algorithm>
#include <cmath>

namespace carom::generic {

template <int D>
void SpringDamperKind<D>::add(const SpringDamper<D>& part, const PartCheck& check) {
  check_end(check, part.from, "from");
  check_end(check, part.to, "to");
  check.different_ends(part.from.body, part.to.body);
  check.non_negative(part.stiffness, "stiffness", "N/m");
  check.non_negative(part.damping, "damping", "N s/m");
  check.non_negative(part.free_length, "free_length", "m");
  parts_.push_back(part);
}

template <int D>
std::unique_ptr<ForceKind> SpringDamperKind<D>::clone() const {
  return std::make_unique<SpringDamperKind>(*this);
}

template <int D>
std::unique_ptr<ForceKind> SpringDamperKind<D>::arranged(std::span<const Index> order,
                                                         const Layout& layout) const {
  auto copy = std::make_unique<SpringDamperKind>();
  copy->parts_.reserve(order.size());
  copy->springs_.reserve(order.size());
  for (const Index slot : order) {
    const SpringDamper<D>& part = parts_[slot];
    const Attachment<D> from(part.from, layout);
    const Attachment<D> to(part.to, layout);
    Spring spring{part.stiffness, part.damping, part.free_length, from.q, from.v, to.q, to.v, none};
    const auto at_centre = [](const Attachment<D>& end) { return end.q != none && end.rotation == none; };
    if (!at_centre(from) || !at_centre(to)) {
      spring.ends = static_cast<Index>(copy->side_table_.size());
      copy->side_table_.push_back({from, to});
    }
    copy->parts_.push_back(part);
    copy->springs_.push_back(spring);
  }
  return copy;
}

template <int D>
void SpringDamperKind<D>::ends(Index element, std::vector<BodyId>& out) const {
  out.push_back(parts_[element].from.body);
  out.push_back(parts_[element].to.body);
}

template <int D>
typename SpringDamperKind<D>::Ends SpringDamperKind<D>::ends_of(const Spring& spring) const {
  if (spring.ends != none) return side_table_[spring.ends];
  Ends ends;
  ends.from.q = spring.from_q;
  ends.from.v = spring.from_v;
  ends.to.q = spring.to_q;
  ends.to.v = spring.to_v;
  return ends;
}

namespace {

/// Factors a, b of the force -(a + b) d on `to`, a of the spring, b of the dashpot; and the stretch.
struct Factors {
  double spring = 0.0;
  double dashpot = 0.0;
  double stretch = 0.0;
};

template <int D>
Factors factors(double stiffness, double damping, double free_length, const Vec<D>& d, const Vec<D>& rate) {
  const double square = d.squaredNorm();
  if (square == 0.0) return {0.0, 0.0, -free_length};
  const double length = std::sqrt(square);
  const double inverse = 1.0 / length;
  const double stretch = length - free_length;
  return {stiffness * stretch * inverse, damping * d.dot(rate) * (inverse * inverse), stretch};
}

}  // namespace

template <int D>
template <bool Together, bool WithPotential>
double SpringDamperKind<D>::sweep(const EvaluationContext& at, Range elements, const Loads& loads) const {
  using Map = Eigen::Map<Vec<D>>;
  using ConstMap = Eigen::Map<const Vec<D>>;
  CompensatedSum potential;
  for (Index i = elements.begin; i < elements.end; ++i) {
    const Spring& spring = springs_[i];
    if (spring.ends == none) {
      const Vec<D> d = ConstMap(at.state.q + spring.to_q) - ConstMap(at.state.q + spring.from_q);
      const Vec<D> rate = ConstMap(at.state.v + spring.to_v) - ConstMap(at.state.v + spring.from_v);
      const Factors f = factors<D>(spring.stiffness, spring.damping, spring.free_length, d, rate);
      if constexpr (WithPotential) potential.add(0.5 * spring.stiffness * f.stretch * f.stretch);
      if constexpr (Together) {
        const Vec<D> force = (f.spring + f.dashpot) * d;
        Map(loads.conservative + spring.from_v) += force;
        Map(loads.conservative + spring.to_v) -= force;
      } else {
        const Vec<D> elastic = f.spring * d;
        Map(loads.conservative + spring.from_v) += elastic;
        Map(loads.conservative + spring.to_v) -= elastic;
        const Vec<D> viscous = f.dashpot * d;
        Map(loads.dissipative + spring.from_v) += viscous;
        Map(loads.dissipative + spring.to_v) -= viscous;
      }
      continue;
    }
    const Ends& ends = side_table_[spring.ends];
    const Vec<D> from = ends.from.lever(at.evaluation);
    const Vec<D> to = ends.to.lever(at.evaluation);
    const Vec<D> d = ends.to.position(at.state, to) - ends.from.position(at.state, from);
    const Vec<D> rate = ends.to.velocity(at.state, to) - ends.from.velocity(at.state, from);
    const Factors f = factors<D>(spring.stiffness, spring.damping, spring.free_length, d, rate);
    if constexpr (WithPotential) potential.add(0.5 * spring.stiffness * f.stretch * f.stretch);
    ends.from.add_force(loads.conservative, from, f.spring * d);
    ends.to.add_force(loads.conservative, to, -f.spring * d);
    ends.from.add_force(loads.dissipative, from, f.dashpot * d);
    ends.to.add_force(loads.dissipative, to, -f.dashpot * d);
  }
  return potential.value();
}

template <int D>
void SpringDamperKind<D>::evaluate(const EvaluationContext& at, Range elements, const Loads& loads) const {
  if (loads.conservative == loads.dissipative) {
    sweep<true, false>(at, elements, loads);
  } else {
    sweep<false, false>(at, elements, loads);
  }
}

template <int D>
double SpringDamperKind<D>::evaluate_with_potential(const EvaluationContext& at, Range elements,
                                                    const Loads& loads) const {
  return loads.conservative == loads.dissipative ? sweep<true, true>(at, elements, loads)
                                                 : sweep<false, true>(at, elements, loads);
}

template <int D>
double SpringDamperKind<D>::potential(const EvaluationContext& at, Range elements) const {
  CompensatedSum sum;
  for (Index i = elements.begin; i < elements.end; ++i) {
    const Ends ends = ends_of(springs_[i]);
    const Vec<D> d = ends.to.position(at.state, ends.to.lever(at.evaluation)) -
                     ends.from.position(at.state, ends.from.lever(at.evaluation));
    const double stretch = d.norm() - springs_[i].free_length;
    sum.add(0.5 * springs_[i].stiffness * stretch * stretch);
  }
  return sum.value();
}

template <int D>
void SpringDamperKind<D>::derivatives(const EvaluationContext& at, Index element,
                                      std::vector<LoadDerivative>& out) const {
  const Spring& spring = springs_[element];
  const Ends ends = ends_of(spring);
  const Vec<D> from = ends.from.lever(at.evaluation);
  const Vec<D> to = ends.to.lever(at.evaluation);
  const LineOfAction<D> line(ends.to.position(at.state, to) - ends.from.position(at.state, from),
                             ends.to.velocity(at.state, to) - ends.from.velocity(at.state, from));
  const ElementView<D> view(at);
  ElementDerivatives<D> list(view, out);
  if (line.length == 0.0 && spring.free_length == 0.0) {
    // Linear through zero: the spring has a derivative where it has no direction.
    list.opposite_forces(ends.from, ends.to, Vec<D>::Zero(), -spring.stiffness * Mat<D>::Identity(),
                         Mat<D>::Zero());
  }
  line.add_pull(list, ends.from, ends.to,
                spring.stiffness * (line.length - spring.free_length) + spring.damping * line.rate,
                spring.stiffness, spring.damping);
}

template <int D>
void SpringDamperKind<D>::fingerprint(Fingerprint& print) const {
  for (const SpringDamper<D>& part : parts_) {
    add_to(print, part.from);
    add_to(print, part.to);
    print.add(part.stiffness);
    print.add(part.damping);
    print.add(part.free_length);
  }
}

template class SpringDamperKind<2>;
template class SpringDamperKind<3>;

}  // namespace carom::generic
