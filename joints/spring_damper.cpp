#include <carom/core/assembly.h>
#include <carom/core/numerics/compensated_sum.h>
#include <carom/joints/line_of_action.h>
#include <carom/joints/spring_damper_kind.h>
#include <carom/joints/spring_pull.h>

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
  const Index element = size();
  stiffness_.push_back(part.stiffness);
  damping_.push_back(part.damping);
  free_length_.push_back(part.free_length);
  from_.push_back(part.from.body.serial);
  to_.push_back(part.to.body.serial);
  token_ = part.from.body == ground ? part.to.body.token : part.from.body.token;
  if (!part.from.point.isZero(0.0) || !part.to.point.isZero(0.0)) {
    points_.push_back({element, part.from.point, part.to.point});
  }
}

template <int D>
std::unique_ptr<ForceKind> SpringDamperKind<D>::clone() const {
  return std::make_unique<SpringDamperKind>(*this);
}

template <int D>
void SpringDamperKind<D>::remove(Index slot) {
  stiffness_.erase(slot);
  damping_.erase(slot);
  free_length_.erase(slot);
  from_.erase(from_.begin() + slot);
  to_.erase(to_.begin() + slot);
  std::erase_if(points_, [slot](const Points& points) { return points.element == slot; });
  for (Points& points : points_) {
    if (points.element > slot) --points.element;
  }
}

namespace {

/// First entry of a side table, ordered by element, that belongs to `element` or a later one.
template <class Table>
auto first_from(const Table& table, Index element) {
  return std::lower_bound(table.begin(), table.end(), element,
                          [](const auto& entry, Index wanted) { return entry.element < wanted; });
}

}  // namespace

template <int D>
SpringDamper<D> SpringDamperKind<D>::described(Index element) const {
  const auto id = [this](Index serial) { return serial == ground.serial ? ground : BodyId{serial, token_}; };
  SpringDamper<D> part{id(from_[element]), id(to_[element]), stiffness_[element], damping_[element],
                       free_length_[element]};
  if (const auto points = first_from(points_, element);
      points != points_.end() && points->element == element) {
    part.from.point = points->from;
    part.to.point = points->to;
  }
  return part;
}

template <int D>
std::unique_ptr<ForceKind> SpringDamperKind<D>::arranged(std::span<const Index> order,
                                                         const Layout& layout) const {
  auto packed = std::make_unique<SpringDamperKind>();
  packed->layout_ = &layout;
  packed->from_.reserve(order.size());
  packed->to_.reserve(order.size());
  for (const Index slot : order) {
    const SpringDamper<D> part = described(slot);
    const Attachment<D> from(part.from, layout);
    const Attachment<D> to(part.to, layout);
    const auto simple = [](const Attachment<D>& end) {
      return end.q != none && end.q == end.v && end.rotation == none;
    };
    if (!simple(from) || !simple(to)) packed->ends_.push_back({packed->size(), from, to});
    packed->stiffness_.push_back(part.stiffness);
    packed->damping_.push_back(part.damping);
    packed->free_length_.push_back(part.free_length);
    packed->from_.push_back(from.q);
    packed->to_.push_back(to.q);
  }
  packed->stiffness_.shrink();
  packed->damping_.shrink();
  packed->free_length_.shrink();
  return packed;
}

template <int D>
void SpringDamperKind<D>::ends(Index element, std::vector<BodyId>& out) const {
  if (layout_ == nullptr) {
    const SpringDamper<D> part = described(element);
    out.push_back(part.from.body);
    out.push_back(part.to.body);
    return;
  }
  // First coordinates grow with the place of the body.
  const auto body_at = [this](Index q) {
    if (q == none) return ground;
    Index first = 0, last = static_cast<Index>(layout_->bodies().size());
    while (last - first > 1) {
      const Index middle = first + (last - first) / 2;
      (layout_->bodies()[middle].q <= q ? first : last) = middle;
    }
    return layout_->id(first);
  };
  out.push_back(body_at(from_[element]));
  out.push_back(body_at(to_[element]));
}

template <int D>
typename SpringDamperKind<D>::Ends SpringDamperKind<D>::ends_of(Index element) const {
  const auto found = first_from(ends_, element);
  if (found != ends_.end() && found->element == element) return *found;
  Ends ends;
  ends.element = element;
  ends.from.q = ends.from.v = from_[element];
  ends.to.q = ends.to.v = to_[element];
  return ends;
}

