// Problem: an explicit Runge-Kutta method of order 5 that is started anew for the price of one evaluation,
// with the motion known everywhere within a step. Steps are those of ARKODE's ERKStep.

#include <carom/integrators/flow/sundials_flow.h>

#include <arkode/arkode_erkstep.h>

#include <algorithm>
#include <cmath>

namespace carom {

namespace {

// Dormand and Prince: the last evaluation of a step is the first of the next. Named, since what SUNDIALS
// takes for order 5 by itself has changed between its versions.
constexpr auto table = ARKODE_DORMAND_PRINCE_7_4_5;
// A step may be longer than the one before by this factor; the step after one that was guessed, which may be
// far too short, by the other. Those of ARKODE, which takes the second after the first step it ever makes, of
// whatever motion.
constexpr double growth = 25.0, growth_from_guess = 1e4;

// How long the next step is to be by the errors of this and the step before: the PI controller that ARKODE
// has for explicit methods, but with a memory that can be handed on.
class LengthControl {
public:
  static constexpr double no_error = 1.0;  // where there was no step before

  void remember(double error) { before_ = error; }
  [[nodiscard]] double error() const { return before_; }
  /// \param error of the tolerance; a step with more than 1 is not accepted
  [[nodiscard]] double next(double length, double error) {
    constexpr double bias = 1.2, least = 1e-10, order = 4.0;  // the lower of the pair
    constexpr double of_this = 0.8 / order, of_before = 0.31 / order;
    const double now = bias * error;
    const auto at_least = [](double number) { return number > least ? number : least; };
    const double wanted = length * std::pow(at_least(now), -of_this) * std::pow(at_least(before_), of_before);
    if (error <= 1.0) before_ = now;
    return wanted;
  }

#if SUNDIALS_VERSION_MAJOR >= 7
  /// Controller for ARKODE; null if it cannot be made. To be destroyed.
  [[nodiscard]] SUNAdaptController make(SUNContext context) {
    SUNAdaptController made = SUNAdaptController_NewEmpty(context);
    if (made == nullptr) return nullptr;
    made->content = this;
    made->ops->gettype = [](SUNAdaptController) { return SUN_ADAPTCONTROLLER_H; };
    made->ops->estimatestep = [](SUNAdaptController self, sunrealtype length, int, sunrealtype error,
                                 sunrealtype* next) -> SUNErrCode {
      *next = static_cast<LengthControl*>(self->content)->next(length, error);
      return SUN_SUCCESS;
    };
    return made;
  }
#else
  /// Callback of ARKODE; `control` is a LengthControl.
  static int adapt(N_Vector, double, double length, double, double, double error, double, double, int, int,
                   double* next, void* control) {
    *next = static_cast<LengthControl*>(control)->next(length, error);
    return ARK_SUCCESS;
  }
#endif

private:
  double before_ = no_error;
};

// One integrator of ARKODE.
class Stepper {
public:
  Stepper(SundialsLink& link, N_Vector y)
      : memory_(ERKStepCreate(SundialsLink::rates, 0.0, y, link.context())), link_(&link) {
    link.errors().demand(memory_ != nullptr, "ERKStepCreate");
#if SUNDIALS_VERSION_MAJOR < 7
    demand(ERKStepSetErrHandlerFn(memory_, SundialsLink::take_message, &link));
#endif
    demand(CAROM_ERK(SetUserData)(memory_, &link));
    demand(CAROM_ERK(WFtolerances)(memory_, SundialsLink::weights));
    demand(ERKStepSetTableNum(memory_, table));
    demand(CAROM_ERK(SetInterpolantDegree)(memory_, 3));
    demand(CAROM_ERK(SetMaxErrTestFails)(memory_, error_test_failures));
    demand(CAROM_ERK(SetMaxHnilWarns)(memory_, -1));
    demand(CAROM_ERK(SetMaxGrowth)(memory_, growth));
#if SUNDIALS_VERSION_MAJOR >= 7
    controller_ = control_.make(link.context());
    link.errors().demand(controller_ != nullptr, "making a controller of steps");
    demand(CAROM_ERK(SetAdaptController)(memory_, controller_));
#else
    demand(ERKStepSetAdaptivityFn(memory_, LengthControl::adapt, &control_));
    demand(ERKStepSetErrorBias(memory_, 1.0));  // the control has its own
#endif
  }
  ~Stepper() {
    CAROM_ERK(Free)(&memory_);
#if SUNDIALS_VERSION_MAJOR >= 7
    SUNAdaptController_DestroyEmpty(controller_);
#endif
  }
  Stepper(const Stepper&) = delete;
  Stepper& operator=(const Stepper&) = delete;

