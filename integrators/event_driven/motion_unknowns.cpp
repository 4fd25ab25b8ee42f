// Problem: unknowns of a component between the state of the model and the numbers that a flow integrates.

#include <carom/integrators/event_driven/motion_unknowns.h>

#include <algorithm>

namespace carom {

MotionUnknowns::MotionUnknowns(const Component& component, Index works)
    : component_(&component),
      works_(works),
      q_size_(component.q.size()),
      v_size_(component.v.size()),
      z_size_(component.z.size()),
      size_(q_size_ + v_size_ + z_size_ + works) {}

void MotionUnknowns::gather(const State& state, std::span<double> y) const {
  auto out = std::copy_n(state.q.begin() + component_->q.begin, q_size_, y.begin());
  out = std::copy_n(state.v.begin() + component_->v.begin, v_size_, out);
  out = std::copy_n(state.z.begin() + component_->z.begin, z_size_, out);
  std::fill(out, y.end(), 0.0);
}

void MotionUnknowns::scatter(std::span<const double> y, State& state) const {
  const double* from = y.data();
  std::copy_n(from, q_size_, state.q.begin() + component_->q.begin);
  std::copy_n(from + q_size_, v_size_, state.v.begin() + component_->v.begin);
  std::copy_n(from + q_size_ + v_size_, z_size_, state.z.begin() + component_->z.begin);
}

}  // namespace carom
