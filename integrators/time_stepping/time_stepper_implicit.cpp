// Problem: guess the loads at the end of a step better than by those of the iterate before (Anderson's
// acceleration, Newton's method with contact).

#include <carom/integrators/time_stepping/time_stepper.h>

#include <algorithm>
#include <optional>

namespace carom {

void TimeStepper::improve_guess(Index component, const FixedPointJudge& judge) {
  const Range v = assembly_->components()[component].v;
  if (iteration_ == Iteration::fixed_point) {
    if (assembly_->components().size() == 1) {
      evaluation_.force.swap(loads_end_);
      return;
    }
    for_blocks(component, [this](const Block& block, Index) { improve_guess(block); });
    return;
  }
  if (iteration_ == Iteration::anderson) {
    const auto part = [&](std::vector<double>& numbers) {
      return std::span<double>(numbers.data() + v.begin, v.size());
    };
    anderson_.next(part(evaluation_.force), part(loads_end_), part(weights_));
    return;
  }
  // Newton's method contracts ever faster; with a frozen matrix by a steady ratio. Beyond this one a fresh
  // matrix is cheaper than more sweeps.
  constexpr double slow = 0.1;
  stale_ = judge.sweeps() > 1 && judge.contraction() > slow;
}

void TimeStepper::improve_guess(const Block& block) {
  std::copy(loads_end_.begin() + block.v.begin, loads_end_.begin() + block.v.end,
            evaluation_.force.begin() + block.v.begin);
}

/// The first guess of Newton's method: loads that would leave the velocities as they are, to be corrected by
/// the loads at the start as they grow with the motion.
void TimeStepper::start_implicit(Index component, const State& state, const Companion& companion,
                                 double step) {
  const Range v = assembly_->components()[component].v;
  const Range q = assembly_->components()[component].q;
  if (!jointed(component)) {
    std::copy(state.q.begin() + q.begin, state.q.begin() + q.end, trial_.q.begin() + q.begin);
    std::copy(state.v.begin() + v.begin, state.v.begin() + v.end, trial_.v.begin() + v.begin);
  }
  evaluate_loads(*assembly_, component, state.view(), start_,
                 {loads_end_.data(), loads_end_.data(), loads_end_.data()});
  for (Index i = v.begin; i < v.end; ++i) {
    evaluation_.force[i] = mean_rule() ? 0.0 : -companion.loads.total[i];
  }
  for (std::size_t i = 0; i < clusters_in_use_; ++i) clusters_[i].forget_impulses();
  if (jointed(component)) place_joints(component, state, step);
  linearise(component, state.view(), start_, state, step);
  implicit_.add_stiffness_times(mean_rule() ? 0.5 * step : step, state.v.data(), loads_end_.data());
  stale_ = false;
}

void TimeStepper::linearise(Index component, const StateView& at, const Evaluation& evaluation,
                            const State& state, double step) {
  std::optional<ImplicitSolver::Border> joints;
  if (jointed(component))
    joints.emplace(ImplicitSolver::Border{joints_[component].end, joints_[component].mean});
  const auto outcome = implicit_.factor(*assembly_, component, at, evaluation, step,
                                        joints ? &*joints : nullptr, clusters_in_use_ > 0);
  if (outcome == ImplicitSolver::Outcome::singular) {
    fail_linearisation(component, state, step, "is singular");
  }
  if (clusters_in_use_ == 0) return;
  if (jointed(component)) return;  // coupled anew by every sweep
  LinearisedResponse response(implicit_, assembly_->components()[component].v);
  clusters_.front().respond(response);
}

/// One step of Newton's method from the iterate (trial velocities, impulses P, guess x, loads g that they
/// lead to):  A d = w (g - x) + H^T (P' - P),  P' from the contact problem with W = H A^-1 H^T, and the guess
/// that leads to the new velocities,  x' = x + (M d - H^T (P' - P)) / w.
void TimeStepper::solve_implicit(Index component, const State& state, double step) {
  const Range v = assembly_->components()[component].v;
  if (stale_) linearise(component, trial_.view(), evaluation_, state, step);
  const double weight = impulse_weight(step);
  for (Index i = v.begin; i < v.end; ++i) update_[i] = weight * (loads_end_[i] - evaluation_.force[i]);
  if (clusters_in_use_ > 0) {
    IslandProblem& cluster = clusters_.front();
    cluster.map().add_loads(-1.0, update_.data());
    implicit_.solve(update_.data() + v.begin);
    for (Index i = v.begin; i < v.end; ++i) free_[i] = trial_.v[i] + update_[i];
    cluster.set_free_velocity(free_.data());
    std::fill(dv_impulses_.begin() + v.begin, dv_impulses_.begin() + v.end, 0.0);
    cluster.map().add_loads(1.0 / weight, dv_impulses_.data());  // H^T P / w, of the iterate before
    if (!cluster.solve(chains_.front()).usable()) fail_contact(component, cluster, state, step);
    cluster.map().add_velocities(update_.data());
    cluster.map().add_loads(-1.0 / weight, dv_impulses_.data());
    for (Index i = v.begin; i < v.end; ++i) {
      evaluation_.force[i] += dv_impulses_[i];
      dv_impulses_[i] = 0.0;
    }
    MassResponse masses(*assembly_);
    std::vector<ImpulseDirection> dirs;
    for (const Constraint& c : cluster.constraints())
      for (int i = 0; i < c.rows; ++i) dirs.push_back({&c, i});
    Delassus d;
    d.build(dirs, masses);
    d.add_response(cluster.impulses(), dv_impulses_.data());
  } else {
    implicit_.solve(update_.data() + v.begin);
  }
  implicit_.apply_mass(update_.data(), free_.data());
  for (Index i = v.begin; i < v.end; ++i) evaluation_.force[i] += free_[i] / weight;
}

/// The same step where joints bind bodies,  A d - Gm^T l = w (g - x) + H^T (P' - P),  G (v + d) + rate = 0,
/// for the guess alone,  x' = g + (M - A) d / w,  which the sweep behind it takes as it takes any other.
void TimeStepper::guess_implicit(Index component, const State& state, double step) {
  const Range v = assembly_->components()[component].v;
  JointWork& work = joints_[component];
  place_joints(component, state, step);
  // Always anew: with rows that differ from those of the sweep, even by the turn of one sweep, stiff
  // couplings would be loaded across them.
  linearise(component, trial_.view(), evaluation_, state, step);
  const double weight = impulse_weight(step);
  for (Index i = v.begin; i < v.end; ++i) update_[i] = weight * (loads_end_[i] - evaluation_.force[i]);
  work.end.residuals(JointLevel::velocity, trial_.v.data(), work.left.data());
  implicit_.solve(update_.data() + v.begin, work.left.data());
  if (clusters_in_use_ > 0) {
    IslandProblem& cluster = clusters_.front();
    for (Index i = v.begin; i < v.end; ++i) scratch_[i] = trial_.v[i] + update_[i];
    LinearisedResponse response(implicit_, v, work.struck ? &work.start : nullptr);
    cluster.respond(response);
    if (work.struck) allow_at_start(work, scratch_.data());
    cluster.set_velocity(scratch_.data());
    cluster.map().add_velocities(update_.data(), -1.0);
    if (!cluster.solve(chains_.front()).usable()) fail_contact(component, cluster, state, step);
    cluster.map().add_velocities(update_.data());
  }
  implicit_.apply_mass(update_.data(), scratch_.data());
  implicit_.subtract_matrix(update_.data(), scratch_.data());
  for (Index i = v.begin; i < v.end; ++i) evaluation_.force[i] = loads_end_[i] + scratch_[i] / weight;
}

/// What the last step of Newton's method changed.
SweepChange TimeStepper::implicit_change(Index component, double step) const {
  SweepChange change;
  assembly_->for_bodies(component, [&](const BodyKind& kind, Range slots, Index q, Index v, Index) {
    const Index size = kind.v_size();
    for (Index slot = slots.begin; slot < slots.end; ++slot, q += kind.q_size(), v += size) {
      for (Index i = 0; i < size; ++i) {
        const double length = kind.length_scale(slot, i);
        change.take(step * update_[v + i] * length, step * trial_.v[v + i] * length);
      }
      for (Index i = 0; i < kind.q_size(); ++i) change.take(0.0, trial_.q[q + i]);
    }
  });
  return change;
}

}  // namespace carom
