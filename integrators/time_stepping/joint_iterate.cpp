// Problem: velocities and positions that obey the joints to rounding, one step of Newton's method at a time.

#include <carom/core/numerics/largest_of.h>
#include <carom/integrators/time_stepping/joint_iterate.h>

#include <algorithm>
#include <cmath>

namespace carom {

JointArrays::JointArrays(const Assembly& assembly) : lengths(assembly.length_scales()) {
  for (std::vector<double>* const numbers :
       {&dv_joints, &dv_contact, &displacement, &scratch, &before_v, &allowed}) {
    numbers->resize(assembly.layout()->v_size());
  }
  before_q.resize(assembly.layout()->q_size());
}

JointIterate::JointIterate(const Assembly& model, Index which, JointArrays& shared)
    : assembly(&model),
      component(which),
      arrays(&shared),
      rows(model, which),
      impulse(rows.at_end().size()),
      left(impulse),
      sizes(impulse) {}

void JointIterate::clear(std::vector<double>& numbers) const {
  std::fill(numbers.begin() + v().begin, numbers.begin() + v().end, 0.0);
}

void JointIterate::find_free_velocities(const StepInput& in, const StepRule& rule, StepTrial& trial) const {
  const Range v = this->v();
  const double half = 0.5 * in.step;
  const double* const load0 = rule.start_of_sum(in, trial);
  for (Index i = v.begin; i < v.end; ++i) trial.free[i] = half * (load0[i] + trial.loads_guess[i]);
  rows.at_end().apply_inverse_mass(trial.free.data());
  for (Index i = v.begin; i < v.end; ++i) {
    trial.free[i] += static_cast<double>(in.companion.rounding[i]) + in.start.v[i];
  }
}

/// With G1 on both sides, instead of Gm on one, the matrix is symmetric and its range is that of G1, where
/// rows depend on each other too.
void JointIterate::correct_impulses(const StepInput& in, const StepTrial& trial) {
  const Range v = this->v();
  std::vector<double>& sum = arrays->scratch;
  for (Index i = v.begin; i < v.end; ++i) {
    sum[i] = trial.free[i] + arrays->dv_joints[i] + arrays->dv_contact[i];
  }
  if (rows.is_mean()) {
    // Gaps are those of the velocities of the iterate before.
    const double half = 0.5 * in.step;
    for (Index i = v.begin; i < v.end; ++i) sum[i] = half * (sum[i] - arrays->before_v[i]);
    rows.at_end().residuals(JointLevel::displacement, sum.data(), left.data());
    for (double& gap : left) gap /= half;
  } else {
    rows.at_end().residuals(JointLevel::velocity, sum.data(), left.data());
  }
  rows.solve(left);
  for (std::size_t row = 0; row < left.size(); ++row) impulse[row] += left[row];
  find_reactions();
}

void JointIterate::find_reactions() {
  clear(arrays->dv_joints);
  rows.at_midpoint().add_transposed(impulse.data(), arrays->dv_joints.data());
  rows.at_end().apply_inverse_mass(arrays->dv_joints.data());
}

void JointIterate::move_bodies(const StepInput& in, const StepRule& rule, StepTrial& trial) const {
  const Component& all = assembly->components()[component];
  for (Index i = all.v.begin; i < all.v.end; ++i) {
    trial.dv_impulses[i] = arrays->dv_joints[i] + arrays->dv_contact[i];
  }
  rule.move(in, all.bodies, true, trial);
}

void JointIterate::place(const StepInput& in, StepTrial& trial, bool first) {
  const Range q = assembly->components()[component].q, v = this->v();
  std::copy(trial.end.q.begin() + q.begin, trial.end.q.begin() + q.end, arrays->before_q.begin() + q.begin);
  std::copy(trial.end.v.begin() + v.begin, trial.end.v.begin() + v.end, arrays->before_v.begin() + v.begin);
  rows.place(in, trial);
  // Choosing factors the rows at the end.
  if (first) rows.choose(in, trial, left);
  if (!first || rows.reactions() == Reactions::mixed) rows.factor();
}

void JointIterate::react(const StepInput& in, const StepRule& rule, StepTrial& trial) {
  place(in, trial, !trial.account.swept);
  find_free_velocities(in, rule, trial);
  correct_impulses(in, trial);
}

/// One step of Newton's method for g(q_{j+1}, t_{j+1}) = 0 from the displacement of the sweep before. All of
/// the displacement is made anew along the rows of this sweep, so that it does not depend on how the
/// iteration went.
void JointIterate::return_to_joints(const StepInput& in, StepTrial& trial) {
  displace(arrays->displacement, trial.end);
  if (rows.reactions() != Reactions::halfway) return return_near_singular(in, trial);
  const Range v = this->v();
  rows.place_gaps(in, trial);
  for (Index i = v.begin; i < v.end; ++i) arrays->scratch[i] = -arrays->displacement[i];
  rows.at_end().residuals(JointLevel::displacement, arrays->scratch.data(), left.data());
  rows.add_displacement(left, arrays->scratch);
  for (Index i = v.begin; i < v.end; ++i) arrays->displacement[i] += arrays->scratch[i];
  displace(arrays->scratch, trial.end);
}

/// Several steps with rows of their own, which change much from one iterate to the next there.
void JointIterate::return_near_singular(const StepInput& in, StepTrial& trial) {
  constexpr int turns = 6;
  const Range v = this->v();
  for (int turn = 0; turn < turns; ++turn) {
    rows.place_end(in, trial);
    rows.factor();
    for (std::size_t row = 0; row < left.size(); ++row) left[row] = rows.at_end().gaps()[row];
    clear(arrays->scratch);
    rows.add_displacement(left, arrays->scratch);
    for (Index i = v.begin; i < v.end; ++i) arrays->displacement[i] += arrays->scratch[i];
    displace(arrays->scratch, trial.end);
  }
}

void JointIterate::move_onto_joints(const StepInput& in, const StepRule& rule, StepTrial& trial) {
  move_bodies(in, rule, trial);
  if (!rows.is_mean()) return_to_joints(in, trial);
}

void JointIterate::displace(const std::vector<double>& by, State& state) const {
  assembly->for_bodies(component, [&](const BodyKind& kind, Range slots, Index q, Index v, Index) {
    kind.advance(slots, state.q.data() + q, by.data() + v, state.q.data() + q);
  });
}

JointViolation JointIterate::violation(const State& end) {
  const JointConstraints& at_end = rows.at_end();
  const Range q = assembly->components()[component].q;
  const double extent = largest_of(q, [&](auto at) { return magnitude(at(end.q.data())); });
  const Range all{0, static_cast<Index>(left.size())};
  const double gap = largest_of(all, [&](auto at) { return magnitude(at(at_end.gaps().data())); });
  double largest = 0.0;
  if (!rows.is_mean()) {
    at_end.residuals_and_sizes(end.v.data(), left.data(), sizes.data());
    largest = largest_of(all, [&](auto at) {  // none where a row is made of zeros
      return magnitude(at(left.data())) / at(sizes.data());
    });
  }
  return {largest / rounding, extent > 0.0 ? gap / extent / rounding : 0.0};
}

double JointIterate::largest_displacement() const {
  return largest_of(v(), [this](auto at) {
    return at(arrays->lengths.data()) * magnitude(at(arrays->displacement.data()));
  });
}

double JointIterate::work(const StepTrial& trial) {
  const Range v = this->v();
  std::vector<double>& masses = arrays->scratch;
  std::fill(masses.begin() + v.begin, masses.begin() + v.end, 1.0);
  rows.at_end().apply_inverse_mass(masses.data());
  double sum = 0.0;
  for (Index i = v.begin; i < v.end; ++i) sum += trial.midpoint.v[i] * (arrays->dv_joints[i] / masses[i]);
  return sum;
}

}  // namespace carom
