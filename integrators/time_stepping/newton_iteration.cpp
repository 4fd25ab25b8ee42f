// Problem: guess the loads at the end of a step by the derivatives of the elements, contact included.

#include <carom/integrators/time_stepping/newton_iteration.h>

#include <algorithm>
#include <optional>

namespace carom {

NewtonIteration::Outcome NewtonIteration::start(const StepInput& in, const StepRule& rule,
                                                const NewtonIsland& island, StepTrial& trial) {
  update_.resize(trial.end.v.size());
  scratch_.resize(trial.end.v.size());
  for (const Index component : island.components) {
    const Range v = in.assembly.components()[component].v, q = in.assembly.components()[component].q;
    JointStage* const joints = island.joints.of(component);
    if (joints == nullptr) {
      std::copy(in.start.q.begin() + q.begin, in.start.q.begin() + q.end, trial.end.q.begin() + q.begin);
      std::copy(in.start.v.begin() + v.begin, in.start.v.begin() + v.end, trial.end.v.begin() + v.begin);
    }
    Loads led_to = trial.loads_end.in_one();
    evaluate_loads(in.assembly, component, in.start.view(), trial.at_start, led_to);
    for (Index i = v.begin; i < v.end; ++i) {
      trial.loads_guess[i] = rule.is_mean() ? 0.0 : -in.companion.loads.total[i];
    }
    if (joints == nullptr) continue;
    joints->rows().place(in, trial);
    joints->rows().at_end().factor();
  }
  if (island.contact != nullptr) island.contact->forget_impulses();
  JointStage* const joints = island.joints.of(island.components.front());
  follows_rows_ = island.components.size() == 1 && joints != nullptr && island.contact == nullptr;
  if (!linearise(in, island, in.start.view(), trial.at_start)) return Outcome::singular;
  for (const LinearisedComponent& component : linearised_) {
    component.step->add_stiffness_times(rule.is_mean() ? 0.5 * in.step : in.step, in.start.v.data(),
                                        trial.loads_end.total.data());
  }
  stale_ = false;
  damping_.start();
  return Outcome::done;
}

bool NewtonIteration::linearise(const StepInput& in, const NewtonIsland& island, const StateView& at,
                                const Evaluation& evaluation) {
  if (matrices_.size() < island.components.size()) matrices_.resize(island.components.size());
  linearised_.clear();
  for (const Index component : island.components) {
    ImplicitSolver& matrix = matrices_[linearised_.size()];
    JointStage* const joints = island.joints.of(component);
    std::optional<ImplicitSolver::Border> border;
    if (joints != nullptr) {
      border.emplace(ImplicitSolver::Border{joints->rows().at_end(), joints->rows().at_midpoint()});
    }
    const auto outcome = matrix.factor(in.assembly, component, at, evaluation, in.step,
                                       border ? &*border : nullptr, island.contact != nullptr);
    if (outcome == ImplicitSolver::Outcome::singular) return false;
    const bool struck = joints != nullptr && joints->is_struck();
    linearised_.push_back(
        {&matrix, in.assembly.components()[component].v, struck ? &joints->answer().rows() : nullptr});
  }
  // With joints W is made anew by every sweep.
  if (island.contact == nullptr || has_joints(in.assembly, island.components)) return true;
  LinearisedResponse response(in.assembly, linearised_);
  island.contact->respond(response);
  return true;
}

NewtonIteration::Outcome NewtonIteration::step(const StepInput& in, const StepRule& rule,
                                               const NewtonIsland& island, StepTrial& trial) {
  if (has_joints(in.assembly, island.components)) return step_with_joints(in, rule, island, trial);
  if (stale_ && !linearise(in, island, trial.end.view(), trial.at_end)) return Outcome::singular;
  IslandProblem* const contact = island.contact;
  const double weight = rule.impulse_weight(in.step);
  const auto for_velocities = [&](auto&& f) {
    for (const LinearisedComponent& component : linearised_) {
      for (Index i = component.velocities.begin; i < component.velocities.end; ++i) f(i);
    }
  };
  for_velocities([&](Index i) { update_[i] = weight * (trial.loads_end.total[i] - trial.loads_guess[i]); });
  if (contact != nullptr) contact->map().add_loads(-1.0, update_.data());
  for (const LinearisedComponent& component : linearised_) {
    component.step->solve(update_.data() + component.velocities.begin);
  }
  damping_.keep_impulses(contact);
  if (contact != nullptr) {
    for_velocities([&](Index i) { scratch_[i] = trial.end.v[i] + update_[i]; });
    contact->set_free_velocity(scratch_.data());
    for_velocities([&](Index i) { trial.dv_impulses[i] = 0.0; });
    contact->map().add_loads(1.0, trial.dv_impulses.data());  // H^T P, of the iterate before
    if (!contact->solve(island.chain).usable()) return Outcome::unsolved;
    contact->map().add_velocities(update_.data());
    contact->map().add_loads(-1.0, trial.dv_impulses.data());
  }
  for (const LinearisedComponent& component : linearised_) {
    component.step->apply_mass(update_.data(), scratch_.data());
  }
  for_velocities([&](Index i) {
    if (contact != nullptr) scratch_[i] += trial.dv_impulses[i];
    scratch_[i] = trial.loads_guess[i] + scratch_[i] / weight;
  });
  damping_.apply(in.assembly, island.components, change(in, island.components, trial), scratch_, update_,
                 contact, trial);
  if (contact != nullptr) {
    for_velocities([&](Index i) { trial.dv_impulses[i] = 0.0; });
    MassResponse masses(in.assembly);
    by_masses_.build(contact->directions(), masses);
    by_masses_.add_response(contact->impulses(), trial.dv_impulses.data());
  }
  return Outcome::done;
}

/// Correction d of a component without contact, from w (g - x).
void NewtonIteration::solve(const StepTrial& trial, JointStage* joints,
                            const LinearisedComponent& component) {
  double* const update = update_.data() + component.velocities.begin;
  if (joints == nullptr) return component.step->solve(update);
  JointConstraints& end = joints->rows().at_end();
  residuals_.resize(end.size());
  if (joints->rows().is_mean()) {
    std::fill(residuals_.begin(), residuals_.end(), 0.0);  // the sweep has met the positions
  } else {
    end.residuals(JointLevel::velocity, trial.end.v.data(), residuals_.data());
  }
  component.step->solve(update, residuals_.data());
}

NewtonIteration::Outcome NewtonIteration::step_with_joints(const StepInput& in, const StepRule& rule,
                                                           const NewtonIsland& island, StepTrial& trial) {
  for (const Index component : island.components) {
    JointStage* const joints = island.joints.of(component);
    if (joints != nullptr) joints->rows().place(in, trial);
  }
  // Always anew: with rows that differ from those of the sweep, even by the turn of one sweep, stiff
  // couplings would be loaded across them.
  if (!linearise(in, island, trial.end.view(), trial.at_end)) return Outcome::singular;
  IslandProblem* const contact = island.contact;
  const double weight = rule.impulse_weight(in.step);
  for (std::size_t c = 0; c < linearised_.size(); ++c) {
    const Range v = linearised_[c].velocities;
    JointStage* const joints = island.joints.of(island.components[c]);
    for (Index i = v.begin; i < v.end; ++i) {
      update_[i] = weight * (trial.loads_end.total[i] - trial.loads_guess[i]);
    }
    solve(trial, joints, linearised_[c]);
    for (Index i = v.begin; i < v.end; ++i) scratch_[i] = trial.end.v[i] + update_[i];
    if (contact != nullptr && joints != nullptr && joints->is_struck()) {
      joints->allow_answered(scratch_.data());
    }
  }
  damping_.keep_impulses(contact);
  if (contact != nullptr) {
    LinearisedResponse response(in.assembly, linearised_);
    contact->respond(response);
    contact->set_velocity(scratch_.data());
    contact->map().add_velocities(update_.data(), -1.0);
    if (!contact->solve(island.chain).usable()) return Outcome::unsolved;
    contact->map().add_velocities(update_.data());
  }
  for (const LinearisedComponent& component : linearised_) {
    component.step->apply_mass(update_.data(), scratch_.data());
    component.step->subtract_matrix(update_.data(), scratch_.data());
    const Range v = component.velocities;
    for (Index i = v.begin; i < v.end; ++i) {
      scratch_[i] = trial.loads_end.total[i] + scratch_[i] / weight;
    }
  }
  damping_.apply(in.assembly, island.components, change(in, island.components, trial), scratch_, update_,
                 contact, trial);
  return Outcome::done;
}

/// Brings the rows to the first iterate. Light bodies that swing fast end a step near where they began it,
/// and not where their velocities point to: so bodies are at the start of the step, with its velocities. That
/// is no end of a step: ahead_ is by how much velocities would be larger if they led there.
void NewtonIteration::begin_untouched(const StepInput& in, const StepRule& rule, JointIterate& joints,
                                      StepTrial& trial) {
  const Range v = joints.v(), q = in.assembly.components()[joints.component].q;
  joints.place(in, trial, true);
  const std::vector<double>& impulse = joints.impulse;
  if (std::all_of(impulse.begin(), impulse.end(), [](double number) { return number == 0.0; })) {
    // Without reactions, bodies would be guessed to go wherever rows of the guess push them.
    trial.loads_guess.swap(trial.loads_end.total);
    joints.find_free_velocities(in, rule, trial);
    joints.correct_impulses(in, trial);
    trial.loads_guess.swap(trial.loads_end.total);
  }
  // Near singular positions the rows of the reactions were chosen for where the iteration begins.
  if (joints.rows.reactions() != Reactions::halfway) return;
  std::copy(in.start.q.begin() + q.begin, in.start.q.begin() + q.end, trial.end.q.begin() + q.begin);
  joints.place(in, trial, false);
  for (Index i = v.begin; i < v.end; ++i) ahead_[i] = 2.0 * in.start.v[i];
}

NewtonIteration::Outcome NewtonIteration::sweep_untouched(const StepInput& in, const StepRule& rule,
                                                          JointIterate& joints, StepTrial& trial) {
  const Range v = joints.v();
  ahead_.resize(trial.end.v.size());
  std::fill(ahead_.begin() + v.begin, ahead_.begin() + v.end, 0.0);
  if (trial.account.swept) {
    joints.place(in, trial, false);
  } else {
    begin_untouched(in, rule, joints, trial);
    trial.account.swept = true;
  }
  if (!correct_untouched(in, rule, joints, trial)) return Outcome::singular;
  const double weight = rule.impulse_weight(in.step);
  const ImplicitSolver& matrix = matrices_.front();
  matrix.apply_mass(update_.data(), scratch_.data());
  matrix.subtract_matrix(update_.data(), scratch_.data());
  for (Index i = v.begin; i < v.end; ++i) {
    trial.loads_guess[i] = trial.loads_end.total[i] + scratch_[i] / weight;
  }
  joints.find_free_velocities(in, rule, trial);
  for (Index i = v.begin; i < v.end; ++i) {
    joints.arrays->dv_joints[i] = trial.end.v[i] + update_[i] - trial.free[i];
  }
  joints.move_onto_joints(in, rule, trial);
  return Outcome::done;
}

/// Solves for d, into update_, and corrects L. False if the matrix is singular.
bool NewtonIteration::correct_untouched(const StepInput& in, const StepRule& rule, JointIterate& joints,
                                        StepTrial& trial) {
  const Range v = joints.v();
  turn_.differentiate(in, joints, trial);
  JointConstraints& end = joints.rows.at_end();
  const ImplicitSolver::Border border{end, joints.rows.at_midpoint(), turn_.of_reactions(),
                                      turn_.of_conditions()};
  ImplicitSolver& matrix = matrices_.front();
  const auto outcome =
      matrix.factor(in.assembly, joints.component, trial.end.view(), trial.at_end, in.step, &border);
  if (outcome == ImplicitSolver::Outcome::singular) return false;
  const double weight = rule.impulse_weight(in.step), half = 0.5 * in.step;
  joints.find_free_velocities(in, rule, trial);
  joints.find_reactions();
  for (Index i = v.begin; i < v.end; ++i) {
    scratch_[i] = trial.free[i] + joints.arrays->dv_joints[i] - trial.end.v[i];
  }
  matrix.apply_mass(scratch_.data(), update_.data());
  for (Index i = v.begin; i < v.end; ++i) {
    update_[i] += weight * (trial.loads_end.total[i] - trial.loads_guess[i]);
  }
  for (const MatrixNumber& of : turn_.of_reactions()) update_[of.row] += of.number * ahead_[of.column];
  residuals_.resize(end.size());
  multipliers_.resize(end.size());
  if (joints.rows.is_mean()) {
    for (Index i = v.begin; i < v.end; ++i) scratch_[i] = half * ahead_[i];
    end.residuals(JointLevel::displacement, scratch_.data(), residuals_.data());
    for (double& gap : residuals_) gap /= half;
  } else {
    end.residuals(JointLevel::velocity, trial.end.v.data(), residuals_.data());
  }
  for (const MatrixNumber& of : turn_.of_conditions()) residuals_[of.row] += of.number * ahead_[of.column];
  matrix.solve(update_.data() + v.begin, residuals_.data(), multipliers_.data());
  for (std::size_t row = 0; row < end.size(); ++row) joints.impulse[row] += multipliers_[row];
  return true;
}

SweepChange NewtonIteration::change(const StepInput& in, std::span<const Index> components,
                                    const StepTrial& trial) const {
  SweepChange largest;
  for (const Index component : components) largest.take(change(in, component, trial));
  return largest;
}

SweepChange NewtonIteration::change(const StepInput& in, Index component, const StepTrial& trial) const {
  SweepChange change;
  in.assembly.for_bodies(component, [&](const BodyKind& kind, Range slots, Index q, Index v, Index) {
    const Index size = kind.v_size();
    for (Index slot = slots.begin; slot < slots.end; ++slot, q += kind.q_size(), v += size) {
      for (Index i = 0; i < size; ++i) {
        const double length = kind.length_scale(slot, i);
        change.take(in.step * update_[v + i] * length, in.step * trial.end.v[v + i] * length);
      }
      for (Index i = 0; i < kind.q_size(); ++i) change.take(0.0, trial.end.q[q + i]);
    }
  });
  return change;
}

void NewtonIteration::note_contraction(int sweeps, double contraction) {
  // Newton's method contracts ever faster; with a frozen matrix by a steady ratio. Beyond this one a fresh
  // matrix is cheaper than more sweeps.
  constexpr double slow = 0.1;
  stale_ = sweeps > 1 && contraction > slow;
}

}  // namespace carom
