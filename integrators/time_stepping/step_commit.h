#pragma once

/// \file
/// Parts of taking a step over: from the trial to the state, from the report to the statistics.

#include <carom/integrators/run/companion.h>
#include <carom/integrators/run/step_report.h>
#include <carom/integrators/time_stepping/step_input.h>
#include <carom/integrators/time_stepping/step_trial.h>

#include <algorithm>
#include <cstddef>
#include <utility>

namespace carom {

/// Loss by the discretisation of couplings: minus what potentials have changed by beyond the works that
/// acted. \param potential at the end \param before at the start \param work of couplings [J]
[[nodiscard]] inline double discretisation_loss(double potential, double before, double work) {
  return -(potential - before + work);
}

/// Makes the end of a step the state, with what rounding cut off. \param mean loads are mean loads of the
/// step
inline void take_end(const StepInput& in, bool mean, StepTrial& trial, State& state, Companion& companion) {
  const double step = in.step, end_time = in.end_time;
  std::swap(state.q, trial.end.q);
  std::swap(state.v, trial.end.v);
  if (!state.z.empty()) std::swap(state.z, trial.end.z);
  state.time = end_time;
  companion.loads.valid = true;
  companion.loads.mean = mean;
  companion.history.step = step;
  std::swap(companion.rounding, trial.rounding);
}

/// Counts a step.
inline void count_step(const StepNumbers& made, Statistics& statistics) {
  ++statistics.steps;
  statistics.sweeps += made.sweeps;
  ++statistics.steps_by_iteration[static_cast<std::size_t>(made.iteration)];
  statistics.fallbacks += made.fallbacks;
  statistics.most_sweeps = std::max(statistics.most_sweeps, made.sweeps);
  statistics.largest_contraction = std::max(statistics.largest_contraction, made.contraction);
  if (made.energy_gain > made.lasting_gain) {
    ++statistics.energy_gains;
    statistics.energy_gained += made.energy_gain - made.lasting_gain;
  }
  if (made.lasting_gain > 0.0) {
    ++statistics.lasting_gains;
    statistics.lasting_gained += made.lasting_gain;
  }
}

}  // namespace carom
