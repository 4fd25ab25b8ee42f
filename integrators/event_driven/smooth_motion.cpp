// Problem: rates of a component's unknowns, and one state of it evaluated.

#include <carom/integrators/event_driven/smooth_motion.h>

#include <algorithm>

namespace carom {

SmoothMotion::SmoothMotion(const Assembly& assembly, const Detector& detector, Index component,
                           const EventDriven& options, MotionMemory& memory)
    : memory_(&memory),
      joints_(assembly, component, memory),
      model_(assembly, detector, component, options, joints_.rows()),
      guards_(assembly, component),
      jacobian_(model_, joints_, active_, memory) {
  if (joints_.rows().empty()) return;
  active_.bind(assembly, joints_.rows());
  if (!joints_.friction_bounds().empty()) active_.ask_least();  // bounds of friction follow from forces
}

void SmoothMotion::contact(std::size_t pair, const MotionSample& at, Constraint& out) const {
  model_.detector->contact(model_.pairs[pair], at.view(), at.evaluation, at.places, out);
}

void SmoothMotion::sample(double time, const double* y, Forces forces, MotionSample& out) {
  const Assembly& assembly = *model_.assembly;
  memory_->limit.take();
  model_.unknowns.scatter({y, size()}, out.state);
  out.state.time = time;
  model_.detector->place(time, out.places);
  const StateView state = out.view();
  evaluate_positions(assembly, model_.index, state, out.evaluation);
  double* const force = out.evaluation.force.data();
  const LoadTraits traits = model_.loads;
  Loads loads{force, force, force};
  if (traits.books_dissipative) loads.dissipative = out.dissipative.data();
  if (traits.books_external) loads.external = out.external.data();
  evaluate_loads(assembly, model_.index, state, out.evaluation, loads);
  const Range v = model_.ranges().v;
  // Masses are accelerated by the sum of all causes, made where the reactions will be added.
  for (Index i = v.begin; i < v.end; ++i) {
    double sum = force[i];
    if (traits.books_dissipative) sum += out.dissipative[i];
    if (traits.books_external) sum += out.external[i];
    out.loads[i] = sum;
  }
  assembly.for_bodies(model_.index, [&](const BodyKind& kind, Range slots, Index, Index at, Index) {
    kind.apply_inverse_mass(slots, out.loads.data() + at, out.acceleration.data() + at);
  });
  joints_.react(out);
  out.has_forces = true;
  if (forces == Forces::without_contact || active_.list().empty()) return;
  active_.update(*model_.detector, state, out.evaluation, out.places);
  out.has_forces = joints_.add_contact_forces(active_, out);
}

void SmoothMotion::rates(double time, const double* y, double* rates) {
  MotionSample& at = memory_->flow;
  sample(time, y, Forces::all, at);
  const Assembly& assembly = *model_.assembly;
  const MotionUnknowns& unknowns = model_.unknowns;
  const Component& all = model_.ranges();
  const StateView state = at.view();
  assembly.for_bodies(model_.index, [&](const BodyKind& kind, Range slots, Index q, Index v, Index) {
    kind.coordinate_rates(slots, state.q + q, state.v + v, rates + (q - all.q.begin));
  });
  std::copy_n(at.acceleration.begin() + all.v.begin, unknowns.v_size(), rates + unknowns.q_size());
  double inside = 0.0;
  if (unknowns.z_size() != 0) {
    const EvaluationContext context{assembly, state, at.evaluation, model_.index};
    for (Index kind = 0; kind < assembly.force_kinds().size(); ++kind) {
      const Range elements = assembly.elements(model_.index, kind);
      const ForceKind& of_kind = *assembly.force_kinds()[kind];
      if (elements.empty() || of_kind.internal_size() == 0) continue;
      of_kind.internal_rates(context, elements, memory_->z_rates.data());
      inside += of_kind.internal_loss_rate(context, elements);
    }
    std::copy_n(memory_->z_rates.begin() + all.z.begin, unknowns.z_size(), rates + unknowns.z_begin());
  }
  write_works(at, inside, rates);
}

void SmoothMotion::write_works(const MotionSample& at, double lost_inside, double* rates) {
  const MotionUnknowns& unknowns = model_.unknowns;
  const LoadTraits traits = model_.loads;
  const Range v = model_.ranges().v;
  const StateView state = at.view();
  double dashpot = lost_inside, external = 0.0, sliding = 0.0, in_joints = 0.0;
  for (Index i = v.begin; i < v.end; ++i) {
    if (traits.books_dissipative) dashpot -= at.dissipative[i] * state.v[i];
    if (traits.books_external) external += at.external[i] * state.v[i];
  }
  for (const ActiveContact& contact : active_.list()) {
    double& lost = contact.at.has_dry_friction() ? in_joints : sliding;
    lost -= contact.tangential * (contact.sticks() ? 0.0 : contact.at.tangential_velocity(state.v));
    external +=
        contact.normal * contact.at.surface_velocity[0] + contact.tangential * contact.at.surface_velocity[1];
  }
  if (joints_.rows().depends_on_time()) {
    // Reactions do the work of what is prescribed: G v = -rate.
    const std::span<const double> multipliers = joints_.multipliers(at, active_.list());
    for (std::size_t i = 0; i < multipliers.size(); ++i) external -= multipliers[i] * joints_.rows().rate(i);
  }
  rates[unknowns.work_place(WorkLine::dashpot)] = dashpot;
  rates[unknowns.work_place(WorkLine::sliding)] = sliding;
  rates[unknowns.work_place(WorkLine::external)] = external;
  if (unknowns.work_count() == work_lines) rates[unknowns.work_place(WorkLine::joint_friction)] = in_joints;
}

void SmoothMotion::jacobian(double time, const double* y, std::vector<RateDerivative>& out) {
  sample(time, y, Forces::all, memory_->flow);
  jacobian_.append(memory_->flow, out);
}

void SmoothMotion::read_guards(const MotionSample& at, std::vector<GuardMotion>& out) {
  if (guards_.count() == 0) return;
  guards_.read({*model_.assembly, at.view(), at.evaluation, model_.index}, at.acceleration.data(), out);
}

void SmoothMotion::read_guards(double time, const double* y, const double* acceleration, MotionSample& memory,
                               std::vector<GuardMotion>& out) {
  model_.unknowns.scatter({y, size()}, memory.state);
  memory.state.time = time;
  evaluate_positions(*model_.assembly, model_.index, memory.view(), memory.evaluation);
  std::copy_n(acceleration, model_.unknowns.v_size(), memory.acceleration.begin() + model_.ranges().v.begin);
  read_guards(memory, out);
}

}  // namespace carom
