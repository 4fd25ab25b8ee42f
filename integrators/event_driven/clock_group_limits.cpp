// Problem: a run that gets nowhere ends, and says what keeps it.

#include <carom/core/dynamics/coupling_rating.h>
#include <carom/integrators/event_driven/clock_group.h>
#include <carom/integrators/run/time_resolution.h>

#include <string>
#include <utility>
#include <vector>

namespace carom {

namespace {

/// Names of the joints that almost follow from others where joints were last evaluated: near a singular
/// position, which the motion passes within some 0.01 rad; empty elsewhere.
std::vector<std::string> nearly_singular(const JointConstraints& joints, const System& system) {
  constexpr double near_pivot = 1e-4;  // the square of an angle
  std::vector<std::string> names;
  for (std::size_t joint = 0; joint < joints.joints(); ++joint) {
    for (Index row = joints.first_row(joint); row < joints.first_row(joint + 1); ++row) {
      const double pivot = joints.factors().pivot(row);
      if (!(pivot > dependent_pivot && pivot < near_pivot)) continue;
      names.push_back(system.name(joints.joint(row)));
      break;
    }
  }
  return names;
}

}  // namespace

void ClockGroup::advance(double target, EventBalance& balance) {
  try {
    go_to(target, balance);
  } catch (const EvaluationLimit::Reached&) {
    fail("more than " + std::to_string(options_.evaluation_limit) +
             " evaluations within one step or event (evaluation_limit)",
         {});
  }
}

/// The flow makes no longer steps; a target that these cannot reach is refused before any are made.
void ClockGroup::demand_time(double target) const {
  if (longest_step() >= shortest_step_at(target)) return;
  fail("steps of at most " + to_text(longest_step()) + " s are lost in the rounding of times around " +
           to_text(target) + " s, the end",
       {});
}

void ClockGroup::count_step() {
  if (!steps_.exceeds(options_.step_limit, time_)) return;
  const std::string what =
      "more than " + to_text(options_.step_limit) + " steps of the integrator per second (step_limit)";
  motion_.evaluate(time_, y_.data(), true);
  std::vector<std::string> singular = nearly_singular(motion_.joints(), assembly_->system());
  if (!singular.empty()) fail(what + "; near a singular position of the joints", std::move(singular));
  const MotionWorkspace& work = work_->motion;
  const CouplingRating rating = rate_couplings(*assembly_, motion_.component(), work.trial.view(),
                                               work.evaluation, 1.0 / options_.step_limit);
  if (!rating.worst.valid()) fail(what, {});
  fail(what + ", stiffest is", {assembly_->system().name(rating.worst)});
}

}  // namespace carom
