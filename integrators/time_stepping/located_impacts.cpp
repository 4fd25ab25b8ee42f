// Problem: which bodies are hit within a step.

#include <carom/integrators/time_stepping/located_impacts.h>

#include <algorithm>

namespace carom {

LocatedImpacts::LocatedImpacts(const Assembly& assembly, const Detector& detector,
                               const TimeStepping& options)
    : assembly_(&assembly),
      detector_(&detector),
      on_(options.impacts == ImpactTimes::located),
      most_impacts_(options.most_impacts),
      capture_speed_(options.capture_speed) {}

void LocatedImpacts::clear() {
  in_use_ = 0;
  order_.clear();
}

std::size_t LocatedImpacts::place(Index body) const {
  const auto before = [](const auto& entry, Index of) { return entry.first < of; };
  return static_cast<std::size_t>(std::lower_bound(order_.begin(), order_.end(), body, before) -
                                  order_.begin());
}

bool LocatedImpacts::contains(Index body) const {
  const std::size_t at = place(body);
  return at < order_.size() && order_[at].first == body;
}

std::span<const Constraint> LocatedImpacts::of_body(std::span<const Constraint> contacts, Index body) const {
  const auto before = [](const Constraint& contact, Index of) { return contact.body() < of; };
  const auto first = std::lower_bound(contacts.begin(), contacts.end(), body, before);
  auto last = first;
  while (last != contacts.end() && last->body() == body) ++last;
  return {first, last};
}

bool LocatedImpacts::take_up(const StepInput& in, Range components, std::span<const Constraint> contacts,
                             const GroundPlaces& places, StepTrial& trial) {
  const StateView end = trial.end.view();
  if (detector_->needs_rotations()) {
    for (Index component = components.begin; component < components.end; ++component) {
      evaluate_positions(*assembly_, component, end, trial.at_end);
    }
  }
  found_.clear();
  detector_->find(components, {end, trial.at_end, places}, found_);
  const std::size_t known = in_use_;
  for (const Constraint& contact : found_) {
    if (contact.gap == 0.0 && !(contact.normal_velocity(end.v) < 0.0)) continue;
    const std::span<const Constraint> own = of_body(contacts, contact.body());
    const auto is_same = [&](const Constraint& other) { return other.key == contact.key; };
    if (std::none_of(own.begin(), own.end(), is_same)) take_up(contact.body(), own, false, trial);
  }
  const Range bodies = assembly_->bodies_of(components);
  for (const Constraint& contact : contacts) {
    if (contact.body() < bodies.begin || contact.body() >= bodies.end) continue;
    if (!(contact.normal_velocity(in.start.v.data()) < -capture_speed_)) continue;
    take_up(contact.body(), of_body(contacts, contact.body()), true, trial);
  }
  return in_use_ > known;
}

/// A body that shares a constraint with another keeps to the step of both.
void LocatedImpacts::take_up(Index body, std::span<const Constraint> contacts, bool struck,
                             StepTrial& trial) {
  const std::size_t at = place(body);
  if (at < order_.size() && order_[at].first == body) return;
  const auto is_shared = [](const Constraint& contact) { return contact.bodies > 1; };
  if (std::any_of(contacts.begin(), contacts.end(), is_shared)) return;
  if (in_use_ == motions_.size()) motions_.emplace_back();
  trial.expect_impulses();
  order_.insert(order_.begin() + static_cast<std::ptrdiff_t>(at), {body, in_use_});
  motions_[in_use_++].begin(body, contacts, struck);
}

void LocatedImpacts::advance(const StepInput& in, const StepRule& rule, const LinearLoads& loads,
                             Range bodies, StepTrial& trial) {
  for (std::size_t at = place(bodies.begin); at < order_.size() && order_[at].first < bodies.end; ++at) {
    motions_[order_[at].second].advance({in, rule, *detector_, loads, most_impacts_, trial});
  }
}

const IslandProblem* LocatedImpacts::first_unsolved() const {
  for (const auto& [body, motion] : order_) {
    if (motions_[motion].failed() != nullptr) return motions_[motion].failed();
  }
  return nullptr;
}

void LocatedImpacts::correct_works(const StepInput& in, const StepRule& rule, Range bodies,
                                   StepTrial& trial) const {
  const auto correction = [&](const LocatedMotion& motion, const LinearLoads& loads) {
    return motion.work(in, loads) - rule.work(in, loads.start, loads.end, motion.velocities(in), trial);
  };
  const auto by_cause = [&](const std::vector<double>& start, const std::vector<double>& end,
                            const LocatedMotion& motion) {
    if (end.empty()) return 0.0;
    return correction(motion, {rule.is_mean() ? end.data() : start.data(), end.data()});
  };
  BlockWorks& sum = trial.account.works.front();
  const PresentLoads& start = in.companion.loads;
  for (std::size_t i = 0; i < in_use_; ++i) {
    const LocatedMotion& motion = motions_[i];
    if (motion.body() < bodies.begin || motion.body() >= bodies.end) continue;
    sum.total += correction(motion, {rule.start_of_sum(in, trial), trial.loads_guess.data()});
    sum.dissipative += by_cause(start.dissipative, trial.loads_end.dissipative, motion);
    sum.external += by_cause(start.external, trial.loads_end.external, motion);
  }
}

void LocatedImpacts::forget_statistics() {
  for (LocatedMotion& motion : motions_) motion.chain().reset_statistics();
}

void LocatedImpacts::add_statistics(ChainStatistics& sum) {
  for (LocatedMotion& motion : motions_) {
    if (motion.chain().statistics().problems == 0) continue;
    sum += motion.chain().statistics();
    motion.chain().reset_statistics();
  }
}

}  // namespace carom
