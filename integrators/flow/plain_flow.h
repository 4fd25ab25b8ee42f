#pragma once

/// \file
/// The last step of flows without SUNDIALS, known by y and the rates at its ends.

#include <carom/core/export.h>
#include <carom/integrators/flow/flow.h>

#include <vector>

namespace carom {

/// A flow whose last step is known by y at both ends and by the rates of its stages, the first of which
/// belongs to the begin and the last to the end. A method adds advance() and reach().
class CAROM_API PlainFlow : public Flow {
public:
  void bind(FlowProblem& problem) override;
  [[nodiscard]] bool leave(FlowStep& out) const override;
  void resume(const FlowStep& step) override;
  void start(double time, std::span<const double> y, double first_step) override;
  [[nodiscard]] double begin() const override { return begin_; }
  [[nodiscard]] double end() const override { return end_; }
  [[nodiscard]] std::span<const double> state() const override { return state_; }
  void sample(double time, std::span<double> y) override { land(time, y); }
  void land(double time, std::span<double> y) override;
  void correct(std::span<const double> y) override;
  [[nodiscard]] double next_step() const override { return next_step_; }
  [[nodiscard]] const FlowCounts& counts() const override { return counts_; }

protected:
  /// \param stages number of rows of rates, >= 1. ModelError: as make_flow().
  PlainFlow(FlowProblem& problem, double relative_tolerance, std::size_t stages);

  /// Writes y at a time between the ends of the last step.
  virtual void reach(double time, std::span<double> y) = 0;
  /// Writes the rates at the end of the last step, which it tells, to the first stage of the next.
  virtual void carry_rates() = 0;

  /// Begins a step, of length `longest` [s] at most, whose first stage is known afterwards; throws as
  /// advance().
  void begin_step(double longest);
  /// The step has come to `end`: start_ and state_ are y at its ends.
  void accept(double end, double next_step);
  /// Evaluates the rates.
  void evaluate(double time, const double* y, double* rates);
  /// Rates of a stage.
  [[nodiscard]] double* stage(std::size_t number) { return rates_.data() + number * state_.size(); }
  [[nodiscard]] const double* stage(std::size_t number) const {
    return rates_.data() + number * state_.size();
  }

  FlowProblem* problem_;
  std::size_t integrals_;
  double relative_tolerance_;
  double begin_ = 0.0, end_ = 0.0, next_step_ = 0.0;
  std::vector<double> start_, state_;  // y at begin_, at end_

private:
  void go_on_from(std::span<const double> y);
  [[nodiscard]] std::size_t numbers_kept() const;

  std::vector<double> rates_;  // of all stages, one after the other
  bool started_ = false;
  bool known_ = false;  // the last step tells the rates at end_
  FlowCounts counts_;
};

}  // namespace carom
