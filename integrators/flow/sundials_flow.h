#pragma once

/// \file
/// Flows of SUNDIALS: the last step, its ends, and the errors, which all its methods have in common.

#include <carom/integrators/flow/flow.h>
#include <carom/integrators/flow/sundials_link.h>

#include <limits>
#include <memory>
#include <span>
#include <vector>

namespace carom {

/// Stands for no stop time; 6.4 cannot clear one.
inline constexpr double no_stop_time = std::numeric_limits<double>::max();
/// Reductions of a first step that was far too long; the default of 7 is too few.
inline constexpr int error_test_failures = 25;

/// A flow whose steps an integrator of SUNDIALS makes.
class SundialsFlow : public Flow {
public:
  void bind(FlowProblem& problem) final;
  [[nodiscard]] bool leave(FlowStep& out) const final;
  void resume(const FlowStep& step) final;
  void start(double time, std::span<const double> y, double first_step) final;
  void advance(double longest) final;
  [[nodiscard]] double begin() const final { return begin_; }
  [[nodiscard]] double end() const final { return end_; }
  [[nodiscard]] std::span<const double> state() const final { return end_state_; }
  void sample(double time, std::span<double> y) final;
  void land(double time, std::span<double> y) final;
  void correct(std::span<const double> y) final;
  [[nodiscard]] double next_step() const final { return next_; }
  [[nodiscard]] const FlowCounts& counts() const final;

protected:
  SundialsFlow(FlowProblem& problem, double relative_tolerance);

  /// Makes a step from begin(), end_state_ holding y there, into end_state_; sets next_. The step may end
  /// beside where it must, by the rounding of time. \return what SUNDIALS returned; `reached` is the step's
  /// end
  virtual int step(double longest, double& reached) = 0;
  /// Called by start() and resume(): what was known of the motion so far no longer holds.
  virtual void forget() = 0;
  /// True if the next step will start anew.
  [[nodiscard]] virtual bool starts_anew() const = 0;
  /// History that a step which does not start anew needs: how many numbers, 0 where none can be recorded;
  /// recording them; and going on from those of another flow (after forget()).
  [[nodiscard]] virtual std::size_t history_size() const { return 0; }
  virtual void record_history(double* /*out*/) const {}
  virtual void restore_history(const double* /*from*/) {}
  /// Called by correct() after a step, while end_state_ still holds what will be replaced.
  virtual void shift(std::span<const double> y) = 0;
  /// sample() and land() strictly inside the last step; after resume() the latter alone.
  virtual void interpolate(double time, double* y) = 0;
  virtual void integrate_to(double time, double* y) = 0;

  /// A time after begin() that serves the integrators to choose a first step by.
  [[nodiscard]] double horizon(double longest) const;

  SundialsLink link_;
  double begin_ = 0.0, end_ = 0.0;
  double next_ = 0.0;
  std::vector<double> begin_state_, end_state_;
  SundialsVector begin_vector_, end_vector_;
  SundialsVector out_vector_;  // points to whatever is to be written

private:
  void demand_step(double time, std::size_t size, const char* what) const;

  bool started_ = false;
  bool stepped_ = false;  // since start() or resume()
  mutable FlowCounts counts_{};
};

/// The methods.
[[nodiscard]] std::unique_ptr<Flow> make_runge_kutta_flow(FlowProblem& problem, double relative_tolerance);
[[nodiscard]] std::unique_ptr<Flow> make_multistep_flow(FlowMethod method, FlowProblem& problem,
                                                        double relative_tolerance);

}  // namespace carom