template <int D>
template <class Centres, class Other>
void SpringDamperKind<D>::for_springs(Range elements, Centres&& centres, Other&& other) const {
  auto next = first_from(ends_, elements.begin);
  for (Index i = elements.begin; i < elements.end;) {
    const Index stop = next == ends_.end() ? elements.end : std::min(next->element, elements.end);
    if (i < stop) centres(Range{i, stop});
    if (stop < elements.end) other(*next++);
    i = stop + 1;
  }
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

/// Pulls of two springs at once, as far as that goes: root and divisions, which cost most, serve both.
/// Returns the first spring left.
template <bool Together, bool WithPotential>
Index pull_by_twos(const PlanarSprings& springs, Index i, Index last, const double* q, const double* v,
                   const Loads& loads, PairSum& potential) {
  const auto at = [](const double* property, Index stride, Index slot) {
    return load_pair(property + slot * stride);
  };
  const auto add = [](double* load, Pair force) { store_pair(load, load_pair(load) + force); };
  for (; i + 1 < last; i += 2) {
    const Index from_a = springs.from[i], from_b = springs.from[i + 1], to_a = springs.to[i],
                to_b = springs.to[i + 1];
    const Pair d_a = load_pair(q + to_a) - load_pair(q + from_a);
    const Pair d_b = load_pair(q + to_b) - load_pair(q + from_b);
    const Pair rate_a = load_pair(v + to_a) - load_pair(v + from_a);
    const Pair rate_b = load_pair(v + to_b) - load_pair(v + from_b);
    const Pair d_x = firsts(d_a, d_b), d_y = seconds(d_a, d_b);
    const Pair square = d_x * d_x + d_y * d_y;
    const Pair length = root(square);
    const Pair inverse = where_not_zero(square, both(1.0) / length);
    const Pair stretch = length - at(springs.free_length, springs.free_length_stride, i);
    const Pair tension = at(springs.stiffness, springs.stiffness_stride, i) * stretch;
    const Pair spring = tension * inverse;
    const Pair dashpot = at(springs.damping, springs.damping_stride, i) *
                         (d_x * firsts(rate_a, rate_b) + d_y * seconds(rate_a, rate_b)) * (inverse * inverse);
    if constexpr (WithPotential) potential.add(both(0.5) * tension * stretch);
    const auto apply = [&](double* load, Pair factor) {
      const Pair force_a = both(factor[0]) * d_a, force_b = both(factor[1]) * d_b;
      add(load + from_a, force_a);
      add(load + to_a, -force_a);
      add(load + from_b, force_b);
      add(load + to_b, -force_b);
    };
    if constexpr (Together) {
      apply(loads.conservative, spring + dashpot);
    } else {
      apply(loads.conservative, spring);
      apply(loads.dissipative, dashpot);
    }
  }
  return i;
}

}  // namespace

template <int D>
template <bool Together, bool WithPotential>
void SpringDamperKind<D>::sweep_centres(const StateView& state, Range elements, const Loads& loads,
                                        PairSum& potential) const {
  using Map = Eigen::Map<Vec<D>>;
  using ConstMap = Eigen::Map<const Vec<D>>;
  const double* const q = state.q;
  const double* const v = state.v;
  Index i = elements.begin;
  if constexpr (D == 2) {
    const PlanarSprings springs{from_.data(),      to_.data(),           stiffness_.data(),
                                damping_.data(),   free_length_.data(),  stiffness_.stride(),
                                damping_.stride(), free_length_.stride()};
    i = pull_by_fours(springs, i, elements.end, q, v, loads.conservative,
                      Together ? nullptr : loads.dissipative, WithPotential ? &potential : nullptr);
    i = pull_by_twos<Together, WithPotential>(springs, i, elements.end, q, v, loads, potential);
  }
  for (; i < elements.end; ++i) {
    const Vec<D> d = ConstMap(q + to_[i]) - ConstMap(q + from_[i]);
    const Vec<D> rate = ConstMap(v + to_[i]) - ConstMap(v + from_[i]);
    const Factors f = factors<D>(stiffness_[i], damping_[i], free_length_[i], d, rate);
    if constexpr (WithPotential) potential.add(Pair{0.5 * stiffness_[i] * f.stretch * f.stretch, 0.0});
    const auto apply = [&](double* load, double factor) {
      const Vec<D> force = factor * d;
      Map(load + from_[i]) += force;
      Map(load + to_[i]) -= force;
    };
    if constexpr (Together) {
      apply(loads.conservative, f.spring + f.dashpot);
    } else {
      apply(loads.conservative, f.spring);
      apply(loads.dissipative, f.dashpot);
    }
  }
}

