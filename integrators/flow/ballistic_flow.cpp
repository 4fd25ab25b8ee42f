// Problem: dq/dt = v, dv/dt = a constant, between the events of bodies in free flight, which are most of the
// motion of many: a method of integration would find the same parabola at the cost of its stages.

#include <carom/integrators/flow/ballistic_flow.h>

#include <algorithm>

namespace carom {

void BallisticFlow::advance(double longest) {
  begin_step(longest);
  start_.swap(state_);
  const double end = begin_ + longest;
  reach(end, state_);
  accept(end, longest);
}

void BallisticFlow::reach(double time, std::span<double> y) {
  const double dt = time - begin_;
  const double* const rates = stage(0);
  for (std::size_t i = 0; i < integrals_; ++i) {
    y[i] = start_[i] + dt * (rates[i] + 0.5 * dt * rates[integrals_ + i]);
  }
  for (std::size_t i = integrals_; i < y.size(); ++i) y[i] = start_[i] + dt * rates[i];
}

void BallisticFlow::carry_rates() { std::copy_n(state_.data() + integrals_, integrals_, stage(0)); }

}  // namespace carom
