#pragma once

/// \file
/// A flow of our own for tiny components: an embedded Runge-Kutta pair without any overhead.

#include <carom/core/export.h>
#include <carom/integrators/flow/flow.h>

#include <vector>

namespace carom {

/// The pair of orders 5 and 4 of Dormand and Prince (J. Comput. Appl. Math. 6, 1980, 19-26). Between the ends
/// of a step it is as accurate as at the ends: looking there is a step of its own.
class CAROM_API OneStepFlow final : public Flow {
public:
  OneStepFlow(FlowProblem& problem, double relative_tolerance);

  void bind(FlowProblem& problem) override;
  [[nodiscard]] bool leave(FlowStep& out) const override;
  void resume(const FlowStep& step) override;
  void start(double time, std::span<const double> y, double first_step) override;
  void advance(double longest) override;
  [[nodiscard]] double begin() const override { return begin_; }
  [[nodiscard]] double end() const override { return time_; }
  [[nodiscard]] std::span<const double> state() const override { return end_; }
  void sample(double time, std::span<double> y) override;
  void land(double time, std::span<double> y) override;
  void correct(std::span<const double> y) override;
  [[nodiscard]] double next_step() const override { return next_step_; }
  [[nodiscard]] const FlowCounts& counts() const override { return counts_; }

private:
  void rates(double time, const double* y, double* out);
  void make_step(double time, double length, const std::vector<double>& from, std::vector<double>& slopes,
                 std::span<double> to);
  [[nodiscard]] double error(double length) const;
  [[nodiscard]] double first_guess() const;

  FlowProblem* problem_;
  std::size_t integrals_;
  double relative_tolerance_;
  double begin_ = 0.0, time_ = 0.0, next_step_ = 0.0;
  std::vector<double> start_, end_, trial_;  // y at begin_, at time_
  std::vector<double> slopes_, landing_;     // stages of the last step, one after the other
  bool started_ = false;
  bool known_ = false;  // the last stage is the rate at time_
  FlowCounts counts_;
};

}  // namespace carom
