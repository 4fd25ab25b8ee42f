#pragma once

/// \file
/// The flow where velocities change at constant rates: a parabola, without an error.

#include <carom/core/export.h>
#include <carom/integrators/flow/plain_flow.h>

namespace carom {

/// Follows a problem whose rates, but for those of its integrals, are constant (FlowProblem::is_ballistic()):
///
///     q(t) = q + (t - t_0) v + (t - t_0)^2 a / 2,   v(t) = v + (t - t_0) a
///
/// from the start t_0 of a step. It evaluates the rates once after each start(), and its steps are as long as
/// they may be.
class CAROM_API BallisticFlow final : public PlainFlow {
public:
  /// ModelError: as make_flow().
  BallisticFlow(FlowProblem& problem, double relative_tolerance)
      : PlainFlow(problem, relative_tolerance, 1) {}

  void advance(double longest) override;

private:
  void reach(double time, std::span<double> y) override;
  void carry_rates() override;
};

}  // namespace carom
