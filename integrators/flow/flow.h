#pragma once

/// \file
/// Smooth motion between events: solve  dy/dt = f(t, y)  step by step, with the state known everywhere within
/// the last step, so that somebody else can look for events in it.

#include <carom/core/export.h>
#include <carom/core/ids.h>
#include <carom/integrators/flow/flow_method.h>

#include <memory>
#include <span>
#include <vector>

namespace carom {

/// One number of the linear equations that small changes of the rates obey,
///
///     sum of_rate d(dy/dt)_column = sum (of_state dy_column + of_integral dY_column),
///
/// by rows. Numbers at the same place add up. A column that is not below FlowProblem::size() stands for an
/// unknown of its own, say the multiplier of a constraint: its number is `of_state`, it has a row of the same
/// number, and that row has no `of_state` of such columns.
struct RateDerivative {
  Index row = 0;             ///< equation: that of the unknown of this number
  Index column = 0;          ///< unknown
  double of_rate = 0.0;      ///< factor of its rate: a mass; 1 on the diagonal of  dy/dt = f
  double of_state = 0.0;     ///< factor of the unknown itself: df/dy
  double of_integral = 0.0;  ///< factor of the unknown that it is the rate of (FlowProblem::integrals())
};

/// Problem to integrate: the numbers y of a component (coordinates, velocities, internal variables, works).
class CAROM_API FlowProblem {
public:
  virtual ~FlowProblem() = default;

  /// Number of unknowns.
  [[nodiscard]] virtual std::size_t size() const = 0;
  /// Writes dy/dt. Not finite numbers mean that y is nowhere where f is defined.
  virtual void rates(double time, const double* y, double* rates) = 0;
  /// Absolute tolerance of each unknown, > 0.
  [[nodiscard]] virtual std::span<const double> absolute_tolerances() const = 0;
  /// True if jacobian() is there. Otherwise bdf finds all of df/dy by differences, size() evaluations.
  [[nodiscard]] virtual bool has_jacobian() const { return false; }
  /// Number n of unknowns that jacobian() knows to be integrals:  dy_i/dt = y_(n+i)  for i < n.
  [[nodiscard]] virtual std::size_t integrals() const { return 0; }
  /// True as long as the rates are constant but for those of the integrals, which are all there is to change.
  [[nodiscard]] virtual bool is_ballistic() const { return false; }
  /// Appends the derivative of the rates, in any order; the same order again and again spares the analysis of
  /// its pattern. Integrals have neither rows nor columns. Nor need unknowns have rows whose rates may be
  /// taken as constant because no other depends on them (works): Newton's method finds them all the same.
  virtual void jacobian(double /*time*/, const double* /*y*/, std::vector<RateDerivative>& /*out*/) {}
};

/// Counts since the flow was made.
struct FlowCounts {
  std::int64_t steps = 0;        ///< accepted steps
  std::int64_t evaluations = 0;  ///< of f
  std::int64_t restarts = 0;     ///< calls of start()

  /// Adds those of another flow.
  FlowCounts& operator+=(const FlowCounts& other) {
    steps += other.steps;
    evaluations += other.evaluations;
    restarts += other.restarts;
    return *this;
  }
};

/// The last step of a flow, apart from the flow: Flow::leave(), Flow::resume().
struct FlowStep {
  double begin = 0.0;           ///< time at which it began [s]
  double end = 0.0;             ///< time at which it ended [s]
  double next = 0.0;            ///< length that would be tried next, 0: the method's own guess [s]
  bool restart = true;          ///< the next step starts anew, as after start()
  std::vector<double> numbers;  ///< y at both ends, and what else the method wants to know
};

/// An integrator that makes one step at a time. After start() the last step is empty: begin() == end(). What
/// follows a start() depends on its arguments alone, whatever the flow did before.
class CAROM_API Flow {
public:
  virtual ~Flow() = default;

  /// Serves another problem from now on; start() or resume() comes next. Counts go on. ModelError: unlike the
  /// present problem in the number of unknowns or of integrals, or as make_flow().
  virtual void bind(FlowProblem& problem) = 0;
  /// Writes the last step, for resume(). False, and nothing written, where that is not all there is to know:
  /// with adams and bdf unless the next step is the first after start(); with any method after an error.
  [[nodiscard]] virtual bool leave(FlowStep& out) const = 0;
  /// Goes on from a step that a flow of the same method left, on the same problem, as that flow would have:
  /// the same bits for the same evaluations. But with explicit_runge_kutta sample() does what land() does
  /// until the next step. ModelError: a step of another number of unknowns or another method.
  virtual void resume(const FlowStep& step) = 0;
  /// Starts anew at y. \param first_step length to try first [s], 0: the method's own guess. The step in use
  /// before serves explicit_runge_kutta well; adams and bdf begin at order 1 and guess better.
  virtual void start(double time, std::span<const double> y, double first_step) = 0;
  /// Makes one step of the method's choice, of length `longest` [s] at most; to a step that is cut by it,
  /// end() == begin() + longest. A cut costs explicit_runge_kutta one evaluation; adams and bdf grow back
  /// from it by a factor of ten every few steps, so rather let them step over a time and land() there.
  ///
  /// Throws SolverError, without the names of parts, where it cannot go on: rates not finite, a blow-up,
  /// tolerances below rounding; also what rates() or jacobian() throw. Then state() is the last good one, and
  /// start() is needed before the next step. ModelError: before start(), or longest not > 0.
  virtual void advance(double longest) = 0;
  /// Time at which the last step began [s].
  [[nodiscard]] virtual double begin() const = 0;
  /// Time at which the last step ended [s].
  [[nodiscard]] virtual double end() const = 0;
  /// y at the end of the last step. Valid until the next call.
  [[nodiscard]] virtual std::span<const double> state() const = 0;
  /// Writes y at a time within the last step, by interpolation with an error near that of the step. With
  /// explicit_runge_kutta three evaluations for the first time in a step, none later. ModelError: another
  /// time.
  virtual void sample(double time, std::span<double> y) = 0;
  /// Writes y at a time within the last step, as accurate as steps are: explicit_runge_kutta integrates again
  /// from begin() (six evaluations), adams and bdf interpolate. Steps to come are not affected in any bit.
  virtual void land(double time, std::span<double> y) = 0;
  /// Replaces y at the end of the last step by one that differs little (a projection) and goes on from there
  /// without the cost of a start: explicit_runge_kutta keeps its step for one evaluation more; adams and bdf
  /// keep step and order, and their error test sees a change that is not small. Afterwards the last step is
  /// empty.
  virtual void correct(std::span<const double> y) = 0;
  /// Length of the step that would be tried next [s], 0 if the method would choose anew.
  [[nodiscard]] virtual double next_step() const = 0;
  /// Counts.
  [[nodiscard]] virtual const FlowCounts& counts() const = 0;
};

/// Makes a flow; of a ballistic problem a BallisticFlow, whatever the method. The estimated error of a step
/// is at most relative_tolerance |y_i| + absolute tolerance, in each unknown. `problem` must outlive the
/// flow's use of it. ModelError: a tolerance that is not finite and > 0, no unknowns. \param
/// relative_tolerance > 0
[[nodiscard]] CAROM_API std::unique_ptr<Flow> make_flow(FlowMethod method, FlowProblem& problem,
                                                        double relative_tolerance);

}  // namespace carom