  void start(double time, N_Vector y, bool guessed) {
    if (used_ && !guessed) {
      demand(CAROM_ERK(Reset)(memory_, time, y));
      return;
    }
    // A reset is no substitute for the first initialisation.
    demand(CAROM_ERK(SetMaxFirstGrowth)(memory_, guessed ? growth_from_guess : growth));
    demand(ERKStepReInit(memory_, SundialsLink::rates, time, y));
    used_ = false;
  }
  int step(double horizon, N_Vector y, double& reached) {
    const int flag = CAROM_ERK(Evolve)(memory_, horizon, y, &reached, ARK_ONE_STEP);
    used_ = used_ || flag >= 0;
    return flag;
  }
  /// \param error of the step before, for the control
  void first_step(double length, double error = LengthControl::no_error) {
    demand(CAROM_ERK(SetInitStep)(memory_, length));
    control_.remember(error);
  }
  [[nodiscard]] double error() const { return control_.error(); }
  void fixed_step(double length) { demand(CAROM_ERK(SetFixedStep)(memory_, length)); }
  // Holds for the steps after the next, and for the first one.
  void longest_step(double length) { demand(CAROM_ERK(SetMaxStep)(memory_, length)); }
  void stop_at(double time) { demand(CAROM_ERK(SetStopTime)(memory_, time)); }
  [[nodiscard]] double next_step() const {
    double length = 0.0;
    demand(CAROM_ERK(GetCurrentStep)(memory_, &length));
    return length;
  }
  void slope(double time, N_Vector rates) const { demand(CAROM_ERK(GetDky)(memory_, time, 1, rates)); }

private:
  void demand(int flag) const { link_->errors().demand(flag >= 0, "a call of ERKStep"); }

  void* memory_;
  SundialsLink* link_;
  bool used_ = false;
  LengthControl control_;
#if SUNDIALS_VERSION_MAJOR >= 7
  SUNAdaptController controller_ = nullptr;
#endif
};

class RungeKuttaFlow final : public SundialsFlow {
public:
  RungeKuttaFlow(FlowProblem& problem, double relative_tolerance)
      : SundialsFlow(problem, relative_tolerance),
        stepper_(link_, begin_vector_.get()),
        lander_(link_, begin_vector_.get()),
        known_slope_(link_.size()),
        slope_(link_.size()),
        bend_(link_.size()),
        change_(link_.size()),
        even_(link_.size()),
        odd_(link_.size()),
        place_(link_.size()),
        at_a_(link_.size()),
        at_b_(link_.size()) {}

private:
  int step(double longest, double& reached) override;
  void forget() override {
    restart_ = true;
    resumed_ = false;
  }
  void shift(std::span<const double>) override { forget(); }
  [[nodiscard]] bool starts_anew() const override { return restart_ && !resumed_; }
  [[nodiscard]] std::size_t history_size() const override { return link_.size() + 1; }
  void record_history(double* out) const override;
  void restore_history(const double* from) override;
  void interpolate(double time, double* y) override;
  void integrate_to(double time, double* y) override;

  [[nodiscard]] double guess_first_step(double longest);
  void make_polynomial();
  void evaluate_polynomial(double s, double* y) const;

