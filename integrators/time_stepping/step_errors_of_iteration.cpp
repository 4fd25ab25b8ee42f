// Problem: say why an iteration of a step does not contract, and which step would.

#include <carom/core/dynamics/light_bodies.h>
#include <carom/core/listed.h>
#include <carom/integrators/time_stepping/step_errors.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace carom {

namespace {

constexpr std::size_t most_names = 12;  // of a pile all the same says nothing

}  // namespace

/// The coupling of some components that limits the contraction most.
CouplingRating StepErrors::rate(std::span<const Index> components) const {
  CouplingRating worst;
  for (const Index component : components) {
    evaluate_positions(in_.assembly, component, in_.start.view(), trial_.at_end);
    const CouplingRating own =
        rate_couplings(in_.assembly, component, in_.start.view(), trial_.at_end, in_.step);
    if (!own.worst.valid()) continue;
    const double step =
        worst.worst.valid() ? std::min(worst.contracting_step, own.contracting_step) : own.contracting_step;
    const double rate = std::max(worst.component_rate, own.component_rate);
    if (own.rate > worst.rate || !worst.worst.valid()) worst = own;
    worst.contracting_step = step;
    worst.component_rate = rate;
  }
  return worst;
}

/// The joint of an island that is violated most.
std::string StepErrors::tell_joints(const FailedIsland& island, SolverFailure& failure) const {
  double largest = 0.0;
  JointId worst;
  for (const Index component : island.components) {
    const JointStage* const joints = island.joints.of(component);
    double violation = 0.0;
    const JointId joint = joints == nullptr ? JointId{} : joints->worst_joint(violation);
    if (!joint.valid() || !(violation > largest)) continue;
    largest = violation;
    worst = joint;
  }
  if (!worst.valid()) return {};
  failure.parts.push_back(system().name(worst));
  return "; of the joints " + failure.parts.back() + " is violated most, by " + to_text(largest);
}

/// The reason why an iteration fails although the derivatives of the loads say that it contracts.
std::string StepErrors::tell_jumps(const FailedIsland& island, SolverFailure& failure) const {
  std::string message = "a force jumps or stiffens";
  for (const Index component : island.components) {
    if (island.joints.of(component) == nullptr) continue;
    message += ", or the joints turn far within the step" +
               StepErrors(in_, component, detector_, options_, trial_).tell_turn(failure) +
               " or are near a singular position";
    break;
  }
  std::vector<std::string> jumping, touching;
  for (const IslandProblem& problem : island.problems) {
    for (const Constraint& contact : problem.constraints()) {
      touching.push_back(detector_.name(contact.key));
      if (problem.changed_modes()) jumping.push_back(touching.back());
    }
  }
  if (!jumping.empty())
    message += ", or contact does, which changes between modes: " + listed(jumping, most_names);
  if (jumping.empty() && failure.parts.empty() && !touching.empty()) {
    message += ", in contact: " + listed(touching, most_names);
    jumping = touching;
  }
  failure.parts.insert(failure.parts.end(), jumping.begin(), jumping.end());
  return message;
}

/// Light bodies of mechanisms, whose motion may have no digits left.
std::string StepErrors::tell_light_bodies(const FailedIsland& island, SolverFailure& failure) const {
  std::string light;
  for (const Index component : island.components) {
    if (island.joints.of(component) != nullptr) light += light_bodies(in_.assembly, component, failure.parts);
  }
  if (light.empty() || options_.force_rule != ForceRule::trapezoidal) return light;
  return light +
         " (allowed: masses nearer to each other, or force_rule energy_momentum, under which bodies that "
         "swing "
         "fast keep their energy)";
}

void StepErrors::fail_contraction(const FixedPointJudge& judge, Iteration iteration,
                                  const FailedIsland& island) const {
  // The bound of the rating is pessimistic by itself; the rest is room for forces that stiffen on the way.
  constexpr double caution = 0.9;
  const bool implicit = iteration == Iteration::linearly_implicit;
  const bool automatic = options_.iteration == Iteration::automatic;
  if (!std::isfinite(judge.change())) {
    for (const Index component : island.components) {
      StepErrors(in_, component, detector_, options_, trial_).find_cause(implicit);
    }
  }
  SolverFailure failure = this->failure();
  failure.residual = judge.change();
  const CouplingRating rating = rate(island.components);
  std::string message = "the " + std::string(to_string(iteration)) + " iteration does not contract after " +
                        std::to_string(judge.sweeps()) + " sweeps (last change " + to_text(judge.change()) +
                        " m)";
  if (automatic) message += ", nor do the Anderson and the linearly implicit iteration";
  if (rating.worst.valid()) {
    failure.parts.push_back(system().name(rating.worst));
    failure.suggested_step = std::min(caution * rating.contracting_step, 0.5 * in_.step);
    message += "; limited most by " + failure.parts.front() + " (rate " + to_text(rating.rate) + ")";
  }
  message += tell_joints(island, failure);
  const std::string light = tell_light_bodies(island, failure);
  if (rating.component_rate >= 1.0) {
    message += "; a step of " + to_text(failure.suggested_step) + " s would contract";
    if (!implicit && !automatic) message += ", as would the linearly implicit iteration";
  } else if (light.empty()) {
    // The rates do not explain it: a force or an answer of contact jumps, or a force stiffens on the way.
    message += "; by their derivatives at its start the force elements contract (rate " +
               to_text(rating.component_rate) + " together), so " + tell_jumps(island, failure);
  }
  fail(message + light, failure);
}

void StepErrors::fail_linearisation(std::span<const Index> components) const {
  const CouplingRating rating = rate(components);
  for (const Index component : components) {
    StepErrors(in_, component, detector_, options_, trial_).demand_finite_loads(in_.start.view());
  }
  SolverFailure failure = this->failure();
  failure.suggested_step = 0.5 * in_.step;
  std::string message = "the matrix of the linearly implicit iteration is singular";
  if (rating.worst.valid()) {
    failure.parts.push_back(system().name(rating.worst));
    message += "; stiffest is " + failure.parts.front() + " (rate " + to_text(rating.rate) + ")";
  }
  fail(message, failure);
}

}  // namespace carom
