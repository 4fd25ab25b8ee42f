#include <carom/integrators/time_stepping/coupling_watch.h>

namespace carom {

void CouplingWatch::rate(const StepInput& in, Index component, double contraction, StepTrial& trial,
                         StepReport& report) {
  constexpr double worsening = 2.0;
  if (contraction_[component] < 0.0 || contraction > worsening * contraction_[component]) {
    evaluate_positions(in.assembly, component, in.start.view(), trial.at_end);
    ratings_[component] = rate_couplings(in.assembly, component, in.start.view(), trial.at_end, in.step);
    contraction_[component] = contraction;
  }
  if (!(ratings_[component].rate > report.worst_coupling_rate)) return;
  report.worst_coupling = ratings_[component].worst;
  report.worst_coupling_rate = ratings_[component].rate;
}

}  // namespace carom