  Stepper stepper_;
  Stepper lander_;  // integrates again from begin(), so that the stepper need not be disturbed
  bool restart_ = true;
  bool resumed_ = false;  // the restart is to be none: the next step is the one after that of another flow,
  std::vector<double> known_slope_;  // with these rates at its beginning,
  double known_error_ = 0.0;         // after a step with this error
  bool polynomial_made_ = false;
  // y(s) = y_0 + s (slope + s (bend + s change)) + s^2 (1-s)^2 (even + (2 s - 1) odd),  s from 0 to 1
  std::vector<double> slope_, bend_, change_, even_, odd_;
  std::vector<double> place_, at_a_, at_b_;
};

// E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary Differential Equations I, section II.4. ARKODE's own
// guess is that of a method of order 1 and costs eight steps more.
double RungeKuttaFlow::guess_first_step(double longest) {
  const double* const y = begin_state_.data();
  if (!link_.evaluate(begin_, y, at_a_.data())) return longest;  // the step will meet it again
  const double size = link_.in_tolerances(y, y), speed = link_.in_tolerances(at_a_.data(), y);
  // An explicit Euler step that changes y by a hundredth.
  const double small = std::min(longest, size > 1e-5 && speed > 1e-5 ? 0.01 * size / speed : 1e-6);
  for (std::size_t i = 0; i < link_.size(); ++i) place_[i] = y[i] + small * at_a_[i];
  if (!link_.evaluate(begin_ + small, place_.data(), at_b_.data())) {
    link_.clear();
    return small;
  }
  for (std::size_t i = 0; i < link_.size(); ++i) at_b_[i] -= at_a_[i];
  const double bend = link_.in_tolerances(at_b_.data(), y) / small;
  const double largest = std::max(speed, bend);
  const double guess = largest > 1e-15 ? std::pow(0.01 / largest, 1.0 / 5.0) : std::max(1e-6, 1e-3 * small);
  return std::min({100.0 * small, guess, longest});
}

void RungeKuttaFlow::record_history(double* out) const {
  const std::size_t n = link_.size();
  if (resumed_) {
    std::copy_n(known_slope_.data(), n, out);
    out[n] = known_error_;
    return;
  }
  N_VSetArrayPointer(out, out_vector_.get());
  stepper_.slope(end_, out_vector_.get());
  out[n] = stepper_.error();
}

void RungeKuttaFlow::restore_history(const double* from) {
  std::copy_n(from, link_.size(), known_slope_.data());
  known_error_ = from[link_.size()];
  resumed_ = true;
}

int RungeKuttaFlow::step(double longest, double& reached) {
  polynomial_made_ = false;
  const bool guessed = next_ == 0.0;
  if (guessed) next_ = guess_first_step(longest);
  const double wanted = next_;
  const bool cut = wanted > longest && !starts_anew();
  if (restart_) {
    stepper_.start(begin_, begin_vector_.get(), guessed);
    if (resumed_) {
      stepper_.first_step(wanted, known_error_);
      link_.answer(begin_, known_slope_.data());
    } else {
      stepper_.first_step(std::min(wanted, longest));
    }
  }
  // A stop time that is not reached would cut the step after this one too, so it is set only where it will
  // be. So cut, a first step is not also to be limited.
  stepper_.longest_step(cut ? wanted : longest);
  stepper_.stop_at(cut ? begin_ + longest : no_stop_time);
  int flag = stepper_.step(horizon(longest), end_vector_.get(), reached);
  // ERKStep does not try a shorter step where a stage meets rates that are not finite. Each of ours ends
  // before the place where the last one did.
  while (flag < 0 && link_.errors().not_finite() && !link_.errors().thrown()) {
    const double shorter = 0.25 * (link_.errors().not_finite_at() - begin_);
    if (!(begin_ + 0.25 * shorter > begin_)) break;  // so begin() is the edge
    link_.clear();
    stepper_.start(begin_, begin_vector_.get(), guessed);
    stepper_.first_step(std::min(shorter, longest));
    stepper_.longest_step(longest);
    stepper_.stop_at(no_stop_time);
    flag = stepper_.step(horizon(longest), end_vector_.get(), reached);
  }
  if (flag < 0) return flag;
  // A step that was cut says nothing against the length it would have had. To grow back to it would take
  // several steps; to start anew with it takes one evaluation.
  restart_ = flag == ARK_TSTOP_RETURN;
  resumed_ = false;
  next_ = restart_ ? wanted : stepper_.next_step();
  return flag;
}

// Hermite's polynomial of degree 5 from the values and rates at both ends and the rates at 1/3 and 2/3. Those
// are evaluated on the polynomial of degree 4 that the ends and the rate at 1/3 give (as ARKODE does at each
// sample): its error is of order h^5, which f times h leaves as h^6, the order of the step itself.
void RungeKuttaFlow::make_polynomial() {
  const std::size_t n = link_.size();
  const double h = end_ - begin_;
  N_VSetArrayPointer(slope_.data(), out_vector_.get());
  stepper_.slope(begin_, out_vector_.get());
  N_VSetArrayPointer(at_b_.data(), out_vector_.get());
  stepper_.slope(end_, out_vector_.get());
  for (std::size_t i = 0; i < n; ++i) {
    const double rise = end_state_[i] - begin_state_[i];
    const double first = h * slope_[i], last = h * at_b_[i];
    slope_[i] = first;
    bend_[i] = 3.0 * rise - 2.0 * first - last;
    change_[i] = first + last - 2.0 * rise;
    even_[i] = odd_[i] = 0.0;
  }
  const auto evaluate = [&](double s, std::vector<double>& rates) {
    evaluate_polynomial(s, place_.data());
    link_.clear();
    if (!link_.evaluate(begin_ + s * h, place_.data(), rates.data())) link_.errors().fail(0, begin_, h);
  };
  const auto cubic_slope = [&](std::size_t i, double s) {
    return slope_[i] + s * (2.0 * bend_[i] + s * 3.0 * change_[i]);
  };
  // The slopes of s^2 (1-s)^2 at a and b are 4/27 and -4/27; those of it times (2 s - 1) are 4/81 both.
  constexpr double a = 1.0 / 3.0, b = 2.0 / 3.0;
  evaluate(a, at_a_);
  for (std::size_t i = 0; i < n; ++i) even_[i] = 27.0 / 4.0 * (h * at_a_[i] - cubic_slope(i, a));
  evaluate(a, at_a_);
  evaluate(b, at_b_);
  for (std::size_t i = 0; i < n; ++i) {
    const double lacking_a = h * at_a_[i] - cubic_slope(i, a), lacking_b = h * at_b_[i] - cubic_slope(i, b);
    even_[i] = 27.0 / 8.0 * (lacking_a - lacking_b);
    odd_[i] = 81.0 / 8.0 * (lacking_a + lacking_b);
  }
  polynomial_made_ = true;
}

void RungeKuttaFlow::evaluate_polynomial(double s, double* y) const {
  const double hump = s * s * (1.0 - s) * (1.0 - s), slant = hump * (2.0 * s - 1.0);
  for (std::size_t i = 0; i < link_.size(); ++i) {
    y[i] = begin_state_[i] +
           (s * (slope_[i] + s * (bend_[i] + s * change_[i])) + (hump * even_[i] + slant * odd_[i]));
  }
}

void RungeKuttaFlow::interpolate(double time, double* y) {
  if (!polynomial_made_) make_polynomial();
  evaluate_polynomial((time - begin_) / (end_ - begin_), y);
}

void RungeKuttaFlow::integrate_to(double time, double* y) {
  // One step, shorter than the one whose error was tolerated.
  link_.clear();
  N_VSetArrayPointer(y, out_vector_.get());
  lander_.fixed_step(time - begin_);
  lander_.start(begin_, begin_vector_.get(), false);
  double reached = begin_;
  const int flag = lander_.step(time, out_vector_.get(), reached);
  if (flag < 0) link_.errors().fail(flag, begin_, time - begin_);
}

}  // namespace

std::unique_ptr<Flow> make_runge_kutta_flow(FlowProblem& problem, double relative_tolerance) {
  return std::make_unique<RungeKuttaFlow>(problem, relative_tolerance);
}

}  // namespace carom
