// Problem: what the joints will do in a step, by what they did in the last ones.

#include <carom/core/numerics/extrapolation.h>
#include <carom/integrators/run/joint_history.h>

#include <algorithm>

namespace carom {

void StepCourse::go_on(std::size_t size) {
  std::rotate(changes.begin(), changes.end() - 1, changes.end());
  if (last.size() == size) return;
  last.assign(size, 0.0);
  for (std::vector<float>& numbers : changes) numbers.assign(size, 0.0F);
}

void StepCourse::record(Range range, const double* numbers) {
  record_change(range, last.data(), numbers, changes[0].data());
  std::copy(numbers + range.begin, numbers + range.end, last.begin() + range.begin);
}

void StepCourse::guess(Range range, int known, double* out) const {
  extrapolate(range, last.data(), {changes[0].data(), changes[1].data(), changes[2].data()},
              std::min(known - 1, most), 1.0, out);
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
