// Problem: a fault of the search for events must not pass for a motion.

#include <carom/core/errors.h>
#include <carom/integrators/event_driven/overlap_check.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace carom {

OverlapCheck::OverlapCheck(const Detector& detector, const EventDriven& options)
    : detector_(&detector), options_(&options) {
  constexpr std::size_t few = 8;
  found_.reserve(few);
}

double OverlapCheck::allowed(const State& state) const {
  constexpr double tolerances = 10.0;  // output within a step is less exact than its end
  double size = 0.0;
  for (const double place : state.q) size = std::max(size, std::abs(place));
  const double of_integrator = options_->relative_tolerance * size + options_->absolute_tolerance;
  return tolerances * (options_->gap_tolerance + of_integrator);
}

void OverlapCheck::demand_apart(const State& state, const Evaluation& evaluation, double from) {
  const double deepest = allowed(state);
  detector_->place(state.time, places_);
  found_.clear();
  detector_->find_all({state.view(), evaluation, places_}, search_, found_);
  const Constraint* worst = nullptr;
  for (const Constraint& at : found_) {
    if (at.type != ConstraintType::contact || at.gap >= -deepest) continue;
    if (worst == nullptr || at.gap < worst->gap) worst = &at;
  }
  if (worst == nullptr) return;
  SolverFailure failure;
  failure.time = from;
  failure.step = state.time - from;
  failure.parts.push_back(detector_->name(worst->key));
  const std::string what = "event-driven at t = " + to_text(state.time) + " s: gap of " +
                           failure.parts.front() + " is " + to_text(worst->gap) + " m; allowed: not below " +
                           to_text(-deepest) + " m. Its closing was missed";
  throw SolverError(what, std::move(failure));
}

}  // namespace carom
