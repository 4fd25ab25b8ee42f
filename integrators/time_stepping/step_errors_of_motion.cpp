// Problem: say why the end that an iteration has found is no motion from the start of the step.

#include <carom/core/dynamics/light_bodies.h>
#include <carom/core/listed.h>
#include <carom/core/system.h>
#include <carom/integrators/time_stepping/far_turn.h>
#include <carom/integrators/time_stepping/step_errors.h>

#include <algorithm>
#include <string>

namespace carom {

/// The body that turns farthest, and a step in which that is not far.
std::string StepErrors::tell_turn(SolverFailure& failure) const {
  // A turn in a step, beyond which rows at its start say little of those at its end [rad].
  constexpr double far = 0.2;
  const FastestTurn fastest = fastest_turn(in_, component_);
  failure.suggested_step = 0.5 * in_.step;
  if (!(fastest.angle > far)) return {};
  failure.suggested_step = std::min(failure.suggested_step, far / fastest.angle * in_.step);
  failure.parts.push_back(system().name(fastest.body));
  return " (" + failure.parts.back() + " by " + to_text(fastest.angle) + " rad)";
}

void StepErrors::fail_stray(const StrayBody& stray) const {
  SolverFailure failure = this->failure();
  failure.residual = stray.back;
  failure.parts.push_back(system().name(stray.body));
  const std::string turn = tell_turn(failure);
  const std::string& body = failure.parts.front();
  fail(
      "joints turn too far within the step" + turn + ": " + body + " would be moved back onto them by " +
          to_text(stray.back) + " m, by more than " + to_text(stray.allowed) +
          " m, a fifth of the longest way of a body; allowed: a step in which they turn less, for instance " +
          to_text(failure.suggested_step) + " s",
      failure);
}

void StepErrors::fail_open(JointId joint, double gap) const {
  SolverFailure failure = this->failure();
  failure.residual = gap;
  failure.parts.push_back(system().name(joint));
  const std::string turn = tell_turn(failure), name = failure.parts.front();
  const std::string light = light_bodies(in_.assembly, component_, failure.parts);
  fail(name + " stays open by " + to_text(failure.residual) + " at the end of the step" + turn +
           "; allowed: a step in which bodies move less, for instance " + to_text(failure.suggested_step) +
           " s" + light,
       failure);
}

void StepErrors::fail_gain(double gain) const {
  SolverFailure failure = this->failure();
  failure.residual = gain;
  BodyId fastest;
  double largest = 0.0;
  const Layout& layout = *in_.assembly.layout();
  for (Index body = 0; body < layout.bodies().size(); ++body) {
    const BodySlot slot = layout.bodies()[body];
    const double kinetic = in_.assembly.body_kinds()[slot.kind]->kinetic_energy({slot.slot, slot.slot + 1},
                                                                                trial_.end.v.data() + slot.v);
    if (!(kinetic > largest)) continue;
    largest = kinetic;
    fastest = layout.id(body);
  }
  if (fastest.valid()) failure.parts.push_back(system().name(fastest));
  failure.suggested_step = 0.5 * in_.step;
  fail("the step gains " + to_text(gain) + " J that no load explains, most of it in " +
           listed(failure.parts, 1) +
           ": forces change too much within it; allowed: a shorter step, for instance " +
           to_text(failure.suggested_step) + " s",
       failure);
}

}  // namespace carom
