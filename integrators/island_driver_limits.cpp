// Problem: a run that gets nowhere ends, and says what keeps it.

#include <carom/integrators/coupling_rating.h>
#include <carom/integrators/island_driver.h>
#include <carom/integrators/time_resolution.h>

#include <string>

namespace carom {

void IslandDriver::advance(double target, DriverNews& news) {
  try {
    go_to(target, news);
  } catch (const EvaluationLimit::Reached&) {
    fail("more than " + std::to_string(options_.evaluation_limit) +
             " evaluations within one step or event (evaluation_limit)",
         {});
  }
}

/// The flow makes no longer steps; a target that these cannot reach is refused before any are made.
void IslandDriver::demand_time(double target) const {
  if (longest_step() >= shortest_step_at(target)) return;
  fail("steps of at most " + to_text(longest_step()) + " s are lost in the rounding of times around " +
           to_text(target) + " s, the end",
       {});
}

void IslandDriver::count_step() {
  if (!steps_.exceeds(options_.step_limit, time_)) return;
  const std::string what =
      "more than " + to_text(options_.step_limit) + " steps of the integrator per second (step_limit)";
  motion_.evaluate(time_, y_.data(), true);
  const MotionWorkspace& work = work_->motion;
  const CouplingRating rating = rate_couplings(*assembly_, motion_.island(), work.trial.view(),
                                               work.evaluation, 1.0 / options_.step_limit);
  if (!rating.worst.valid()) fail(what, {});
  fail(what + ", stiffest is", {assembly_->system().name(rating.worst)});
}

}  // namespace carom
