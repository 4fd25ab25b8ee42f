// Problem: what the joints will do in a step, by what they did in the last ones.

#include <carom/integrators/run/joint_history.h>

#include <algorithm>

namespace carom {

const std::vector<double>& StepCourse::numbers(std::size_t ago) const {
  return steps_[(newest_ + ago) % most_extrapolated];
}

std::vector<double>& StepCourse::numbers(std::size_t ago) {
  return steps_[(newest_ + ago) % most_extrapolated];
}

void StepCourse::go_on(std::size_t size) {
  newest_ = (newest_ + most_extrapolated - 1) % most_extrapolated;
  if (steps_[newest_].size() == size) return;
  for (std::vector<double>& numbers : steps_) numbers.assign(size, 0.0);
}

void StepCourse::record(Range range, const double* numbers) {
  std::copy(numbers + range.begin, numbers + range.end, steps_[newest_].begin() + range.begin);
}

void StepCourse::guess(Range range, std::size_t steps, double* out) const {
  LastNumbers last{};
  for (std::size_t ago = 0; ago < most_extrapolated; ++ago) last[ago] = numbers(ago).data();
  extrapolate(range, last, steps, out);
}

void JointHistory::go_on(double next_step, std::size_t components, std::size_t rows, std::size_t size) {
  if (step != next_step) clear();
  step = next_step;
  known.resize(components, 0);
  impulses.go_on(rows);
  velocities.go_on(size);
  displacements.go_on(size);
}

}  // namespace carom
