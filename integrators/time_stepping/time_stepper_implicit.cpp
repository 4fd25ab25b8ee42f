// Problem: guess the loads at the end of a step better than by those of the iterate before (Anderson's
// acceleration, Newton's method with contact).

#include <carom/integrators/time_stepping/time_stepper.h>

#include <algorithm>
#include <optional>

namespace carom {

void TimeStepper::improve_guess(Index island, const FixedPointJudge& judge) {
  const Range v = assembly_->islands()[island].v;
  if (iteration_ == Iteration::fixed_point) {
    if (assembly_->islands().size() == 1) {
      evaluation_.force.swap(evaluated_);
      return;
    }
    for_blocks(island, [this](const Block& block, Index) { improve_guess(block); });
    return;
  }
  if (iteration_ == Iteration::anderson) {
    const auto part = [&](std::vector<double>& numbers) {
      return std::span<double>(numbers.data() + v.begin, v.size());
    };
    anderson_.next(part(evaluation_.force), part(evaluated_), part(weights_));
    return;
  }
  // Newton's method contracts ever faster; with a frozen matrix by a steady ratio. Beyond this one a fresh
  // matrix is cheaper than more sweeps.
  constexpr double slow = 0.1;
  stale_ = judge.sweeps() > 1 && judge.contraction() > slow;
}

void TimeStepper::improve_guess(const Block& block) {
  std::copy(evaluated_.begin() + block.v.begin, evaluated_.begin() + block.v.end,
            evaluation_.force.begin() + block.v.begin);
}

/// The first guess of Newton's method: loads that would leave the velocities as they are, to be corrected by
/// the loads at the start as they grow with the motion.
void TimeStepper::start_implicit(Index island, const State& state, const Companion& companion, double step) {
  const Range v = assembly_->islands()[island].v;
  const Range q = assembly_->islands()[island].q;
  if (!jointed(island)) {
    std::copy(state.q.begin() + q.begin, state.q.begin() + q.end, trial_.q.begin() + q.begin);
    std::copy(state.v.begin() + v.begin, state.v.begin() + v.end, trial_.v.begin() + v.begin);
  }
  evaluate_loads(*assembly_, island, state.view(), start_,
                 {evaluated_.data(), evaluated_.data(), evaluated_.data()});
  for (Index i = v.begin; i < v.end; ++i) {
    evaluation_.force[i] = mean_rule() ? 0.0 : -companion.loads.total[i];
  }
  for (std::size_t i = 0; i < clusters_in_use_; ++i) clusters_[i].forget_impulses();
  if (jointed(island)) place_joints(island, state, step);
  linearise(island, state.view(), start_, state, step);
  implicit_.add_stiffness_times(mean_rule() ? 0.5 * step : step, state.v.data(), evaluated_.data());
  stale_ = false;
}

void TimeStepper::linearise(Index island, const StateView& at, const Evaluation& evaluation,
                            const State& state, double step) {
  std::optional<ImplicitSolver::Border> joints;
  if (jointed(island)) joints.emplace(ImplicitSolver::Border{joints_[island].end, joints_[island].mean});
  const auto outcome = implicit_.factor(*assembly_, island, at, evaluation, step, joints ? &*joints : nullptr,
                                        clusters_in_use_ > 0);
  if (outcome == ImplicitSolver::Outcome::singular) {
    fail_linearisation(island, state, step, "is singular");
  }
  if (clusters_in_use_ == 0) return;
  if (jointed(island)) return;  // coupled anew by every sweep
  clusters_.front().couple(assembly_->islands()[island].v, [this](double* x) { implicit_.solve(x); });
}

/// One step of Newton's method from the iterate (trial velocities, impulses P, guess x, loads g that they
/// lead to):  A d = w (g - x) + H^T (P' - P),  P' from the contact problem with W = H A^-1 H^T, and the guess
/// that leads to the new velocities,  x' = x + (M d - H^T (P' - P)) / w.
void TimeStepper::solve_implicit(Index island, const State& state, double step) {
  const Range v = assembly_->islands()[island].v;
  if (stale_) linearise(island, trial_.view(), evaluation_, state, step);
  const double weight = impulse_weight(step);
  for (Index i = v.begin; i < v.end; ++i) update_[i] = weight * (evaluated_[i] - evaluation_.force[i]);
  if (clusters_in_use_ > 0) {
    ContactCluster& cluster = clusters_.front();
    cluster.add_loads(-1.0, update_.data());
    implicit_.solve(update_.data() + v.begin);
    for (Index i = v.begin; i < v.end; ++i) free_[i] = trial_.v[i] + update_[i];
    cluster.set_free_velocity(free_.data());
    std::fill(response_.begin() + v.begin, response_.begin() + v.end, 0.0);
    cluster.add_loads(1.0 / weight, response_.data());  // H^T P / w, of the iterate before
    if (!cluster.solve(chains_.front()).usable()) fail_contact(island, cluster, state, step);
    cluster.apply_coupled(update_.data());
    cluster.add_loads(-1.0 / weight, response_.data());
    for (Index i = v.begin; i < v.end; ++i) {
      evaluation_.force[i] += response_[i];
      response_[i] = 0.0;
    }
    cluster.apply(response_.data());
  } else {
    implicit_.solve(update_.data() + v.begin);
  }
  implicit_.apply_mass(update_.data(), free_.data());
  for (Index i = v.begin; i < v.end; ++i) evaluation_.force[i] += free_[i] / weight;
}

/// The same step where joints bind bodies,  A d - Gm^T l = w (g - x) + H^T (P' - P),  G (v + d) + rate = 0,
/// for the guess alone,  x' = g + (M - A) d / w,  which the sweep behind it takes as it takes any other.
void TimeStepper::guess_implicit(Index island, const State& state, double step) {
  const Range v = assembly_->islands()[island].v;
  JointWork& work = joints_[island];
  place_joints(island, state, step);
  // Always anew: with rows that differ from those of the sweep, even by the turn of one sweep, stiff
  // couplings would be loaded across them.
  linearise(island, trial_.view(), evaluation_, state, step);
  const double weight = impulse_weight(step);
  for (Index i = v.begin; i < v.end; ++i) update_[i] = weight * (evaluated_[i] - evaluation_.force[i]);
  work.end.residuals(JointLevel::velocity, trial_.v.data(), work.left.data());
  implicit_.solve(update_.data() + v.begin, work.left.data());
  if (clusters_in_use_ > 0) {
    ContactCluster& cluster = clusters_.front();
    for (Index i = v.begin; i < v.end; ++i) scratch_[i] = trial_.v[i] + update_[i];
    const auto solve = [this](double* x) { implicit_.solve(x); };
    if (work.struck) {
      cluster.couple(work.start);
      cluster.couple_again(
          [this, v](const double* x, double* p) { implicit_.apply_mass(x - v.begin, p - v.begin); }, solve);
      allow_at_start(work, scratch_.data());
    } else {
      cluster.couple(v, solve);
    }
    cluster.set_velocity(scratch_.data());
    cluster.apply_coupled(update_.data(), -1.0);
    if (!cluster.solve(chains_.front()).usable()) fail_contact(island, cluster, state, step);
    cluster.apply_coupled(update_.data());
  }
  implicit_.apply_mass(update_.data(), scratch_.data());
  implicit_.subtract_matrix(update_.data(), scratch_.data());
  for (Index i = v.begin; i < v.end; ++i) evaluation_.force[i] = evaluated_[i] + scratch_[i] / weight;
}

/// What the last step of Newton's method changed.
SweepChange TimeStepper::implicit_change(Index island, double step) const {
  SweepChange change;
  assembly_->for_bodies(island, [&](const BodyKind& kind, Range slots, Index q, Index v, Index) {
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
