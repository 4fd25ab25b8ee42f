// Problem: rates of a component's unknowns, and its way back onto the constraints.

#include <carom/integrators/event_driven/smooth_motion.h>

#include <algorithm>
#include <cmath>

namespace carom {

namespace {

/// False near a singular position where positions and velocities obey the joints to rounding. There rounding
/// of the rows, divided by the distance a from the position, would move bodies, and divided by a^2 their
/// velocities: by more than tolerances allow, so that steps of a multistep method would shrink to nothing.
bool leaves_joints(const JointConstraints& joints, MotionWorkspace& work) {
  constexpr double near_pivot = 1e-4;  // within some 0.01 rad
  constexpr double rounding = 1e-14;   // of gaps and rates, against the numbers that they are made of
  const auto near = [&](std::size_t row) {
    const double pivot = joints.factors().pivot(row);
    return pivot > dependent_pivot && pivot < near_pivot;
  };
  bool any_near = false;
  for (std::size_t row = 0; row < joints.size() && !any_near; ++row) any_near = near(row);
  if (!any_near) return true;
  const Range v = joints.velocities();
  double extent = 0.0, speed = 0.0;
  for (const double x : work.trial.q) extent = std::max(extent, std::abs(x));
  for (Index i = v.begin; i < v.end; ++i) {
    speed = std::max(speed, std::abs(work.trial.v[i]) * std::max(work.lengths[i], 1.0));
  }
  work.multipliers.resize(joints.size());
  joints.residuals(JointLevel::velocity, work.trial.v.data(), work.multipliers.data());
  for (std::size_t row = 0; row < joints.size(); ++row) {
    if (std::abs(joints.gap(row)) > rounding * extent) return true;
    if (std::abs(work.multipliers[row]) > rounding * speed) return true;
  }
  return false;
}

/// Discontinuities of the joints and force elements of a component.
std::vector<Discontinuity> breaks_in(const Assembly& assembly, Index component) {
  std::vector<Discontinuity> all;
  std::vector<double> times;
  for (Index kind = 0; kind < assembly.joint_kinds().size(); ++kind) {
    const Range joints = assembly.joints(component, kind);
    for (Index joint = joints.begin; joint < joints.end; ++joint) {
      times.clear();
      assembly.joint_kinds()[kind]->breaks(joint, times);
      for (const double time : times) {
        all.push_back({.time = time, .joint = assembly.joint_id(kind, joint)});
      }
    }
  }
  for (Index kind = 0; kind < assembly.force_kinds().size(); ++kind) {
    const Range elements = assembly.elements(component, kind);
    for (Index element = elements.begin; element < elements.end; ++element) {
      times.clear();
      assembly.force_kinds()[kind]->breaks(element, times);
      for (const double time : times) {
        all.push_back({.time = time, .element = assembly.element_id(kind, element)});
      }
    }
  }
  return all;
}

}  // namespace

MotionWorkspace::MotionWorkspace(const Assembly& assembly)
    : trial(assembly.layout()), evaluation(make_evaluation(assembly)), lengths(assembly.length_scales()) {
  const std::size_t size = trial.v.size();
  for (std::vector<double>* array :
       {&dissipative, &external, &acceleration, &of_position, &of_velocity, &momentum}) {
    array->assign(size, 0.0);
  }
  z_rates.assign(trial.z.size(), 0.0);
}

SmoothMotion::SmoothMotion(const Assembly& assembly, const Detector& detector, Index component,
                           const EventDriven& options, MotionWorkspace& work)
    : assembly_(&assembly),
      detector_(&detector),
      work_(&work),
      component_(component),
      work_count_(detector.has_dry_friction(component) ? work_lines : work_lines - 1),
      q_size_(assembly.components()[component].q.size()),
      v_size_(assembly.components()[component].v.size()),
      z_size_(assembly.components()[component].z.size()),
      size_(q_size_ + v_size_ + z_size_ + work_count_),
      tolerances_(size_, options.absolute_tolerance),
      pairs_(detector.pairs(component)),
      joints_(assembly, component),
      guards_(assembly, component) {
  if (!joints_.empty()) {
    joints_.factors().reveal_rank(true);
    active_.bind(assembly, joints_);
    pressure_ = FrictionBounds(assembly, component, joints_);
    if (!pressure_.empty()) active_.ask_least();  // bounds of friction follow from forces
    const std::vector<ContactPair> rubbing = detector.rubbing(component);
    pairs_.insert(pairs_.end(), rubbing.begin(), rubbing.end());
    // What answers together stands together.
    std::stable_sort(pairs_.begin(), pairs_.end(), [&](const ContactPair& a, const ContactPair& b) {
      return mechanism(a.body) < mechanism(b.body);
    });
    depends_on_time_ = joints_.depends_on_time();
  }
  for (Index kind = 0; kind < assembly.force_kinds().size(); ++kind) {
    if (assembly.elements(component, kind).empty()) continue;
    const ForceKind& elements = *assembly.force_kinds()[kind];
    books_dissipative_ = books_dissipative_ || elements.books_dissipative();
    books_external_ = books_external_ || elements.books_external();
    depends_on_time_ = depends_on_time_ || elements.depends_on_time();
    only_fields_ =
        only_fields_ && elements.is_field() && !elements.books_dissipative() && !elements.depends_on_time();
  }
  const bool obstacles_move = !pairs_.empty() && detector.has_moving_obstacles();
  depends_on_time_ = depends_on_time_ || obstacles_move;
  breaks_ = breaks_in(assembly, component);
  if (obstacles_move) {
    const std::vector<Discontinuity> of_obstacles = detector.breaks();
    breaks_.insert(breaks_.end(), of_obstacles.begin(), of_obstacles.end());
  }
  std::stable_sort(breaks_.begin(), breaks_.end(),
                   [](const Discontinuity& a, const Discontinuity& b) { return a.time < b.time; });
  breaks_.erase(std::unique(breaks_.begin(), breaks_.end()), breaks_.end());
  double mass = 0.0;
  const Component& all = assembly.components()[component];
  assembly.for_bodies(component, [&](const BodyKind& kind, Range slots, Index q, Index v, Index) {
    for (Index slot = slots.begin; slot < slots.end; ++slot) {
      mass += kind.mass(slot);
      const Index body = slot - slots.begin;
      for (Index i = 0; i < kind.v_size(); ++i) {
        const double tolerance = options.absolute_tolerance / kind.length_scale(slot, i);
        tolerances_[q_size_ + (v - all.v.begin) + body * kind.v_size() + i] = tolerance;
        // Orientations come last in both and are measured alike in the plane.
        if (i < kind.q_size()) tolerances_[(q - all.q.begin) + body * kind.q_size() + i] = tolerance;
      }
    }
  });
  for (Index i = 0; i < work_count_; ++i) tolerances_[size_ - 1 - i] = mass * options.absolute_tolerance;
}

void SmoothMotion::contact(std::size_t pair, Constraint& out) const {
  detector_->contact(pairs_[pair], work_->trial.view(), work_->evaluation, work_->places, out);
}

void SmoothMotion::gather(const State& state, std::span<double> y) const {
  const Component& all = assembly_->components()[component_];
  auto out = std::copy_n(state.q.begin() + all.q.begin, q_size_, y.begin());
  out = std::copy_n(state.v.begin() + all.v.begin, v_size_, out);
  out = std::copy_n(state.z.begin() + all.z.begin, z_size_, out);
  std::fill(out, y.end(), 0.0);
}

void SmoothMotion::scatter(std::span<const double> y, State& state) const {
  const Component& all = assembly_->components()[component_];
  const double* from = y.data();
  std::copy_n(from, q_size_, state.q.begin() + all.q.begin);
  std::copy_n(from + q_size_, v_size_, state.v.begin() + all.v.begin);
  std::copy_n(from + q_size_ + v_size_, z_size_, state.z.begin() + all.z.begin);
}

bool SmoothMotion::evaluate(double time, const double* y, bool with_reactions) {
  MotionWorkspace& work = *work_;
  const Assembly& assembly = *assembly_;
  work.limit.take();
  scatter({y, size_}, work.trial);
  work.trial.time = time;
  detector_->place(time, work.places);
  const StateView state = work.trial.view();
  evaluate_positions(assembly, component_, state, work.evaluation);
  double* const force = work.evaluation.force.data();
  Loads loads{force, force, force};
  if (books_dissipative_) loads.dissipative = work.dissipative.data();
  if (books_external_) loads.external = work.external.data();
  evaluate_loads(assembly, component_, state, work.evaluation, loads);
  const Range v = assembly.components()[component_].v;
  // What the masses accelerate by: the sum of all causes, made where the reactions will be added.
  for (Index i = v.begin; i < v.end; ++i) {
    double sum = force[i];
    if (books_dissipative_) sum += work.dissipative[i];
    if (books_external_) sum += work.external[i];
    work.momentum[i] = sum;
  }
  assembly.for_bodies(component_, [&](const BodyKind& kind, Range slots, Index, Index at, Index) {
    kind.apply_inverse_mass(slots, work.momentum.data() + at, work.acceleration.data() + at);
  });
  if (!joints_.empty()) {
    joints_.update_and_factor({state, work.evaluation.rotation.data()});
    joints_.project(JointLevel::acceleration, work.acceleration.data());
  }
  if (!with_reactions || active_.list().empty()) return true;
  active_.update_and_factor(*detector_, state, work.evaluation, work.places);
  if (!pressure_.empty()) return add_friction_bound_reactions();
  return active_.add_reactions(assembly, work.acceleration.data());
}

void SmoothMotion::rates(double time, const double* y, double* rates) {
  MotionWorkspace& work = *work_;
  const Assembly& assembly = *assembly_;
  evaluate(time, y, true);
  const Component& all = assembly.components()[component_];
  const StateView state = work.trial.view();
  assembly.for_bodies(component_, [&](const BodyKind& kind, Range slots, Index q, Index v, Index) {
    kind.coordinate_rates(slots, state.q + q, state.v + v, rates + (q - all.q.begin));
  });
  std::copy_n(work.acceleration.begin() + all.v.begin, v_size_, rates + q_size_);
  double inside = 0.0;
  if (z_size_ != 0) {
    const EvaluationContext at{assembly, state, work.evaluation, component_};
    for (Index kind = 0; kind < assembly.force_kinds().size(); ++kind) {
      const Range elements = assembly.elements(component_, kind);
      const ForceKind& of_kind = *assembly.force_kinds()[kind];
      if (elements.empty() || of_kind.internal_size() == 0) continue;
      of_kind.internal_rates(at, elements, work.z_rates.data());
      inside += of_kind.internal_loss_rate(at, elements);
    }
    std::copy_n(work.z_rates.begin() + all.z.begin, z_size_, rates + q_size_ + v_size_);
  }
  double dashpot = inside, external = 0.0, sliding = 0.0, in_joints = 0.0;
  for (Index i = all.v.begin; i < all.v.end; ++i) {
    if (books_dissipative_) dashpot -= work.dissipative[i] * state.v[i];
    if (books_external_) external += work.external[i] * state.v[i];
  }
  for (const ActiveContact& contact : active_.list()) {
    double& rubbed = contact.at.has_dry_friction() ? in_joints : sliding;
    rubbed -= contact.tangential * (contact.sticks() ? 0.0 : contact.at.tangential_velocity(state.v));
    external +=
        contact.normal * contact.at.surface_velocity[0] + contact.tangential * contact.at.surface_velocity[1];
  }
  if (joints_.depends_on_time()) {
    // Reactions do the work of what is prescribed: G v = -rate.
    const std::span<const double> multipliers = joint_multipliers();
    for (std::size_t i = 0; i < multipliers.size(); ++i) external -= multipliers[i] * joints_.rate(i);
  }
  rates[work_place(WorkLine::dashpot)] = dashpot;
  rates[work_place(WorkLine::sliding)] = sliding;
  rates[work_place(WorkLine::external)] = external;
  if (work_count_ == work_lines) rates[work_place(WorkLine::joint_friction)] = in_joints;
}

double SmoothMotion::project(std::span<double> y, bool& changed, double& shift) {
  changed = false;
  projection_energy_ = 0.0;
  if (active_.list().empty() && joints_.empty()) return 0.0;
  MotionWorkspace& work = *work_;
  const Assembly& assembly = *assembly_;
  const Component& all = assembly.components()[component_];
  const auto clear = [&](std::vector<double>& array) {
    std::fill(array.begin() + all.v.begin, array.begin() + all.v.end, 0.0);
  };
  clear(work.of_position);
  clear(work.of_velocity);
  if (!joints_.empty() && leaves_joints(joints_, work)) {
    joints_.project(JointLevel::displacement, work.of_position.data());
    std::copy(work.trial.v.begin() + all.v.begin, work.trial.v.begin() + all.v.end,
              work.of_velocity.begin() + all.v.begin);
    joints_.project(JointLevel::velocity, work.of_velocity.data());
    for (Index i = all.v.begin; i < all.v.end; ++i) work.of_velocity[i] -= work.trial.v[i];
  }
  changed =
      active_.corrections(assembly, work.trial.v.data(), work.of_position.data(), work.of_velocity.data()) ||
      !joints_.empty();
  if (!changed) return 0.0;
  double lost = 0.0;
  // The potential changes by minus the work of its forces, to first order: the rest is the square of
  // rounding.
  for (Index i = all.v.begin; i < all.v.end; ++i) {
    lost += work.evaluation.force[i] * work.of_position[i];
    shift = std::max(shift, std::abs(work.of_position[i]) * work.lengths[i]);
  }
  assembly.for_bodies(component_, [&](const BodyKind& kind, Range slots, Index q, Index v, Index) {
    kind.apply_mass(slots, work.of_velocity.data() + v, work.momentum.data() + v);
    kind.advance(slots, work.trial.q.data() + q, work.of_position.data() + v, y.data() + (q - all.q.begin));
  });
  for (Index i = all.v.begin; i < all.v.end; ++i) {
    lost -= (work.trial.v[i] + 0.5 * work.of_velocity[i]) * work.momentum[i];
    projection_energy_ += 0.5 * work.of_velocity[i] * work.momentum[i];
    y[q_size_ + (i - all.v.begin)] += work.of_velocity[i];
  }
  return lost;
}

void SmoothMotion::read_guards(std::vector<GuardMotion>& out) {
  if (guards_.count() == 0) return;
  const EvaluationContext at{*assembly_, work_->trial.view(), work_->evaluation, component_};
  guards_.read(at, work_->acceleration.data(), out);
}

double SmoothMotion::total_kinetic_energy() const {
  double sum = 0.0;
  assembly_->for_bodies(component_, [&](const BodyKind& kind, Range slots, Index, Index v, Index) {
    sum += kind.kinetic_energy(slots, work_->trial.v.data() + v);
  });
  return sum;
}

void SmoothMotion::read_guards(double time, const double* y, const double* acceleration,
                               std::vector<GuardMotion>& out) {
  MotionWorkspace& work = *work_;
  scatter({y, size_}, work.trial);
  work.trial.time = time;
  evaluate_positions(*assembly_, component_, work.trial.view(), work.evaluation);
  std::copy_n(acceleration, v_size_, work.acceleration.begin() + assembly_->components()[component_].v.begin);
  read_guards(out);
}

double SmoothMotion::kinetic_energy(Index body) const {
  const auto of_body = [&](Index one) {
    const BodySlot slot = assembly_->layout()->bodies()[one];
    return assembly_->body_kinds()[slot.kind]->kinetic_energy({slot.slot, slot.slot + 1},
                                                              work_->trial.v.data() + slot.v);
  };
  if (!assembly_->is_jointed(body)) return of_body(body);
  double sum = 0.0;
  const Range bodies = assembly_->components()[component_].bodies;
  for (Index other = bodies.begin; other < bodies.end; ++other) {
    if (mechanism(other) == mechanism(body)) sum += of_body(other);
  }
  return sum;
}

}  // namespace carom
