// Problem: the force of a spring-damper over a step that conserves energy and momentum exactly
// (docs/method.md, section 6, rule energy_momentum).

#include <carom/core/assembly.h>
#include <carom/joints/mean_line.h>
#include <carom/joints/spring_damper_kind.h>

namespace carom::generic {

template <int D>
void SpringDamperKind<D>::evaluate_mean(const StepContext& at, Range elements, const Loads& loads) const {
  for (Index i = elements.begin; i < elements.end; ++i) {
    const double stiffness = stiffness_[i], damping = damping_[i], free_length = free_length_[i];
    const Ends ends = ends_of(i);
    const Vec<D> from0 = ends.from.lever(at.start.evaluation);
    const Vec<D> from1 = ends.from.lever(at.end.evaluation);
    const Vec<D> to0 = ends.to.lever(at.start.evaluation);
    const Vec<D> to1 = ends.to.lever(at.end.evaluation);
    const MeanLine<D> line(ends.to.position(at.start.state, to0) - ends.from.position(at.start.state, from0),
                           ends.to.position(at.end.state, to1) - ends.from.position(at.end.state, from1));
    // Without a free length the force is linear, at coinciding ends too.
    const Vec<D> elastic = free_length == 0.0
                               ? Vec<D>(stiffness * line.distance)
                               : Vec<D>(stiffness * (line.length - free_length) * line.direction);
    const Vec<D> viscous = damping * (line.growth / at.step) * line.direction;
    const Vec<D> from = 0.5 * (from0 + from1);
    const Vec<D> to = 0.5 * (to0 + to1);
    ends.from.add_force(loads.conservative, from, elastic);
    ends.to.add_force(loads.conservative, to, -elastic);
    ends.from.add_force(loads.dissipative, from, viscous);
    ends.to.add_force(loads.dissipative, to, -viscous);
  }
}

template class SpringDamperKind<2>;
template class SpringDamperKind<3>;

}  // namespace carom::generic
