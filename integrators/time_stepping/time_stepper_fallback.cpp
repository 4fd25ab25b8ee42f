// Problem: end a step by another iteration where the fixed-point iteration fails, and say so.

#include <carom/integrators/time_stepping/time_stepper.h>

#include <cstddef>

namespace carom {

/// Memory of an iteration, when it is first needed.
void TimeStepper::set_iteration(Iteration iteration) {
  iteration_ = iteration;
  const std::size_t size = trial_.v.size();
  if (iteration == Iteration::linearly_implicit) {
    update_.resize(size);
    free_.resize(size);
  }
  if (iteration != Iteration::anderson || weights_.size() == size) return;
  const std::vector<double> ones(size, 1.0);
  weights_.resize(size);
  for (Index component = 0; component < assembly_->components().size(); ++component) {
    assembly_->for_bodies(component, [&](const BodyKind& kind, Range slots, Index, Index v, Index) {
      kind.apply_inverse_mass(slots, ones.data() + v, weights_.data() + v);
    });
  }
  const std::vector<double> lengths = assembly_->length_scales();
  for (std::size_t i = 0; i < size; ++i) weights_[i] *= lengths[i];
}

bool TimeStepper::attempt(Iteration iteration, Index component, const State& state,
                          const Companion& companion, double step, FixedPointJudge& judge) {
  set_iteration(iteration);
  find_contacts(component, state);  // in the problems that the iteration asks for, without their last answers
  judge = FixedPointJudge(options_.tolerance, options_.max_sweeps);
  tentative_ = true;
  bool converged = false;
  try {
    converged = iterate(component, state, companion, step, judge);
  } catch (const SolverError&) {
    // Iterates that grow may meet a contact problem without an answer, or loads that are not finite.
  }
  tentative_ = false;
  return converged;
}

void TimeStepper::iterate_somehow(Index component, const State& state, const Companion& companion,
                                  double step, FixedPointJudge& judge) {
  const auto first = static_cast<std::size_t>(companion.iterations.first(component));
  // Each next one is stronger than the one before; behind the last the first is as good as another.
  std::size_t tried = 0;
  while (!attempt(static_cast<Iteration>((first + tried) % iteration_count), component, state, companion,
                  step, judge)) {
    if (++tried == iteration_count) fail_all_iterations(component, state, companion, step);
    ++report_.fallbacks;
  }
  iterations_.record(companion.iterations, component, iteration_);
}

/// The fixed-point iteration once more, for what there is to be said about its failure.
void TimeStepper::fail_all_iterations(Index component, const State& state, const Companion& companion,
                                      double step) {
  set_iteration(Iteration::fixed_point);
  find_contacts(component, state);
  FixedPointJudge judge(options_.tolerance, options_.max_sweeps);
  static_cast<void>(iterate(component, state, companion, step, judge));
  fail_contraction(component, state, companion, step, judge);
}

}  // namespace carom
