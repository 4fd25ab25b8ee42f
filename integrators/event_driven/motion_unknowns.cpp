// Problem: unknowns of a clock group between the state of the model and the numbers that a flow integrates.

#include <carom/integrators/event_driven/motion_unknowns.h>

#include <algorithm>

namespace carom {

MotionUnknowns::MotionUnknowns(const Assembly& assembly, std::span<const Index> components, Index works)
    : works_(works) {
  parts_.reserve(components.size());
  for (const Index component : components) {
    const Component& ranges = assembly.components()[component];
    parts_.push_back({component, ranges, q_size_, v_size_, z_size_});
    q_size_ += ranges.q.size();
    v_size_ += ranges.v.size();
    z_size_ += ranges.z.size();
  }
  for (Part& part : parts_) {
    part.v += q_size_;
    part.z += q_size_ + v_size_;
  }
  size_ = q_size_ + v_size_ + z_size_ + works_;
}

const MotionUnknowns::Part& MotionUnknowns::part_of(Index v) const {
  if (parts_.size() == 1) return parts_.front();
  const auto behind = std::upper_bound(parts_.begin(), parts_.end(), v,
                                       [](Index at, const Part& part) { return at < part.ranges.v.begin; });
  return *(behind - 1);
}

Index MotionUnknowns::velocity_at(std::size_t place) const {
  const auto behind = std::upper_bound(parts_.begin(), parts_.end(), place,
                                       [](std::size_t at, const Part& part) { return at < part.v; });
  const Part& part = *(behind - 1);
  return part.ranges.v.begin + static_cast<Index>(place - part.v);
}

void MotionUnknowns::gather(const State& state, std::span<double> y) const {
  for (const Part& part : parts_) {
    const Component& of = part.ranges;
    std::copy_n(state.q.begin() + of.q.begin, of.q.size(), y.data() + part.q);
    std::copy_n(state.v.begin() + of.v.begin, of.v.size(), y.data() + part.v);
    std::copy_n(state.z.begin() + of.z.begin, of.z.size(), y.data() + part.z);
  }
  std::fill(y.begin() + static_cast<std::ptrdiff_t>(z_begin() + z_size_), y.end(), 0.0);
}

void MotionUnknowns::scatter(std::span<const double> y, State& state) const {
  for (const Part& part : parts_) {
    const Component& of = part.ranges;
    std::copy_n(y.data() + part.q, of.q.size(), state.q.begin() + of.q.begin);
    std::copy_n(y.data() + part.v, of.v.size(), state.v.begin() + of.v.begin);
    std::copy_n(y.data() + part.z, of.z.size(), state.z.begin() + of.z.begin);
  }
}

}  // namespace carom
