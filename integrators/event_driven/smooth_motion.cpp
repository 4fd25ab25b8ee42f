// Problem: rates of a group's unknowns, and one state of it evaluated.

#include <carom/integrators/event_driven/smooth_motion.h>

#include <algorithm>

namespace carom {

SmoothMotion::SmoothMotion(const Assembly& assembly, const Detector& detector, const GroupComponents& group,
                           const EventDriven& options, MotionMemory& memory)
    : memory_(&memory),
      joints_(assembly, group.components, memory),
      model_(assembly, detector, group, options, joints_.rows()),
      active_(memory.active),
      guards_(assembly, group.components) {
  // There are many groups alike.
  if (memory.tolerances && *memory.tolerances == *model_.tolerances) model_.tolerances = memory.tolerances;
  memory.tolerances = model_.tolerances;
  active_.bind(assembly, joints_.rows().response());
  if (joints_.rows().empty()) return;
  if (!joints_.friction_bounds().empty()) active_.ask_least();  // bounds of friction follow from forces
}

void SmoothMotion::contact(std::size_t pair, const MotionSample& at, Constraint& out) const {
  model_.detector->contact(model_.pairs[pair], at.view(), at.evaluation, at.places, out);
}

void SmoothMotion::contact_if_near(std::size_t pair, const MotionSample& at, double near,
                                   Constraint& out) const {
  if (const Index bound = model_.bound_of(pair); bound != none) {
    const GroundMotion* const motion = motion_of(*model_.detector, model_.pairs[pair], at.places);
    const double least = model_.bounds[bound].least_gap(at.view(), motion);
    if (least > near) {
      out.clear_bodies();
      out.rows = 0;
      out.surface_velocity = {};
      out.gap = least;
      return;
    }
  }
  contact(pair, at, out);
}

/// Rotations cost a sine and a cosine each: discs over flat ground go without.
void SmoothMotion::place_bodies(MotionSample& at) const {
  if (!model_.loads.needs_rotations) return;
  for (const auto& part : model_.parts()) {
    evaluate_positions(*model_.assembly, part.component, at.view(), at.evaluation);
  }
}

void SmoothMotion::sample(double time, const double* y, Forces forces, MotionSample& out) {
  const Assembly& assembly = *model_.assembly;
  memory_->limit.take();
  model_.unknowns.scatter({y, size()}, out.state);
  out.state.time = time;
  model_.detector->place(time, out.places);
  const StateView state = out.view();
  place_bodies(out);
  double* const force = out.evaluation.force.data();
  const LoadTraits traits = model_.loads;
  Loads loads{force, force, force};
  if (traits.books_dissipative) loads.dissipative = out.dissipative.data();
  if (traits.books_external) loads.external = out.external.data();
  double* const all_loads = out.loads().data();
  for (const auto& part : model_.parts()) {
    evaluate_loads(assembly, part.component, state, out.evaluation, loads);
    const Range v = part.ranges.v;
    if (all_loads == force) continue;
    // Masses are accelerated by the sum of all causes.
    for (Index i = v.begin; i < v.end; ++i) {
      double sum = force[i];
      if (traits.books_dissipative) sum += out.dissipative[i];
      if (traits.books_external) sum += out.external[i];
      all_loads[i] = sum;
    }
  }
  model_.for_bodies([&](const BodyKind& kind, Range slots, Index, Index at, const auto&) {
    kind.apply_inverse_mass(slots, all_loads + at, out.acceleration.data() + at);
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
  const StateView state = at.view();
  model_.for_bodies([&](const BodyKind& kind, Range slots, Index q, Index v, const auto& part) {
    kind.coordinate_rates(slots, state.q + q, state.v + v, rates + part.q + (q - part.ranges.q.begin));
  });
  double inside = 0.0;
  for (const auto& part : unknowns.parts()) {
    const Component& all = part.ranges;
    std::copy_n(at.acceleration.begin() + all.v.begin, all.v.size(), rates + part.v);
    if (all.z.empty()) continue;
    const EvaluationContext context{assembly, state, at.evaluation, part.component};
    for (Index kind = 0; kind < assembly.force_kinds().size(); ++kind) {
      const Range elements = assembly.elements(part.component, kind);
      const ForceKind& of_kind = *assembly.force_kinds()[kind];
      if (elements.empty() || of_kind.internal_size() == 0) continue;
      of_kind.internal_rates(context, elements, memory_->z_rates.data());
      inside += of_kind.internal_loss_rate(context, elements);
    }
    std::copy_n(memory_->z_rates.begin() + all.z.begin, all.z.size(), rates + part.z);
  }
  write_works(at, inside, rates);
}

void SmoothMotion::write_works(const MotionSample& at, double lost_inside, double* rates) {
  const MotionUnknowns& unknowns = model_.unknowns;
  const LoadTraits traits = model_.loads;
  const StateView state = at.view();
  double dashpot = lost_inside, external = 0.0, sliding = 0.0, in_joints = 0.0, rolling = 0.0;
  const auto work_of = [&](const std::vector<double>& loads) {
    double work = 0.0;
    for (const auto& part : unknowns.parts()) {
      for (Index i = part.ranges.v.begin; i < part.ranges.v.end; ++i) work += loads[i] * state.v[i];
    }
    return work;
  };
  if (traits.books_dissipative) dashpot -= work_of(at.dissipative);
  if (traits.books_external) external += work_of(at.external);
  for (const ActiveContact& contact : active_.list()) {
    double& lost = contact.at.attached ? rolling : contact.at.normals > 0 ? sliding : in_joints;
    for_tangents(contact.at, [&](std::size_t k, int row) {
      lost -= contact.tangential[k] * (contact.sticks() ? 0.0 : contact.at.velocity(row, state.v));
      external += contact.tangential[k] * contact.at.surface_velocity[static_cast<std::size_t>(row)];
    });
    if (contact.at.normals > 0) external += contact.normal * contact.at.surface_velocity[0];
  }
  if (joints_.rows().depends_on_time()) {
    // Reactions do the work of what is prescribed: G v = -rate.
    const std::span<const double> multipliers = joints_.multipliers(at, active_.list());
    for (std::size_t i = 0; i < multipliers.size(); ++i) external -= multipliers[i] * joints_.rows().rate(i);
  }
  rates[unknowns.work_place(WorkLine::dashpot)] = dashpot;
  rates[unknowns.work_place(WorkLine::sliding)] = sliding;
  rates[unknowns.work_place(WorkLine::external)] = external;
  if (unknowns.has_work(WorkLine::joint_friction))
    rates[unknowns.work_place(WorkLine::joint_friction)] = in_joints;
  if (unknowns.has_work(WorkLine::rolling)) rates[unknowns.work_place(WorkLine::rolling)] = rolling;
}

void SmoothMotion::jacobian(double time, const double* y, std::vector<RateDerivative>& out) {
  sample(time, y, Forces::all, memory_->flow);
  if (!jacobian_) jacobian_ = std::make_unique<MotionJacobian>(model_, joints_, active_, *memory_);
  jacobian_->append(memory_->flow, out);
}

void SmoothMotion::read_guards(const MotionSample& at, std::vector<GuardMotion>& out) {
  if (guards_.count() == 0) return;
  guards_.read(at.view(), at.evaluation, at.acceleration.data(), out);
}

void SmoothMotion::read_guards(double time, const double* y, const double* acceleration, MotionSample& memory,
                               std::vector<GuardMotion>& out) {
  model_.unknowns.scatter({y, size()}, memory.state);
  memory.state.time = time;
  place_bodies(memory);
  model_.unknowns.for_velocities([&](Range v, std::size_t place) {
    std::copy_n(acceleration + place, v.size(), memory.acceleration.begin() + v.begin);
  });
  read_guards(memory, out);
}

}  // namespace carom
