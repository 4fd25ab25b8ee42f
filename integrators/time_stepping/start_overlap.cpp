// Problem: begin a run with bodies side by side, or say by name which are not.

#include <carom/contact/assembly_gaps.h>
#include <carom/contact/detection/contact_look.h>
#include <carom/contact/separation.h>
#include <carom/core/dynamics/joint_closure.h>
#include <carom/core/errors.h>
#include <carom/integrators/time_stepping/start_overlap.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace carom {

namespace {

[[noreturn]] void refuse(const Detector& detector, const Constraint& contact, double largest) {
  throw ModelError("time stepping: gap of " + detector.name(contact.key) + " is " + to_text(contact.gap) +
                   " m at the start; allowed: not below -overlaps.largest_at_start, " + to_text(-largest) +
                   " m, or overlaps.separate_at_start");
}

void demand_depth(const Assembly& assembly, const Detector& detector, const State& state, double largest) {
  ConstraintSet contacts;
  ContactLook(assembly, detector).find(state.view(), 0.0, contacts);
  const auto deepest =
      std::min_element(contacts.begin(), contacts.end(),
                       [](const Constraint& a, const Constraint& b) { return a.gap < b.gap; });
  if (deepest != contacts.end() && deepest->gap < -largest) refuse(detector, *deepest, largest);
}

/// Moves all bodies by the least displacement. Returns the largest [m].
double separate_at_start(const Assembly& assembly, const Detector& detector, State& state) {
  GroundPlaces places;
  detector.place(state.time, places);
  Evaluation evaluation = make_evaluation(assembly);
  evaluate_positions(assembly, state.view(), evaluation);
  AssemblyGaps gaps;
  SolverChain chain;
  const Separation result = separate_all(assembly, detector, places, gaps, chain, state, evaluation);
  if (result.left != nullptr) {
    throw ModelError("time stepping: overlaps.separate_at_start: no displacement brings " +
                     detector.name(result.left->key) + " apart, gap " + to_text(result.left->gap) +
                     " m; allowed: bodies that have room");
  }
  if (!result.moved) return result.shift;
  return std::max(result.shift, close_joints(assembly, state).shift);
}

}  // namespace

double prepare_overlaps(const Assembly& assembly, const Detector& detector, const TimeStepping& options,
                        State& state) {
  const bool asked = options.overlaps.largest_at_start || options.overlaps.separate_at_start;
  if (!asked || assembly.components().empty()) return 0.0;
  if (!options.overlaps.separate_at_start) {
    demand_depth(assembly, detector, state, *options.overlaps.largest_at_start);
    return 0.0;
  }
  State trial = state;
  const double shift = separate_at_start(assembly, detector, trial);
  state = std::move(trial);
  return shift;
}

}  // namespace carom
