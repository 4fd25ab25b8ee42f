// Problem: a fault of the search for events must not pass for a motion.

#include <carom/core/errors.h>
#include <carom/integrators/event_driven/overlap_check.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace carom {

OverlapCheck::OverlapCheck(const Assembly& assembly, const Detector& detector, const EventDriven& options)
    : assembly_(&assembly), detector_(&detector), options_(&options) {
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

/// Component by component: of many contacts that last hardly any are kept at a time.
void OverlapCheck::demand_apart(const State& state, const Evaluation& evaluation, double from) {
  const double allowed_gap = -allowed(state);
  detector_->place(state.time, places_);
  const ContactQuery query{state.view(), evaluation, places_};
  found_.clear();
  double deepest = allowed_gap;
  ConstraintKey worst;
  const auto judge = [&] {
    for (const Constraint& at : found_) {
      if (at.type != ConstraintType::contact || at.gap >= deepest) continue;
      deepest = at.gap;
      worst = at.key;
    }
    found_.clear();
  };
  const auto components = static_cast<Index>(assembly_->components().size());
  for (Index component = 0; component < components; ++component) {
    detector_->find(Range{component, component + 1}, query, found_);
    judge();
  }
  if (detector_->bodies_touch()) detector_->bodies().find(query, search_, found_);
  judge();
  if (deepest == allowed_gap) return;
  SolverFailure failure;
  failure.time = from;
  failure.step = state.time - from;
  failure.parts.push_back(detector_->name(worst));
  const std::string what = "event-driven at t = " + to_text(state.time) + " s: gap of " +
                           failure.parts.front() + " is " + to_text(deepest) + " m; allowed: not below " +
                           to_text(allowed_gap) + " m. Its closing was missed";
  throw SolverError(what, std::move(failure));
}

}  // namespace carom
