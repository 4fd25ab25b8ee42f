// Problem: a fault of the search for events must not pass for a motion.

#include <carom/contact/pressed_bodies.h>
#include <carom/core/run_error.h>
#include <carom/integrators/event_driven/overlap_check.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>

namespace carom {

OverlapCheck::OverlapCheck(const Assembly& assembly, const Detector& detector, const EventDriven& options)
    : assembly_(&assembly), detector_(&detector), options_(&options) {}

double allowed_overlap(const EventDriven& options, std::span<const double> places, double speed,
                       double time) {
  constexpr double tolerances = 10.0;  // output within a step is less exact than its end
  // Both bodies of a contact move, and times of events are found to a few roundings.
  constexpr double resolution = 16.0 * std::numeric_limits<double>::epsilon();
  double size = 0.0;
  for (const double place : places) size = std::max(size, std::abs(place));
  const double of_integrator = options.relative_tolerance * size + options.absolute_tolerance;
  return tolerances * (options.gap_tolerance + of_integrator) + resolution * std::abs(time) * speed;
}

namespace {

std::string uneven_masses_of(const Assembly& assembly) {
  MassRange masses;
  for (const BodySlot& slot : assembly.layout()->bodies())
    masses.add(assembly.body_kinds()[slot.kind]->mass(slot.slot));
  return uneven_masses(masses);
}

std::string tell_overlap(const std::string& contact, double gap, double allowed) {
  return "gap of " + contact + " is " + to_text(gap) + " m; allowed: not below " + to_text(allowed) +
         " m. Its closing was missed";
}

}  // namespace

void refuse_start(const std::string& contact, double gap, double tolerance) {
  throw ModelError("event-driven mode: gap of " + contact + " is " + to_text(gap) +
                   " m at the start; allowed: not below -gap_tolerance, " + to_text(-tolerance) + " m");
}

void demand_apart(const EventInstant& at, const GroupFailure& failure) {
  const GroupModel& model = at.motion.model();
  const Constraint* deepest = nullptr;
  for (const Constraint& contact : at.contacts) {
    if (contact.key.is_of_joint() || !(contact.gap < (deepest ? deepest->gap : 0.0))) continue;
    deepest = &contact;
  }
  if (deepest == nullptr || deepest->gap >= -model.options->gap_tolerance) return;
  const double allowed =
      -allowed_overlap(*model.options, at.y.first(model.unknowns.q_size()), at.scales.speed, at.time);
  if (deepest->gap >= allowed) return;
  const std::string name = failure.name(*deepest);
  failure.fail(tell_overlap(name, deepest->gap, allowed), {name});
}

/// Component by component: of many contacts that last hardly any are kept at a time.
OverlapCheck::Deepest OverlapCheck::find_deepest(const State& state, const Evaluation& evaluation,
                                                 double limit) {
  detector_->place(state.time, places_);
  const ContactQuery query{state.view(), evaluation, places_};
  found_.clear();
  Deepest deepest{.gap = limit};
  const auto judge = [&] {
    for (const Constraint& at : found_) {
      if (at.key.is_of_joint() || at.gap >= deepest.gap) continue;
      deepest = {.key = at.key, .gap = at.gap, .is_deeper = true};
    }
    found_.clear();
  };
  const auto components = static_cast<Index>(assembly_->components().size());
  for (Index component = 0; component < components; ++component) {
    detector_->find(Range{component, component + 1}, query, found_);
    judge();
  }
  detector_->find_between_bodies(query, search_, found_);
  judge();
  return deepest;
}

void OverlapCheck::demand_start(const State& state, const Evaluation& evaluation) {
  const Deepest deepest = find_deepest(state, evaluation, -options_->gap_tolerance);
  if (deepest.is_deeper) refuse_start(detector_->name(deepest.key), deepest.gap, options_->gap_tolerance);
}

void OverlapCheck::demand_apart(const State& state, const Evaluation& evaluation,
                                const std::vector<double>& lengths, double from) {
  double speed = 0.0;
  for (std::size_t i = 0; i < state.v.size(); ++i) speed = std::max(speed, std::abs(state.v[i]) * lengths[i]);
  const double allowed = -allowed_overlap(*options_, state.q, speed, state.time);
  const Deepest deepest = find_deepest(state, evaluation, allowed);
  if (!deepest.is_deeper) return;
  SolverFailure failure;
  failure.time = from;
  failure.step = state.time - from;
  failure.parts.push_back(detector_->name(deepest.key));
  const std::string what = "event-driven at t = " + to_text(state.time) +
                           " s: " + tell_overlap(failure.parts.front(), deepest.gap, allowed) +
                           uneven_masses_of(*assembly_);
  throw RunError(what, std::move(failure));
}

}  // namespace carom
