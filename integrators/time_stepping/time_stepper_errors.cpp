// Problem: say what went wrong in a step, with names, and what would help.

#include <carom/integrators/run/failure_file.h>
#include <carom/integrators/time_stepping/time_stepper.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace carom {

namespace {

std::string place(const State& state, double step) {
  return "time stepping at t = " + to_text(state.time) + " s, step " + to_text(step) + " s: ";
}

bool all_finite(const std::vector<double>& numbers, Range range) {
  return std::all_of(numbers.begin() + range.begin, numbers.begin() + range.end,
                     [](double number) { return std::isfinite(number); });
}

SolverFailure failure_at(const State& state, double step) {
  SolverFailure failure;
  failure.time = state.time;
  failure.step = step;
  return failure;
}

SolverFailure failure_of(const IslandProblem& cluster, const Detector& detector, const State& state,
                         double step) {
  SolverFailure failure = failure_at(state, step);
  failure.residual = cluster.report().residual;
  for (const Constraint& contact : cluster.constraints()) failure.parts.push_back(detector.name(contact.key));
  failure.problem = std::make_shared<const ContactProblem>(cluster.problem());
  return failure;
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

}  // namespace

void check_options(const TimeStepping& options) {
  const auto refuse = [](const char* option, double value, const char* allowed) {
    throw ModelError(std::string("time stepping: ") + option + " is " + to_text(value) +
                     "; allowed: " + allowed_instead(value, allowed));
  };
  if (!(is_admissible(options.step) && options.step > 0.0)) refuse("step", options.step, "finite and > 0 s");
  if (!(is_admissible(options.tolerance) && options.tolerance >= 0.0)) {
    refuse("tolerance", options.tolerance, "finite and >= 0 m");
  }
  if (options.force_rule > ForceRule::energy_momentum) {
    refuse("force_rule", static_cast<double>(options.force_rule), "trapezoidal (0) or energy_momentum (1)");
  }
  if (options.iteration > Iteration::automatic) {
    refuse("iteration", static_cast<double>(options.iteration),
           "one of Iteration, fixed_point (0) to automatic (3)");
  }
  if (options.max_sweeps < 2) refuse("max_sweeps", options.max_sweeps, "at least 2");
  if (options.threads < 1) refuse("threads", options.threads, "at least 1");
  if (options.threads > 1 && !Workers::several_available()) {
    refuse("threads", options.threads, "1, for the library was built without oneTBB (CAROM_WITH_TBB)");
  }
  if (options.control) {
    const StepControl& control = *options.control;
    if (!(is_admissible(control.tolerance) && control.tolerance > 0.0)) {
      refuse("control.tolerance", control.tolerance, "finite and > 0 m");
    }
    if (!(is_admissible(control.smallest) && control.smallest > 0.0)) {
      refuse("control.smallest", control.smallest, "finite and > 0 s");
    }
    if (!(is_admissible(control.largest) && control.largest >= control.smallest)) {
      refuse("control.largest", control.largest, "finite and >= control.smallest");
    }
    if (!(options.step >= control.smallest && options.step <= control.largest)) {
      refuse("step", options.step, "between control.smallest and control.largest");
    }
  }
  if (!(is_admissible(options.capture_speed) && options.capture_speed >= 0.0)) {
    refuse("capture_speed", options.capture_speed, "finite and >= 0 m/s");
  }
  check_failure_directory(options.failure_directory, "time stepping");
}

void TimeStepper::demand_finite_loads(Index component, const StateView& at, const State& state, double step) {
  evaluate_positions(*assembly_, component, at, evaluation_);
  const ElementId cause = find_non_finite(*assembly_, component, at, evaluation_);
  if (!cause.valid()) return;
  SolverFailure failure = failure_at(state, step);
  failure.parts.push_back(assembly_->system().name(cause));
  const std::string message =
      place(state, step) + "the loads of " + failure.parts.front() + " are not finite";
  throw SolverError(message, std::move(failure));
}

void TimeStepper::find_cause(Index component, const State& state, const Companion& companion, double step,
                             int sweeps) {
  const Range q = assembly_->components()[component].q;
  const Range v = assembly_->components()[component].v;
  demand_finite_loads(component, state.view(), state, step);
  // The same sweeps once more, looking at the loads of every element between them. Loads may overflow only
  // because the iteration diverged; then no element is to blame.
  start_iteration(component, state, step);
  guess_loads(component, companion, step);
  for (int i = 0; i < sweeps; ++i) {
    sweep_all(component, state, companion, step);
    if (!all_finite(trial_.q, q) || !all_finite(trial_.v, v)) return;
    demand_finite_loads(component, trial_.view(), state, step);
    follow_iterate(component, state, step);
    evaluate_iterate(component, state, companion, step, LoadsAsked::total, false);
    evaluation_.force = loads_end_;
  }
}

void TimeStepper::fail_contraction(Index component, const State& state, const Companion& companion,
                                   double step, const FixedPointJudge& judge) {
  // The bound of the rating is pessimistic by itself; the rest is room for forces that stiffen on the way.
  constexpr double caution = 0.9;
  std::vector<std::string> jumping;
  for (std::size_t i = 0; i < clusters_in_use_; ++i) {
    if (!clusters_[i].changed_modes()) continue;
    for (const Constraint& contact : clusters_[i].constraints())
      jumping.push_back(detector_.name(contact.key));
  }
  const bool implicit = iteration_ == Iteration::linearly_implicit;
  if (!std::isfinite(judge.change())) {
    if (implicit) {
      demand_finite_loads(component, state.view(), state, step);
      // The iterates are lost as a whole; a law of time shows itself in the configuration of the start too.
      StateView at_end = state.view();
      at_end.time = trial_.time;
      demand_finite_loads(component, at_end, state, step);
    } else {
      find_cause(component, state, companion, step, judge.sweeps());
    }
  }

  SolverFailure failure = failure_at(state, step);
  failure.residual = judge.change();
  evaluate_positions(*assembly_, component, state.view(), evaluation_);
  const CouplingRating rating = rate_couplings(*assembly_, component, state.view(), evaluation_, step);
  std::string message = place(state, step) + "the " + std::string(to_string(iteration_)) +
                        " iteration does not contract after " + std::to_string(judge.sweeps()) +
                        " sweeps (last change " + to_text(judge.change()) + " m)";
  if (automatic()) message += ", nor do the Anderson and the linearly implicit iteration";
  if (rating.worst.valid()) {
    failure.parts.push_back(assembly_->system().name(rating.worst));
    failure.suggested_step = std::min(caution * rating.contracting_step, 0.5 * step);
    message += "; limited most by " + failure.parts.front() + " (rate " + to_text(rating.rate) + ")";
  }
  if (jointed(component)) {
    double violation = 0.0;
    const JointId joint = worst_joint(component, violation);
    if (joint.valid()) {
      failure.parts.push_back(assembly_->system().name(joint));
      message += "; of the joints " + failure.parts.back() + " is violated most, by " + to_text(violation);
    }
  }
  if (rating.component_rate >= 1.0) {
    message += "; a step of " + to_text(failure.suggested_step) + " s would contract";
    if (!implicit && !automatic()) message += ", as would the linearly implicit iteration";
  } else {
    // The rates do not explain it: a force or an answer of contact jumps, or a force stiffens on the way.
    message += "; by their derivatives at its start the force elements contract (rate " +
               to_text(rating.component_rate) + " together), so a force jumps or stiffens";
    if (jointed(component)) {
      failure.suggested_step = 0.5 * step;
      message += ", or the joints turn far within the step or are near a singular position";
    }
    if (!jumping.empty()) message += ", or contact does, which changes between modes: " + listed(jumping);
    failure.parts.insert(failure.parts.end(), jumping.begin(), jumping.end());
  }
  throw SolverError(message, std::move(failure));
}

void TimeStepper::fail_motion(const SolverError& error, const State& state, double step) {
  SolverFailure failure = error.failure();
  failure.time = state.time;
  failure.step = step;
  throw SolverError(place(state, step) + error.what(), std::move(failure));
}

void TimeStepper::fail_contact(Index component, const IslandProblem& cluster, const State& state,
                               double step) {
  SolverFailure failure = failure_of(cluster, detector_, state, step);
  const auto b = cluster.problem().vector();
  const bool finite = std::all_of(b.begin(), b.end(), [](double number) { return std::isfinite(number); });
  // Loads that are not finite reach the contact first; the iterate before, if there was one, is still there.
  if (!finite) {
    demand_finite_loads(component, state.view(), state, step);
    if (swept_) demand_finite_loads(component, trial_.view(), state, step);
  }
  std::string message = place(state, step) + "contact problem of " + listed(failure.parts) + ": ";
  if (cluster.report().usable()) {
    message += "friction in joints and the forces that bound it do not settle";
  } else {
    message += to_string(cluster.report().outcome);
    if (!cluster.report().reason.empty()) message.append(" (").append(cluster.report().reason).append(")");
    message += ", residual " + to_text(cluster.report().residual) + driven_by(*assembly_, component);
  }
  if (!tentative_) message += write_failure(options_.failure_directory, failure, message);
  throw SolverError(message, std::move(failure));
}

void TimeStepper::fail_account(Index component, const State& state, double step) {
  demand_finite_loads(component, trial_.view(), state, step);
  evaluate_positions(*assembly_, component, trial_.view(), evaluation_);
  const ElementId cause = find_non_finite_potential(*assembly_, component, trial_.view(), evaluation_);
  SolverFailure failure = failure_at(state, step);
  std::string message = place(state, step);
  if (cause.valid()) {
    failure.parts.push_back(assembly_->system().name(cause));
    message += "the potential of " + failure.parts.front() + " is not finite";
  } else {
    message += "an energy is too large to be counted";
  }
  throw SolverError(message, std::move(failure));
}

void TimeStepper::fail_internal(ElementId element, const State& state, double step) const {
  SolverFailure failure = failure_at(state, step);
  failure.parts.push_back(assembly_->system().name(element));
  const std::string message =
      place(state, step) + "the internal variables of " + failure.parts.front() + " cannot be advanced";
  throw SolverError(message, std::move(failure));
}

void TimeStepper::fail_linearisation(Index component, const State& state, double step, const char* why) {
  evaluate_positions(*assembly_, component, state.view(), evaluation_);
  const CouplingRating rating = rate_couplings(*assembly_, component, state.view(), evaluation_, step);
  demand_finite_loads(component, state.view(), state, step);
  SolverFailure failure = failure_at(state, step);
  failure.suggested_step = 0.5 * step;
  std::string message = place(state, step) + "the matrix of the linearly implicit iteration " + why;
  if (rating.worst.valid()) {
    failure.parts.push_back(assembly_->system().name(rating.worst));
    message += "; stiffest is " + failure.parts.front() + " (rate " + to_text(rating.rate) + ")";
  }
  throw SolverError(message, std::move(failure));
}

void TimeStepper::fail_projection(const Constraint& left, const State& state, double step) const {
  SolverFailure failure = failure_at(state, step);
  failure.residual = -left.gap;
  failure.parts.push_back(detector_.name(left.key));
  const std::string message = place(state, step) + "project_gaps: no displacement brings " +
                              failure.parts.front() + " out, gap " + to_text(left.gap) + " m";
  throw SolverError(message, std::move(failure));
}

void TimeStepper::refuse_gain(const IslandProblem& cluster, double gain, const State& state,
                              double step) const {
  SolverFailure failure = failure_of(cluster, detector_, state, step);
  std::string message = place(state, step) + "contact of " + listed(failure.parts) + " adds " +
                        to_text(gain) + " J; allowed: no gain (refuse_energy_gain is set; use e_n = e_t)";
  message += write_failure(options_.failure_directory, failure, message);
  throw SolverError(message, std::move(failure));
}

}  // namespace carom
