// Problem: begin a run with bodies side by side, or say by name which are not.

#include <carom/core/dynamics/components_response.h>
#include <carom/core/dynamics/joint_closure.h>
#include <carom/core/errors.h>
#include <carom/integrators/time_stepping/gap_projection.h>
#include <carom/integrators/time_stepping/start_overlap.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace carom {

namespace {

/// All bodies of a state, and where the ground is.
struct AllBodies {
  AllBodies(const Assembly& model, const Detector& of_contacts, const State& state)
      : assembly(model), detector(of_contacts), evaluation(make_evaluation(model)) {
    detector.place(state.time, places);
    evaluate_positions(assembly, state.view(), evaluation);
  }
  [[nodiscard]] Range components() const { return {0, static_cast<Index>(assembly.components().size())}; }

  const Assembly& assembly;
  const Detector& detector;
  GroundPlaces places;
  Evaluation evaluation;
};

[[noreturn]] void refuse(const Detector& detector, const Constraint& contact, double largest) {
  throw ModelError("time stepping: gap of " + detector.name(contact.key) + " is " + to_text(contact.gap) +
                   " m at the start; allowed: not below -overlaps.largest_at_start, " + to_text(-largest) +
                   " m, or overlaps.separate_at_start");
}

void demand_depth(const AllBodies& all, const State& state, double largest) {
  std::vector<Constraint> contacts;
  BodyContactSearch search;
  all.detector.find_all({state.view(), all.evaluation, all.places}, search, contacts);
  const auto deepest =
      std::min_element(contacts.begin(), contacts.end(),
                       [](const Constraint& a, const Constraint& b) { return a.gap < b.gap; });
  if (deepest != contacts.end() && deepest->gap < -largest) refuse(all.detector, *deepest, largest);
}

/// Moves all bodies by the least displacement.
double separate(AllBodies& all, State& state) {
  std::vector<JointConstraints> joints;
  for (Index component = 0; component < all.assembly.components().size(); ++component) {
    append_constraints(all.assembly, component, joints);
  }
  const std::vector<JointConstraints*> bound = addresses_of(joints);
  GapProjection projection;
  SolverChain chain;
  const GapProjection::Result result = projection.project(
      {all.assembly, all.detector, all.places, all.components(), bound},
      {.all = true, .of_bodies = all.detector.bodies_touch()}, chain, state, all.evaluation);
  if (result.left != nullptr) {
    throw ModelError("time stepping: overlaps.separate_at_start: no displacement brings " +
                     all.detector.name(result.left->key) + " apart, gap " + to_text(result.left->gap) +
                     " m; allowed: bodies that have room");
  }
  if (!result.moved || joints.empty()) return result.shift;
  return std::max(result.shift, close_joints(all.assembly, state).shift);
}

}  // namespace

double prepare_overlaps(const Assembly& assembly, const Detector& detector, const TimeStepping& options,
                        State& state) {
  const bool asked = options.overlaps.largest_at_start || options.overlaps.separate_at_start;
  if (!asked || assembly.components().empty()) return 0.0;
  AllBodies all(assembly, detector, state);
  if (!options.overlaps.separate_at_start) {
    demand_depth(all, state, *options.overlaps.largest_at_start);
    return 0.0;
  }
  State trial = state;
  const double shift = separate(all, trial);
  state = std::move(trial);
  return shift;
}

}  // namespace carom
