#pragma once

/// \file
/// Accelerations within one step, by time: gaps of many pairs are looked at at the same times, halves of the
/// step first, and with many closed contacts nothing costs as much as their forces.

#include <carom/integrators/event_driven/motion_sample.h>
#include <carom/integrators/event_driven/smooth_motion.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace carom {

/// The latest accelerations of a group within one step. Keeps its memory.
class KnownAccelerations {
public:
  /// Forgets all: another step.
  void forget() { count_ = next_ = 0; }
  /// Samples a motion with all its forces, which are found only if they are not known for that time.
  /// \param y its unknowns then
  void sample(SmoothMotion& motion, double time, const double* y, MotionSample& out) {
    const auto end = times_.begin() + static_cast<std::ptrdiff_t>(count_);
    const auto known = std::find(times_.begin(), end, time);
    const bool asks = known == end || motion.active().list().empty();
    motion.sample(time, y, asks ? Forces::all : Forces::without_contact, out);
    if (asks && (motion.active().list().empty() || !out.has_forces)) return;
    const auto at = asks ? next_ : static_cast<std::size_t>(known - times_.begin());
    std::vector<double>& numbers = numbers_[at];
    if (asks) {
      times_[at] = time;
      numbers.resize(motion.model().unknowns.v_size());
      count_ = std::max(count_, at + 1);
      next_ = (next_ + 1) % most;
    }
    motion.model().unknowns.for_velocities([&](Range v, std::size_t place) {
      const auto of_group = numbers.begin() + static_cast<std::ptrdiff_t>(place);
      const auto of_all = out.acceleration.begin() + static_cast<std::ptrdiff_t>(v.begin);
      if (asks) {
        std::copy_n(of_all, v.size(), of_group);
      } else {
        std::copy_n(of_group, v.size(), of_all);
      }
    });
  }

private:
  static constexpr std::size_t most = 64;
  std::array<double, most> times_{};
  std::array<std::vector<double>, most> numbers_;
  std::size_t count_ = 0, next_ = 0;
};

}  // namespace carom
