#pragma once

/// \file
/// Guards at both ends of a step of a flow, with all that is needed to interpolate them.

#include <carom/contact/active_set.h>
#include <carom/core/export.h>
#include <carom/core/numerics/step_polynomial.h>
#include <carom/integrators/event_driven/event_scales.h>
#include <carom/integrators/event_driven/guard_samples.h>
#include <carom/integrators/event_driven/motion_sample.h>
#include <carom/integrators/event_driven/smooth_motion.h>
#include <carom/integrators/event_driven/step_path.h>

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace carom {

/// A gap at an end of a step.
struct GapEnd : StepPolynomial::End {
  double curvature_bound = 0.0;  ///< of the sixth derivative of the gap by turning [m/s^6]
  /// By how much the gap may fall without closing [m]: by what the projection onto the constraints takes
  /// back, and in a step of low order by its error.
  double drift = 0.0;
};

/// Facts known beside of the gap of two bodies, or of a body with an outline.
struct BodyGapEnd {
  double speed = 0.0;         ///< bound of the rate of the gap [m/s]
  double acceleration = 0.0;  ///< bound of the change of that rate by accelerations [m/s^2]
  bool known = false;         ///< the gap is known; false: its value is a lower bound
};

/// One end of a step. There is one for each group: it is small.
struct StepEnd {
  std::vector<GapEnd> gaps;           ///< by pair
  std::vector<BodyGapEnd> body_gaps;  ///< by pair with an outline
  GuardSample sample;                 ///< all other guards
  std::unique_ptr<PathEnd> path;      ///< where elements have guards
  std::vector<double> noises;         ///< rounding of the margins of forces [N]
  std::size_t independent = 0;        ///< constraints of closed contacts that do not follow from others
};

/// The two ends of a step. A guard falls where it passes its level: zero, or the little below zero where it
/// began, so that what has just passed does not pass once more; for a gap, less its drift: what follows from
/// closed contacts does not close beside them.
class CAROM_API StepEnds {
public:
  /// The ends.
  [[nodiscard]] StepEnd& start() { return start_; }
  [[nodiscard]] const StepEnd& start() const { return start_; }
  [[nodiscard]] StepEnd& end() { return end_; }
  [[nodiscard]] const StepEnd& end() const { return end_; }
  /// Level of a gap [m]: of two corners that hit at almost the same time one is found late.
  [[nodiscard]] double gap_level(std::size_t pair) const;
  /// Level at which a gap without drift is taken to have closed [m]: zero for what leaves, whatever the
  /// rounding of the time of its last closing has left of it, if it gets well above zero; else gap_level().
  /// At the level where it began each bounce would begin deeper than the one before, thousands of them by
  /// more than tolerances allow. \param slowest of what leaves [m/s] \param deepest that it may have begun
  /// [m]
  [[nodiscard]] double closing_level(std::size_t pair, double slowest, double deepest) const;
  /// Level of sliding [m/s]: after a projection it may still creep the other way.
  [[nodiscard]] double slip_level(std::size_t contact) const;
  /// Level of the margin of a feature [m].
  [[nodiscard]] double feature_level(std::size_t contact) const;
  /// Level of the margin of a force [N].
  [[nodiscard]] double force_level(std::size_t island) const;
  /// Rounding of the margin of a force at either end [N].
  [[nodiscard]] double force_noise(std::size_t island) const;

private:
  StepEnd start_, end_;
};

struct DetectionMemory;

/// Writes the guards, those of gaps aside, in a sample of the motion with all forces. \param margins memory
CAROM_API void read_guard_sample(SmoothMotion& motion, const MotionSample& at,
                                 std::vector<ForceMargin>& margins, GuardSample& out);

/// Samples the motion at an end of a step. False if something is not finite. \param is_active by pair
/// \param scales of the phase
[[nodiscard]] CAROM_API bool sample_step_end(SmoothMotion& motion, double time, const double* y,
                                             std::span<const char> is_active, const EventScales& scales,
                                             DetectionMemory& memory, StepEnd& out);

}  // namespace carom
