// Problem: how far is the end of a pass from where all further ones would lead?

#include <carom/integrators/time_stepping/pass_convergence.h>

#include <algorithm>
#include <cmath>

namespace carom {

namespace {

constexpr int most_passes = 20;
// Of velocities: changes as small as this are rounding.
constexpr double relative_rounding = 1e-14;

}  // namespace

void PassConvergence::begin() {
  passes_ = 0;
  change_ = std::numeric_limits<double>::infinity();
  contraction_ = 0.0;
}

void PassConvergence::begin_at(const std::vector<double>& velocities) {
  begin();
  last_.assign(velocities.begin(), velocities.end());
  passes_ = 1;
}

bool PassConvergence::has_converged(const StepTrial& trial, double tolerance, double residual) {
  const std::vector<double>& v = trial.end.v;
  double size = 0.0;
  for (std::size_t i = 0; i < v.size(); ++i) size = std::max(size, lengths_[i] * std::abs(v[i]));
  // At rest velocities are rounding of those that impulses take away.
  for (std::size_t i = 0; i < trial.dv_impulses.size(); ++i)
    size = std::max(size, lengths_[i] * std::abs(trial.dv_impulses[i]));
  noise_ = relative_rounding * size;
  if (passes_ > 0) {
    double change = 0.0;
    for (std::size_t i = 0; i < v.size(); ++i)
      change = std::max(change, lengths_[i] * std::abs(v[i] - last_[i]));
    if (change <= std::max(noise_, residual * size) || !(change < change_) || passes_ == most_passes)
      return true;
    // Changes of further passes are a geometric series.
    if (passes_ > 1) contraction_ = std::max(contraction_, change / change_);
    const double left = passes_ > 1 ? change * contraction_ / (1.0 - contraction_) : change;
    if (left <= tolerance) return true;
    change_ = change;
  }
  last_.assign(v.begin(), v.end());
  ++passes_;
  return false;
}

}  // namespace carom