template <int D>
template <bool Together, bool WithPotential>
double SpringDamperKind<D>::sweep(const EvaluationContext& at, Range elements, const Loads& loads) const {
  PairSum potential;
  for_springs(
      elements,
      [&](Range centres) { sweep_centres<Together, WithPotential>(at.state, centres, loads, potential); },
      [&](const Ends& ends) {
        const Index i = ends.element;
        const Vec<D> from = ends.from.lever(at.evaluation);
        const Vec<D> to = ends.to.lever(at.evaluation);
        const Vec<D> d = ends.to.position(at.state, to) - ends.from.position(at.state, from);
        const Vec<D> rate = ends.to.velocity(at.state, to) - ends.from.velocity(at.state, from);
        const Factors f = factors<D>(stiffness_[i], damping_[i], free_length_[i], d, rate);
        if constexpr (WithPotential) potential.add(Pair{0.5 * stiffness_[i] * f.stretch * f.stretch, 0.0});
        ends.from.add_force(loads.conservative, from, f.spring * d);
        ends.to.add_force(loads.conservative, to, -f.spring * d);
        ends.from.add_force(loads.dissipative, from, f.dashpot * d);
        ends.to.add_force(loads.dissipative, to, -f.dashpot * d);
      });
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
    const Ends ends = ends_of(i);
    const Vec<D> d = ends.to.position(at.state, ends.to.lever(at.evaluation)) -
                     ends.from.position(at.state, ends.from.lever(at.evaluation));
    const double stretch = d.norm() - free_length_[i];
    sum.add(0.5 * stiffness_[i] * stretch * stretch);
  }
  return sum.value();
}

template <int D>
void SpringDamperKind<D>::derivatives(const EvaluationContext& at, Index element,
                                      std::vector<LoadDerivative>& out) const {
  const double stiffness = stiffness_[element], damping = damping_[element];
  const double free_length = free_length_[element];
  const Ends ends = ends_of(element);
  const Vec<D> from = ends.from.lever(at.evaluation);
  const Vec<D> to = ends.to.lever(at.evaluation);
  const LineOfAction<D> line(ends.to.position(at.state, to) - ends.from.position(at.state, from),
                             ends.to.velocity(at.state, to) - ends.from.velocity(at.state, from));
  const ElementView<D> view(at);
  ElementDerivatives<D> list(view, out);
  if (line.length == 0.0 && free_length == 0.0) {
    // Linear through zero: the spring has a derivative where it has no direction.
    list.opposite_forces(ends.from, ends.to, Vec<D>::Zero(), -stiffness * Mat<D>::Identity(), Mat<D>::Zero());
  }
  line.add_pull(list, ends.from, ends.to, stiffness * (line.length - free_length) + damping * line.rate,
                stiffness, damping);
}

template <int D>
Index SpringDamperKind<D>::first_without_direction(const EvaluationContext& at, Range elements,
                                                   double fastest) const {
  for (Index i = elements.begin; i < elements.end; ++i) {
    if (!(stiffness_[i] * free_length_[i] > 0.0)) continue;
    const Ends ends = ends_of(i);
    if (at_one_place(at, ends.from, ends.to, fastest)) return i;
  }
  return elements.end;
}

template <int D>
void SpringDamperKind<D>::fingerprint(Fingerprint& print) const {
  for (Index element = 0; element < size(); ++element) {
    const SpringDamper<D> part = described(element);
    add_to(print, part.from);
    add_to(print, part.to);
    print.add(part.stiffness);
    print.add(part.damping);
    print.add(part.free_length);
  }
}

template <int D>
PartType<ForceKind> SpringDamper<D>::part_type() {
  return PartType<ForceKind>::of<SpringDamperKind<D>, SpringDamper>();
}
template PartType<ForceKind> SpringDamper<2>::part_type();
template PartType<ForceKind> SpringDamper<3>::part_type();
template class SpringDamperKind<2>;
template class SpringDamperKind<3>;

}  // namespace carom::generic
