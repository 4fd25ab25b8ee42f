// Problem: say what went wrong in a step, with names, and what would help.

#include <carom/contact/pressed_bodies.h>
#include <carom/contact/strike.h>
#include <carom/core/dynamics/prescribed_joints.h>
#include <carom/core/listed.h>
#include <carom/core/run_error.h>
#include <carom/integrators/run/failure_file.h>
#include <carom/integrators/time_stepping/step_errors.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace carom {

namespace {

bool all_finite(const std::vector<double>& numbers, Range range) {
  return std::all_of(numbers.begin() + range.begin, numbers.begin() + range.end,
                     [](double number) { return std::isfinite(number); });
}

std::string place(const StepInput& in) {
  return "time stepping at t = " + to_text(in.start.time) + " s, step " + to_text(in.step) + " s: ";
}

/// Names of the contacts of a problem for a message: that where the residual is taken first.
std::string contacts_of(const IslandProblem& problem, const SolverFailure& failure) {
  return listed(worst_first(failure.parts, problem.report().worst_group));
}

[[noreturn]] void refuse(const char* option, double value, const char* allowed) {
  throw ModelError(std::string("time stepping: ") + option + " is " + to_text(value) +
                   "; allowed: " + allowed_instead(value, allowed));
}

void check_control(const StepControl& control, double step) {
  if (!(is_admissible(control.tolerance) && control.tolerance > 0.0)) {
    refuse("control.tolerance", control.tolerance, "finite and > 0 m");
  }
  if (!(is_admissible(control.smallest) && control.smallest > 0.0)) {
    refuse("control.smallest", control.smallest, "finite and > 0 s");
  }
  if (!(is_admissible(control.largest) && control.largest >= control.smallest)) {
    refuse("control.largest", control.largest, "finite and >= control.smallest");
  }
  if (!(step >= control.smallest && step <= control.largest)) {
    refuse("step", step, "between control.smallest and control.largest");
  }
}

void check_budget(const SweepBudget& budget) {
  if (!(is_admissible(budget.residual) && budget.residual > 0.0)) {
    refuse("contact_budget.residual", budget.residual, "finite and > 0");
  }
  if (budget.sweeps < 1) refuse("contact_budget.sweeps", budget.sweeps, "at least 1");
  if (!(is_admissible(budget.accepted) && budget.accepted >= 0.0)) {
    refuse("contact_budget.accepted", budget.accepted, "finite and >= 0");
  }
}

/// Options that do not go together.
void check_exclusions(const TimeStepping& options) {
  if (options.overlaps.never_tunnel && (options.control || options.impacts == ImpactTimes::located)) {
    throw ModelError(std::string("time stepping: overlaps.never_tunnel is true; allowed where ") +
                     (options.control ? "control is given" : "impacts is located") + ": false");
  }
}

/// Components whose bodies a contact problem moves, each once: whatever drives one of them pushes the others.
std::vector<Index> components_of(const Assembly& assembly, const IslandProblem& problem) {
  std::vector<Index> found;
  for (const Constraint& constraint : problem.constraints()) {
    for (int b = 0; b < constraint.bodies; ++b) {
      found.push_back(assembly.component_of(constraint.blocks[static_cast<std::size_t>(b)].body));
    }
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

}  // namespace

void check_options(const TimeStepping& options) {
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
  if (options.impacts > ImpactTimes::located) {
    refuse("impacts", static_cast<double>(options.impacts), "at_step_start (0) or located (1)");
  }
  if (options.most_impacts < 1) refuse("most_impacts", options.most_impacts, "at least 1");
  if (options.max_sweeps < 2) refuse("max_sweeps", options.max_sweeps, "at least 2");
  if (options.threads < 1) refuse("threads", options.threads, "at least 1");
  if (options.threads > 1 && !Workers::several_available()) {
    refuse("threads", options.threads, "1, for the library was built without oneTBB (CAROM_WITH_TBB)");
  }
  if (options.control) check_control(*options.control, options.step);
  if (!(is_admissible(options.capture_speed) && options.capture_speed >= 0.0)) {
    refuse("capture_speed", options.capture_speed, "finite and >= 0 m/s");
  }
  const std::optional<double>& overlap = options.overlaps.largest_at_start;
  if (overlap && !(is_admissible(*overlap) && *overlap >= 0.0)) {
    refuse("overlaps.largest_at_start", *overlap, "finite and >= 0 m");
  }
  check_budget(options.contact_budget);
  check_rules(options.impact_rules, "time stepping");
  check_exclusions(options);
  check_failure_directory(options.failure_directory, "time stepping");
}

RunError with_place(const RunError& error, const StepInput& in) {
  if (error.failure().step > 0.0) return error;
  SolverFailure failure = error.failure();
  failure.time = in.start.time;
  failure.step = in.step;
  return {place(in) + error.what(), std::move(failure)};
}

RunError with_file(const RunError& error, const TimeStepping& options) {
  if (error.failure().problem == nullptr) return error;
  const std::string message = error.what();
  return {message + write_failure(options.failure_directory, error.failure(), message), error.failure()};
}

SolverFailure StepErrors::failure() const {
  SolverFailure failure;
  failure.time = in_.start.time;
  failure.step = in_.step;
  return failure;
}

void StepErrors::fail(const std::string& what, SolverFailure& failure) const {
  throw RunError(place(in_) + what, std::move(failure));
}

SolverFailure StepErrors::failure_of(const IslandProblem& problem) const {
  SolverFailure failure = this->failure();
  failure.residual = problem.report().residual;
  for (const Constraint& contact : problem.constraints())
    failure.parts.push_back(detector_.name(contact.key));
  failure.problem = std::make_shared<const ContactProblem>(problem.problem());
  return failure;
}

void StepErrors::demand_finite_loads(const StateView& at) const {
  evaluate_positions(in_.assembly, component_, at, trial_.at_end);
  const ElementId cause = find_non_finite(in_.assembly, component_, at, trial_.at_end);
  if (!cause.valid()) return;
  SolverFailure failure = this->failure();
  failure.parts.push_back(system().name(cause));
  fail("the loads of " + failure.parts.front() + " are not finite", failure);
}

/// Throws if an element has loads that are not finite: at the start, or at the last iterate, whose bodies are
/// still where loads can be asked for. Loads may overflow only because the iteration diverged; then no
/// element is to blame.
void StepErrors::find_cause(bool implicit) const {
  const Component& all = in_.assembly.components()[component_];
  demand_finite_loads(in_.start.view());
  if (!implicit && all_finite(trial_.end.q, all.q) && all_finite(trial_.end.v, all.v)) {
    demand_finite_loads(trial_.end.view());
  }
  // Where the iterates are lost, a law of time shows itself in the configuration of the start too.
  StateView at_end = in_.start.view();
  at_end.time = in_.end_time;
  demand_finite_loads(at_end);
}

void StepErrors::fail_contact(const IslandProblem& problem) const {
  SolverFailure failure = failure_of(problem);
  const auto b = problem.problem().vector();
  const bool finite = std::all_of(b.begin(), b.end(), [](double number) { return std::isfinite(number); });
  // Loads that are not finite reach the contact first; the iterate before, if there was one, is still there.
  if (!finite) {
    demand_finite_loads(in_.start.view());
    if (trial_.account.swept) demand_finite_loads(trial_.end.view());
  }
  std::string message = "contact problem of " + contacts_of(problem, failure) + ": ";
  if (problem.report().usable()) {
    message += unsettled_friction;
  } else {
    message += to_string(problem.report().outcome);
    if (!problem.report().reason.empty()) message.append(" (").append(problem.report().reason).append(")");
    message += ", residual " + to_text(problem.report().residual) +
               driven_by(in_.assembly, components_of(in_.assembly, problem)) +
               pressed_by(system(), problem.constraints()) + carried_by(system(), problem.constraints()) +
               uneven_masses(problem) + hint_at_jams(options_.impact_rules, problem.constraints().size());
  }
  fail(message, failure);
}

void StepErrors::fail_account(Range components) const {
  for (Index component = components.begin; component < components.end; ++component) {
    StoredEnergies stored;
    evaluate_positions(in_.assembly, component, trial_.end.view(), trial_.at_end);
    add_stored_energies(in_.assembly, component, trial_.end.view(), trial_.at_end, stored);
    if (std::isfinite(stored.total())) continue;
    StepErrors(in_, component, detector_, options_, trial_).fail_account();
  }
  fail_account();
}

void StepErrors::fail_account() const {
  demand_finite_loads(trial_.end.view());
  const ElementId cause =
      find_non_finite_potential(in_.assembly, component_, trial_.end.view(), trial_.at_end);
  SolverFailure failure = this->failure();
  if (!cause.valid()) fail("an energy is too large to be counted", failure);
  failure.parts.push_back(system().name(cause));
  fail("the potential of " + failure.parts.front() + " is not finite", failure);
}

void StepErrors::fail_internal(ElementId element) const {
  SolverFailure failure = this->failure();
  failure.parts.push_back(system().name(element));
  fail("the internal variables of " + failure.parts.front() + " cannot be advanced", failure);
}

void StepErrors::fail_projection(const Constraint& left) const {
  SolverFailure failure = this->failure();
  failure.residual = -left.gap;
  failure.parts.push_back(detector_.name(left.key));
  fail("project_gaps: no displacement brings " + failure.parts.front() + " out, gap " + to_text(left.gap) +
           " m",
       failure);
}

void StepErrors::fail_impacts(const IslandProblem& problem, const std::string& what) const {
  SolverFailure failure = failure_of(problem);
  fail(what + "; of " + contacts_of(problem, failure), failure);
}

void StepErrors::refuse_gain(const IslandProblem& problem, double gain) const {
  SolverFailure failure = failure_of(problem);
  fail(gain_is_refused("contact of " + listed(failure.parts), gain), failure);
}

}  // namespace carom
