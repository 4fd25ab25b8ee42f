#pragma once

/// \file
/// The flow where velocities change at constant rates: a parabola, without an error.

#include <carom/core/export.h>
#include <carom/integrators/flow/flow.h>

#include <vector>

namespace carom {

/// Follows a problem whose rates, but for those of its integrals, are constant (FlowProblem::is_ballistic()):
///
///     q(t) = q + (t - t_0) v + (t - t_0)^2 a / 2,   v(t) = v + (t - t_0) a
///
/// from the start t_0 of a step. It evaluates the rates once after each start(), and its steps are as long as
/// they may be.
class CAROM_API BallisticFlow final : public Flow {
public:
  /// ModelError: as make_flow().
  BallisticFlow(FlowProblem& problem, double relative_tolerance);

  void bind(FlowProblem& problem) override;
  [[nodiscard]] bool leave(FlowStep& out) const override;
  void resume(const FlowStep& step) override;
  void start(double time, std::span<const double> y, double first_step) override;
  void advance(double longest) override;
  [[nodiscard]] double begin() const override { return begin_; }
  [[nodiscard]] double end() const override { return end_; }
  [[nodiscard]] std::span<const double> state() const override { return state_; }
  void sample(double time, std::span<double> y) override { land(time, y); }
  void land(double time, std::span<double> y) override;
  void correct(std::span<const double> y) override;
  [[nodiscard]] double next_step() const override { return next_step_; }
  [[nodiscard]] const FlowCounts& counts() const override { return counts_; }

private:
  void fly(double time, std::span<double> y) const;

  FlowProblem* problem_;
  std::size_t integrals_;
  double relative_tolerance_;
  double begin_ = 0.0, end_ = 0.0, next_step_ = 0.0;
  std::vector<double> start_, state_, rates_;  // y at begin_, at end_; rates at begin_
  bool started_ = false;
  bool known_ = false;  // rates_ are those at end_ but for the integrals
  FlowCounts counts_;
};

}  // namespace carom
