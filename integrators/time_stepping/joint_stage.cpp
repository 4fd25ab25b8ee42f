// Problem: end a step on the joints, with velocities that they allow, in contact too.

#include <carom/integrators/time_stepping/far_turn.h>
#include <carom/integrators/time_stepping/joint_stage.h>

#include <algorithm>
#include <cmath>

namespace carom {

namespace {

/// True if the rate of a driver may jump in the step, or at one of its ends. \param breaks of drivers,
/// ascending
bool may_jump(const std::vector<double>& breaks, const StepInput& in) {
  const auto next = std::lower_bound(breaks.begin(), breaks.end(), in.start.time);
  return next != breaks.end() && *next <= in.end_time;
}

}  // namespace

JointStages::JointStages(const Assembly& assembly) : assembly_(&assembly) {
  const auto components = static_cast<Index>(assembly.components().size());
  for (Index component = 0; component < components; ++component) {
    if (!assembly.has_joints(component)) continue;
    if (!arrays_) arrays_ = std::make_unique<JointArrays>(assembly);
    stages_.resize(components);
    stages_[component] = std::make_unique<JointStage>(assembly, component, rows_, *arrays_);
    rows_ += static_cast<Index>(stages_[component]->rows().at_end().size());
  }
}

const double* JointStages::velocities_of_contact(std::span<const Index> components, StepTrial& trial) const {
  if (stages_.empty()) return trial.end.v.data();
  const auto has_joints = [this](Index component) { return of(component) != nullptr; };
  if (std::none_of(components.begin(), components.end(), has_joints)) return trial.end.v.data();
  if (components.size() == 1) return of(components.front())->velocities_of_contact(trial);
  std::vector<double>& allowed = arrays_->allowed;
  for (const Index component : components) {
    if (has_joints(component)) {
      static_cast<void>(of(component)->velocities_of_contact(trial));
    } else {
      const Range v = assembly_->components()[component].v;
      std::copy(trial.end.v.begin() + v.begin, trial.end.v.begin() + v.end, allowed.begin() + v.begin);
    }
  }
  return allowed.data();
}

void JointStages::record(double step, JointHistory& history) const {
  if (stages_.empty()) return;
  history.go_on(step, stages_.size(), rows_, arrays_->displacement.size());
  for (const auto& stage : stages_) {
    if (stage != nullptr) stage->record(history);
  }
}

void JointStages::forget_paths() {
  for (const auto& stage : stages_) {
    if (stage != nullptr) stage->answer().forget_path();
  }
}

JointStage::JointStage(const Assembly& assembly, Index component, Index first_row, JointArrays& arrays)
    : joints_(assembly, component, arrays),
      answer_(component, joints_.rows.at_end()),
      untouched_(joints_, first_row),
      total_(joints_.impulse),
      bounds_(assembly, component, joints_.rows.at_end()) {
  for (Index kind = 0; kind < assembly.joint_kinds().size(); ++kind) {
    const Range own = assembly.joints(component, kind);
    for (Index joint = own.begin; joint < own.end; ++joint)
      assembly.joint_kinds()[kind]->discontinuity_times(joint, breaks_);
  }
  std::sort(breaks_.begin(), breaks_.end());
}

void JointStage::start(const StepInput& in, const StepRule& rule, Iteration iteration, JointsTouch touch,
                       StepTrial& trial) {
  joints_.clear(joints_.arrays->dv_contact);
  touch_ = touch;
  const bool untouched = touch == JointsTouch::nothing;
  // Mean rows give velocities by their mean with those before: behind a jump they would alternate for ever.
  const bool mean = rule.is_mean() && untouched && !may_jump(breaks_, in);
  guessed_ = iteration == Iteration::fixed_point && untouched && mean == rule.is_mean() &&
             untouched_.start(in, rule, trial);
  if (!guessed_) begin_at_start(in, mean, trial);
  if (iteration == Iteration::linearly_implicit && untouched) untouched_.guess_impulses(in);
  if (!is_struck() && !answer_.rows().depends_on_time()) return;
  answer_.place(in, trial);
  if (is_struck()) answer_.rows().factor();
}

/// The first iterate without reactions. \param mean whether these are to act along mean rows
void JointStage::begin_at_start(const StepInput& in, bool mean, StepTrial& trial) {
  JointArrays& arrays = *joints_.arrays;
  const Range q = joints_.assembly->components()[joints_.component].q, v = joints_.v();
  joints_.rows.start(in, mean, trial);
  std::fill(joints_.impulse.begin(), joints_.impulse.end(), 0.0);
  for (std::vector<double>* const numbers : {&trial.dv_impulses, &arrays.dv_joints, &arrays.displacement}) {
    joints_.clear(*numbers);
  }
  std::copy(in.start.q.begin() + q.begin, in.start.q.begin() + q.end, trial.end.q.begin() + q.begin);
  std::copy(in.start.v.begin() + v.begin, in.start.v.begin() + v.end, trial.end.v.begin() + v.begin);
  for (Index i = v.begin; i < v.end; ++i) arrays.scratch[i] = in.step * in.start.v[i];
  joints_.displace(arrays.scratch, trial.end);
}

void JointStage::approach(const StepInput& in, const StepRule& rule, StepTrial& trial, double* free) {
  joints_.react(in, rule, trial);
  if (touch_ == JointsTouch::nothing) return;
  const Range v = joints_.v();
  for (Index i = v.begin; i < v.end; ++i) free[i] = trial.free[i] + joints_.arrays->dv_joints[i];
  if (is_struck()) {
    allow_answered(free);
  } else {
    joints_.rows.at_midpoint().factor();
  }
}

void JointStage::leave(const StepInput& in, const StepRule& rule, const double* change, StepTrial& trial) {
  if (change != nullptr) {
    const Range v = joints_.v();
    std::copy(change + v.begin, change + v.end, joints_.arrays->dv_contact.begin() + v.begin);
    joints_.correct_impulses(in, trial);  // for what contact changed
  }
  joints_.move_onto_joints(in, rule, trial);
}

const double* JointStage::velocities_of_contact(StepTrial& trial) {
  if (!is_struck()) return trial.end.v.data();
  const Range v = joints_.v();
  std::vector<double>& allowed = joints_.arrays->allowed;
  std::copy(trial.end.v.begin() + v.begin, trial.end.v.begin() + v.end, allowed.begin() + v.begin);
  allow_answered(allowed.data());
  return allowed.data();
}

void JointStage::turn_friction(std::span<Constraint> friction, const JointRows& rows, const double* free,
                               StepTrial& trial) {
  JointArrays& arrays = *joints_.arrays;
  const Range v = joints_.v();
  for (Index i = v.begin; i < v.end; ++i) arrays.scratch[i] = free[i] + arrays.dv_contact[i];
  const JointView halfway{trial.midpoint.view(), trial.at_midpoint.rotation.data()};
  const JointView end{trial.end.view(), trial.at_end.rotation.data()};
  for (Constraint& of_joint : friction) {
    rows.update_friction(end, of_joint);
    const double at_end = of_joint.times(0, arrays.scratch.data());
    rows.update_friction(halfway, of_joint);
    of_joint.surface_velocity_after[0] = of_joint.times(0, arrays.scratch.data()) - at_end;
  }
}

const double* JointStage::multipliers(const IslandProblem* problem) {
  total_ = joints_.impulse;
  if (problem == nullptr) return total_.data();
  JointConstraints& answering = this->answering(touch_);
  std::vector<double>& loads = joints_.arrays->scratch;
  joints_.clear(loads);
  problem->map().add_loads(1.0, loads.data());
  answering.apply_inverse_mass(loads.data());
  answering.project(JointLevel::change, loads.data(), joints_.left.data());
  for (std::size_t row = 0; row < total_.size(); ++row) total_[row] += joints_.left[row];
  return total_.data();
}

SweepChange JointStage::change(const StepInput& in, const StepTrial& trial) {
  if (guessed_) return untouched_.change(in, trial);
  SweepChange change;
  const JointArrays& arrays = *joints_.arrays;
  joints_.assembly->for_bodies(
      joints_.component, [&](const BodyKind& kind, Range slots, Index q, Index v, Index) {
        for (Index slot = slots.begin; slot < slots.end; ++slot, q += kind.q_size(), v += kind.v_size()) {
          for (Index i = 0; i < kind.v_size(); ++i) {
            const double weight = in.step * arrays.lengths[v + i];
            change.take(weight * (trial.end.v[v + i] - arrays.before_v[v + i]), weight * trial.end.v[v + i]);
          }
          for (Index i = 0; i < kind.q_size(); ++i) {
            // Coordinates without a velocity of their own (unit quaternions) are judged as they are.
            const double weight = i < kind.v_size() ? arrays.lengths[v + i] : 1.0;
            change.take(weight * (trial.end.q[q + i] - arrays.before_q[q + i]), trial.end.q[q + i]);
          }
        }
      });
  return change;
}

void JointStage::settle_velocities(StepTrial& trial) {
  if (!joints_.rows.correct_velocities(trial, joints_.left)) return;
  for (std::size_t row = 0; row < joints_.left.size(); ++row) joints_.impulse[row] += joints_.left[row];
  joints_.rows.at_midpoint().add_response(joints_.left.data(), joints_.arrays->dv_joints.data());
}

void JointStage::finish(const StepInput& in, StepTrial& trial) const {
  if (!guessed_) joints_.rows.place_midpoint(in, trial);
}

double JointStage::violation(const StepInput& in, StepTrial& trial) {
  if (guessed_) return untouched_.violation();
  joints_.rows.place_end(in, trial);
  return joints_.violation(trial.end).worst();
}

StrayBody JointStage::find_stray(const StepInput& in, const StepTrial& trial, double tolerance) const {
  // Chords of a circle leave its arcs by a twelfth of the square of the angle: of some 1.5 rad this part.
  constexpr double most = 0.2;
  // Of the size of the mechanism, and of the tolerance: what rounding may do at rest.
  constexpr double unseen = 1e-9, tolerances = 10.0;
  StrayBody stray{.back = joints_.largest_displacement(),
                  .way = longest_way(in, joints_.v(), joints_.arrays->lengths, trial.end)};
  stray.allowed = most * stray.way;
  if (!(stray.back > stray.allowed + tolerances * tolerance)) return stray;
  if (may_jump(breaks_, in)) return stray;  // rates that jump are no way
  const Assembly& assembly = *joints_.assembly;
  const JointArrays& arrays = *joints_.arrays;
  const Component& all = assembly.components()[joints_.component];
  const double size = size_of(assembly, all.bodies, arrays.lengths, trial.end);
  if (!(stray.back > stray.allowed + unseen * size)) return stray;
  for (Index body = all.bodies.begin; body < all.bodies.end; ++body) {
    const BodySlot slot = assembly.layout()->bodies()[body];
    for (Index v = slot.v; v < slot.v + slot.v_size; ++v) {
      const bool is_farthest = arrays.lengths[v] * std::abs(arrays.displacement[v]) >= stray.back;
      if (is_farthest) stray.body = assembly.layout()->id(body);
    }
  }
  return stray;
}

JointId JointStage::worst_joint(double& violation) const {
  const JointConstraints& end = joints_.rows.at_end();
  JointId worst;
  violation = 0.0;
  for (std::size_t row = 0; row < end.size(); ++row) {
    const double gap = std::abs(end.gaps()[row]);
    if (!(gap > violation)) continue;
    violation = gap;
    worst = end.joint(row);
  }
  return worst;
}

}  // namespace carom
