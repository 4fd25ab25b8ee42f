#include <carom/integrators/run/step_report.h>

#include <cstddef>

namespace carom {

void ContactCounts::count_step(double residual) {
  std::size_t place = 0;
  while (place < certified_residuals.size() && residual > certified_residuals[place]) ++place;
  ++certified_steps[place];
}

double ContactCounts::certified_share(double residual) const {
  std::int64_t all = 0, certified = 0;
  for (std::size_t i = 0; i < certified_steps.size(); ++i) {
    all += certified_steps[i];
    if (i < certified_residuals.size() && certified_residuals[i] <= residual) certified += certified_steps[i];
  }
  return all > 0 ? static_cast<double>(certified) / static_cast<double>(all) : 1.0;
}

}  // namespace carom
