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
#include <carom/integrators/time_stepping/step_trial.h>

#include <span>
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
  /// Begins with an island.
  void start(std::span<const Index> components);
  /// Makes the next guess at the loads of an island of Anderson's iteration, or takes note of how Newton's
  /// method contracts. The fixed-point iteration takes the loads themselves (SweepSchedule::improve()).
  void improve(std::span<const Index> components, const FixedPointJudge& judge, StepTrial& trial);
  /// Newton's method.
  [[nodiscard]] NewtonIteration& newton() { return newton_; }
  [[nodiscard]] const NewtonIteration& newton() const { return newton_; }

private:
  // Loads of an island, whose components need not follow one another.
  struct Gathered {
    std::vector<double> guess, led_to, weights;
  };
  void accelerate(std::span<const Index> components, StepTrial& trial);

  const Assembly* assembly_;
  Iteration current_ = Iteration::fixed_point;
  AndersonAcceleration anderson_;
  std::vector<double> weights_;  // of loads: lengths by mass
  Gathered gathered_;
  NewtonIteration newton_;
};

}  // namespace carom
