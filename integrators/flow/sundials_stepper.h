#pragma once

/// \file
/// Steps of the Runge-Kutta method of Dormand and Prince, made by ARKODE's ERKStep.

#include <carom/integrators/flow/sundials_flow.h>

#include <arkode/arkode_erkstep.h>

#include <cmath>

namespace carom {

/// How long the next step is to be by the errors of this and the step before: the PI controller that ARKODE
/// has for explicit methods, but with a memory that can be handed on.
class LengthControl {
public:
  static constexpr double no_error = 1.0;  ///< where there was no step before

  /// The error of the step before, against the tolerance.
  void remember(double error) { before_ = error; }
  [[nodiscard]] double error() const { return before_; }
  /// Length that the next step is to have. \param error of the tolerance; a step with more than 1 is not
  /// accepted
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

/// One integrator of ARKODE. Every call throws where ARKODE refuses it.
class Stepper {
public:
  /// \param link must outlive it \param y any state
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

  /// Starts anew. \param guessed the length of the first step will be a guess
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
  /// Makes a step; what ARKODE returned. \param horizon a time behind the step \param reached its end
  int step(double horizon, N_Vector y, double& reached) {
    const int flag = CAROM_ERK(Evolve)(memory_, horizon, y, &reached, ARK_ONE_STEP);
    used_ = used_ || flag >= 0;
    return flag;
  }
  /// Length of the first step. \param error of the step before, for the control
  void first_step(double length, double error = LengthControl::no_error) {
    demand(CAROM_ERK(SetInitStep)(memory_, length));
    control_.remember(error);
  }
  /// The error of the last step.
  [[nodiscard]] double error() const { return control_.error(); }
  /// Holds for the steps after the next, and for the first one.
  void longest_step(double length) { demand(CAROM_ERK(SetMaxStep)(memory_, length)); }
  /// No step goes beyond this time.
  void stop_at(double time) { demand(CAROM_ERK(SetStopTime)(memory_, time)); }
  /// Length that would be tried next.
  [[nodiscard]] double next_step() const {
    double length = 0.0;
    demand(CAROM_ERK(GetCurrentStep)(memory_, &length));
    return length;
  }
  /// Writes the rates at an end of the last step.
  void slope(double time, N_Vector rates) const { demand(CAROM_ERK(GetDky)(memory_, time, 1, rates)); }

private:
  // Dormand and Prince: the last evaluation of a step is the first of the next. Named, since what SUNDIALS
  // takes for order 5 by itself has changed between its versions.
  static constexpr auto table = ARKODE_DORMAND_PRINCE_7_4_5;
  // A step may be longer than the one before by this factor; the step after one that was guessed, which may
  // be far too short, by the other. Those of ARKODE, which takes the second after the first step it ever
  // makes, of whatever motion.
  static constexpr double growth = 25.0, growth_from_guess = 1e4;

  void demand(int flag) const { link_->errors().demand(flag >= 0, "a call of ERKStep"); }

  void* memory_;
  SundialsLink* link_;
  bool used_ = false;
  LengthControl control_;
#if SUNDIALS_VERSION_MAJOR >= 7
  SUNAdaptController controller_ = nullptr;
#endif
};

}  // namespace carom
