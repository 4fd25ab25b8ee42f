#pragma once

/// \file
/// The iteration for the loads at the end of a step: how the next guess is made from the last one and the
/// loads that it led to. Sweeps take those loads themselves (fixed point), Anderson's acceleration combines
/// the last few, Newton's method uses their derivatives.

#include <carom/core/export.h>
#include <carom/core/numerics/anderson.h>
#include <carom/core/numerics/fixed_point.h>
#include <carom/integrators/run/time_stepping.h>
#include <carom/integrators/time_stepping/newton_iteration.h>
#include <carom/integrators/time_stepping/sweep_schedule.h>

#include <vector>

namespace carom {

/// The iterations of a step, one of them in use. Memory of each when it is first needed.
class CAROM_API LoadIteration {
public:
  explicit LoadIteration(const Assembly& assembly) : assembly_(&assembly) {}

  /// Uses another iteration.
  void use(Iteration iteration);
  /// The one in use.
  [[nodiscard]] Iteration current() const { return current_; }
  [[nodiscard]] bool is_newton() const { return current_ == Iteration::linearly_implicit; }
  /// Begins with a component.
  void start(Index component);
  /// Makes the next guess.
  void improve(const SweepStages& stages, const SweepSchedule& schedule, const FixedPointJudge& judge);
  /// Newton's method.
  [[nodiscard]] NewtonIteration& newton() { return newton_; }
  [[nodiscard]] const NewtonIteration& newton() const { return newton_; }

private:
  const Assembly* assembly_;
  Iteration current_ = Iteration::fixed_point;
  AndersonAcceleration anderson_;
  std::vector<double> weights_;  // of loads: lengths by mass
  NewtonIteration newton_;
};

}  // namespace carom
