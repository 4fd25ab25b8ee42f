#pragma once

/// \file
/// Guards at both ends of a step of a flow, with all that is needed to interpolate them.

#include <carom/contact/active_set.h>
#include <carom/core/export.h>
#include <carom/core/numerics/step_polynomial.h>
#include <carom/integrators/event_driven/guard_samples.h>
#include <carom/integrators/event_driven/motion_sample.h>
#include <carom/integrators/event_driven/smooth_motion.h>
#include <carom/integrators/event_driven/step_path.h>

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace carom {

/// One end of a step.
struct StepEnd {
  std::vector<StepPolynomial::End> gaps;  ///< by pair
  /// By pair: bound of the sixth derivative of the gap by turning [m/s^6].
  std::vector<double> gap_curvature_bound;
  /// By pair of two bodies: true if the gap is known; else its value is a lower bound.
  std::vector<char> gap_known;
  std::vector<double> gap_speeds;         ///< by such pair: bound of the rate of the gap [m/s],
  std::vector<double> gap_accelerations;  ///< and of what accelerations add to it [m/s^2]
  GuardSample sample;                     ///< all other guards
  PathEnd path;                           ///< where elements have guards
  std::vector<double> noises;             ///< rounding of the margins of forces [N]
};

/// Both ends. A guard falls where it passes its level: zero, or the little below zero where it began, so that
/// what has just passed does not pass once more.
class CAROM_API StepEnds {
public:
  /// The ends.
  [[nodiscard]] StepEnd& start() { return ends_[start_]; }
  [[nodiscard]] const StepEnd& start() const { return ends_[start_]; }
  [[nodiscard]] StepEnd& end() { return ends_[1 - start_]; }
  [[nodiscard]] const StepEnd& end() const { return ends_[1 - start_]; }
  /// Makes the end the start of the next step.
  void advance() { start_ = 1 - start_; }
  /// Level of a gap [m]: of two corners that hit at almost the same time one is found late.
  [[nodiscard]] double gap_level(std::size_t pair) const;
  /// Level of sliding [m/s]: after a projection it may still creep the other way.
  [[nodiscard]] double slip_level(std::size_t contact) const;
  /// Level of the margin of a feature [m].
  [[nodiscard]] double feature_level(std::size_t contact) const;
  /// Level of the margin of a force [N].
  [[nodiscard]] double force_level(std::size_t island) const;
  /// Rounding of the margin of a force at either end [N].
  [[nodiscard]] double force_noise(std::size_t island) const;

private:
  std::array<StepEnd, 2> ends_;
  std::size_t start_ = 0;
};

/// Memory of the detection of events, shared by clock groups.
struct CAROM_API DetectionMemory {
  explicit DetectionMemory(const Assembly& assembly) : within(assembly) {}

  MotionSample within;                    ///< at a time of a step
  std::vector<double> y;                  ///< there
  std::vector<double> path_acceleration;  ///< likewise, along the path of a step
  std::vector<ForceMargin> margins;
  GuardSample located;        ///< where an event is located
  GuardSamples samples;       ///< within one step,
  GuardSamples path_samples;  ///< of guards of elements along its path
};

/// Writes the guards, those of gaps aside, in a sample of the motion with all forces. \param margins memory
CAROM_API void read_guard_sample(SmoothMotion& motion, const MotionSample& at,
                                 std::vector<ForceMargin>& margins, GuardSample& out);

/// Samples the motion at an end of a step. False if something is not finite. \param is_active by pair
/// \param force_scale of the phase [N]
[[nodiscard]] CAROM_API bool sample_step_end(SmoothMotion& motion, double time, const double* y,
                                             std::span<const char> is_active, double force_scale,
                                             DetectionMemory& memory, StepEnd& out);

}  // namespace carom
