#include <carom/integrators/time_stepping/coupling_watch.h>

#include <algorithm>

namespace carom {

namespace {

CouplingRating rate_at_start(const StepInput& in, Index component, StepTrial& trial) {
  evaluate_positions(in.assembly, component, in.start.view(), trial.at_end);
  return rate_couplings(in.assembly, component, in.start.view(), trial.at_end, in.step);
}

}  // namespace

bool leads_astray(Iteration iteration, const StepInput& in, std::span<const Index> components,
                  StepTrial& trial) {
  constexpr double largest_rate = 20.0;  // sweeps contract below 1
  if (iteration != Iteration::anderson) return false;
  if (components.size() > 1) return true;
  return std::any_of(components.begin(), components.end(), [&](Index component) {
    return rate_at_start(in, component, trial).rate > largest_rate;
  });
}

void CouplingWatch::rate(const StepInput& in, Index component, double contraction, StepTrial& trial,
                         StepReport& report) {
  constexpr double worsening = 2.0;
  if (contraction_[component] < 0.0 || contraction > worsening * contraction_[component]) {
    ratings_[component] = rate_at_start(in, component, trial);
    contraction_[component] = contraction;
  }
  if (!(ratings_[component].rate > report.worst_coupling_rate)) return;
  report.worst_coupling = ratings_[component].worst;
  report.worst_coupling_rate = ratings_[component].rate;
}

}  // namespace carom
