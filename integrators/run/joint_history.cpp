// Problem: what the joints will do in a step, by what they did in the last ones.

#include <carom/integrators/run/joint_history.h>

#include <algorithm>

namespace carom {

const std::vector<double>& StepCourse::numbers(std::size_t ago) const {
  return steps_[(newest_ + ago) % depth_];
}

std::vector<double>& StepCourse::numbers(std::size_t ago) { return steps_[(newest_ + ago) % depth_]; }

void StepCourse::go_on(std::size_t size) {
  newest_ = (newest_ + depth_ - 1) % depth_;
  if (steps_[newest_].size() == size) return;
  for (std::size_t ago = 0; ago < depth_; ++ago) numbers(ago).assign(size, 0.0);
}

void StepCourse::record(Range range, const double* numbers) {
  std::copy(numbers + range.begin, numbers + range.end, steps_[newest_].begin() + range.begin);
}

LastNumbers StepCourse::last() const {
  LastNumbers last{};
  for (std::size_t ago = 0; ago < depth_; ++ago) last[ago] = numbers(ago).data();
  return last;
}

void StepCourse::guess(Range range, std::size_t steps, double* out) const {
  extrapolate(range, last(), std::min(steps, depth_), out);
}

std::size_t StepCourse::best_steps(Range range, std::size_t steps, const double* weight) const {
  return carom::best_steps(range, last(), std::min(steps, depth_), weight);
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
