// Problem: which bodies are hit within a step.

#include <carom/integrators/time_stepping/contact_stage.h>
#include <carom/integrators/time_stepping/gap_rounding.h>
#include <carom/integrators/time_stepping/located_impacts.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace carom {

namespace {

/// Acceleration of the gap of a contact of one body by the loads at the start of a step [m/s^2].
double acceleration_by_loads(const StepInput& in, const Constraint& contact) {
  const BodySlot slot = in.assembly.layout()->bodies()[contact.body()];
  std::array<double, 6> acceleration{};
  in.assembly.body_kinds()[slot.kind]->apply_inverse_mass(
      {slot.slot, slot.slot + 1}, in.companion.loads.total.data() + slot.v, acceleration.data());
  double sum = contact.drift[0];
  for (Index i = 0; i < slot.v_size; ++i) sum += contact.row(0)[i] * acceleration[i];
  return sum;
}

/// True if a contact hits its body at the start of a step and rebounds: it is fast, or it has not acted so
/// far and nothing presses it.
bool hits(const StepInput& in, const Constraint& contact, const CaptureRule& rule) {
  const double rate = contact.normal_velocity(in.start.v.data());
  if (rule.is_fast(rate)) return true;
  if (!(rate < -rule.slowest) || contact.bodies != 1) return false;
  const ContactModes& modes = in.companion.modes;
  if (std::any_of(modes.begin(), modes.end(), [&](const auto& entry) {
        return entry.first == contact.key && entry.second != ContactMode::open;
      })) {
    return false;
  }
  return rule.is_free(rate, acceleration_by_loads(in, contact));
}

/// True if a contact hits its body at the start of a step, or holds it where it turns.
bool acts_within(const StepInput& in, const Constraint& contact, const LocatedRules& rules) {
  return contact.turns(in.step, rules.turning) || hits(in, contact, rules.capture);
}

/// How many contacts of one body each some bodies have.
std::size_t count_of(Range bodies, std::span<const Constraint> contacts) {
  const auto is_own = [&](const Constraint& at) {
    return at.bodies == 1 && at.body() >= bodies.begin && at.body() < bodies.end;
  };
  return static_cast<std::size_t>(std::count_if(contacts.begin(), contacts.end(), is_own));
}

}  // namespace

LocatedImpacts::LocatedImpacts(const StepModel& model)
    : assembly_(&model.assembly),
      detector_(&model.detector),
      jumps_(model.assembly),
      on_(model.follows_bodies),
      of_one_piece_(!model.detector.outlines().ground_touches() && model.detector.joints().empty()),
      rules_{model.options.most_impacts, CaptureRule::of(model.assembly, model.options),
             gap_rounding(model.assembly, model.options), turning_rounding(model.options),
             model.options.impact_rules},
      budget_(budget_of(model.options)) {}

std::size_t LocatedImpacts::place(Index body) const {
  const auto before = [](const auto& entry, Index of) { return entry.first < of; };
  return static_cast<std::size_t>(std::lower_bound(order_.begin(), order_.end(), body, before) -
                                  order_.begin());
}

bool LocatedImpacts::contains_any(Range bodies) const {
  const std::size_t at = place(bodies.begin);
  return at < order_.size() && order_[at].first < bodies.end;
}

/// Lists the contacts of an island by body; one of two bodies is listed for both.
void LocatedImpacts::list(std::span<const Constraint> contacts) {
  island_.contacts = contacts;
  island_.of_bodies.clear();
  island_.next = 0;
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    for (int b = 0; b < contacts[c].bodies; ++b) {
      island_.of_bodies.emplace_back(contacts[c].blocks[static_cast<std::size_t>(b)].body, c);
    }
  }
  if (!std::is_sorted(island_.of_bodies.begin(), island_.of_bodies.end()))
    std::sort(island_.of_bodies.begin(), island_.of_bodies.end());
}

/// Those of one body.
std::span<const LocatedImpacts::OfBody> LocatedImpacts::of(Index body) {
  const std::vector<OfBody>& all = island_.of_bodies;
  const auto before = [](const OfBody& entry, Index of) { return entry.first < of; };
  auto first = all.begin() + static_cast<std::ptrdiff_t>(island_.next);
  const bool follows = first == all.begin() || before(*(first - 1), body);
  if (!follows || (first != all.end() && before(*first, body))) {
    first = std::lower_bound(all.begin(), all.end(), body, before);
  }
  auto last = first;
  while (last != all.end() && last->first == body) ++last;
  island_.next = static_cast<std::size_t>(last - all.begin());
  return {first, last};
}

void LocatedImpacts::expect(const StepInput& in, Index component, std::span<const Constraint> contacts,
                            const GroundPlaces& places, StepTrial& trial) {
  const Component& all = assembly_->components()[component];
  double fastest = 0.0;
  for (Index i = all.v.begin; i < all.v.end; ++i) fastest = std::max(fastest, std::abs(in.start.v[i]));
  const StateView start = in.start.view();
  list(contacts);
  found_.clear();
  detector_->find({component, component + 1},
                  {start, trial.at_start, places, nullptr, 2.0 * in.step * fastest}, found_);
  for (const Constraint& contact : found_) {
    if (contact.gap + in.step * contact.normal_velocity(start.v) < 0.0) take_up_new(in, contact, trial);
  }
  take_up_held(in, all.bodies, trial);
}

bool LocatedImpacts::take_up(const StepInput& in, Range components, std::span<const Constraint> contacts,
                             const GroundPlaces& places, StepTrial& trial) {
  const Range bodies = assembly_->bodies_of(components);
  // Where all that bodies can touch takes part nothing else can hit them.
  const bool all_take_part =
      of_one_piece_ && count_of(bodies, contacts) == detector_->points().count_pairs(components);
  const bool any_held = std::any_of(contacts.begin(), contacts.end(), [&](const Constraint& contact) {
    return acts_within(in, contact, rules_);
  });
  if (all_take_part && !any_held) return false;
  list(contacts);
  const std::size_t known = in_use_;
  if (!all_take_part) find_new(in, components, contacts, places, trial);
  if (any_held) take_up_held(in, bodies, trial);
  return in_use_ > known;
}

/// Takes up bodies that something touches at the end of the iterate though not at its start.
void LocatedImpacts::find_new(const StepInput& in, Range components, std::span<const Constraint> contacts,
                              const GroundPlaces& places, StepTrial& trial) {
  const StateView end = trial.end.view();
  if (detector_->needs_rotations()) {
    for (Index component = components.begin; component < components.end; ++component) {
      evaluate_positions(*assembly_, component, end, trial.at_end);
    }
  }
  found_.clear();
  const auto is_known = [&](Index body, const ConstraintKey& key) { return takes_part(body, key); };
  ContactQuery query{end, trial.at_end, places};
  if (!contacts.empty()) query.leaves_out = is_known;
  detector_->find(components, query, found_);
  for (const Constraint& contact : found_) {
    if (contact.gap == 0.0 && !(contact.normal_velocity(end.v) < 0.0)) continue;
    take_up_new(in, contact, trial);
  }
}

/// True of a contact that takes part from the start on.
bool LocatedImpacts::takes_part(Index body, const ConstraintKey& key) {
  const std::span<const OfBody> own = of(body);
  return std::any_of(own.begin(), own.end(),
                     [&](const OfBody& of) { return island_.contacts[of.second].key == key; });
}

/// The body of a contact, unless that takes part from the start on.
void LocatedImpacts::take_up_new(const StepInput& in, const Constraint& contact, StepTrial& trial) {
  if (!takes_part(contact.body(), contact.key)) take_up(in, contact.body(), trial);
}

/// Bodies that contacts hit at the start, or hold where they turn.
void LocatedImpacts::take_up_held(const StepInput& in, Range bodies, StepTrial& trial) {
  for (const Constraint& contact : island_.contacts) {
    if (contact.body() < bodies.begin || contact.body() >= bodies.end) continue;
    if (acts_within(in, contact, rules_)) take_up(in, contact.body(), trial);
  }
}

/// A body that shares a constraint with another keeps to the step of both.
void LocatedImpacts::take_up(const StepInput& in, Index body, StepTrial& trial) {
  const std::size_t at = place(body);
  if (at < order_.size() && order_[at].first == body) return;
  island_.own.clear();
  for (const auto& [of, contact] : of(body)) {
    if (island_.contacts[contact].bodies > 1) return;
    island_.own.add(island_.contacts[contact]);
  }
  if (in_use_ == motions_.size()) motions_.emplace_back().chain().set_budget(budget_);
  trial.expect_impulses();
  order_.insert(order_.begin() + static_cast<std::ptrdiff_t>(at), {body, in_use_});
  const bool struck = std::any_of(island_.own.begin(), island_.own.end(), [&](const Constraint& contact) {
    return hits(in, contact, rules_.capture);
  });
  motions_[in_use_++].begin(body, island_.own, struck);
}

void LocatedImpacts::advance(const StepInput& in, const StepRule& rule, const StepLoads& loads, Range bodies,
                             StepTrial& trial) {
  for (std::size_t at = place(bodies.begin); at < order_.size() && order_[at].first < bodies.end; ++at) {
    motions_[order_[at].second].advance({in, rule, *detector_, loads, rules_, trial});
  }
}

const IslandProblem* LocatedImpacts::first_unsolved() const {
  for (const auto& [body, motion] : order_) {
    if (motions_[motion].failed() != nullptr) return motions_[motion].failed();
  }
  return nullptr;
}

bool LocatedImpacts::any_hit() const {
  return std::any_of(motions_.begin(), motions_.begin() + static_cast<std::ptrdiff_t>(in_use_),
                     [](const LocatedMotion& motion) { return motion.is_hit(); });
}

std::span<const LocatedMotion* const> LocatedImpacts::motions_of(Range bodies) {
  of_bodies_.clear();
  for (std::size_t at = place(bodies.begin); at < order_.size() && order_[at].first < bodies.end; ++at) {
    of_bodies_.push_back(&motions_[order_[at].second]);
  }
  return of_bodies_;
}

void LocatedImpacts::add_mean(const StepInput& in, Index component, StepTrial& trial) {
  for (const LocatedMotion* motion : motions_of(assembly_->components()[component].bodies)) {
    const Range v = motion->velocities(in);
    for (const MotionPhase& phase : motion->phases()) {
      if (!phase.is_impact()) continue;
      for (Index i = 0; i < v.size(); ++i)
        trial.midpoint.v[v.begin + i] += (0.5 - phase.begin) * (phase.v1[i] - phase.v0[i]);
    }
  }
}

bool LocatedImpacts::update_jumps(const StepInput& in, const StepRule& rule, Index component, bool only_local,
                                  double tolerance, StepTrial& trial) {
  const Range bodies = assembly_->components()[component].bodies;
  return jumps_.update({in, rule, component, motions_of(bodies), tolerance}, only_local, trial);
}

/// Works of the loads of a cause along the flights, less those that its block has been given. Of loads that
/// jump the correction is booked as dissipative: it is of loads that depend on velocities. Mean loads have
/// it.
void LocatedImpacts::correct_works(const StepInput& in, const StepRule& rule, Range bodies,
                                   StepTrial& trial) {
  BlockWorks& sum = trial.account.works.front();
  const LoadJumps& jumps = trial.jumps;
  const std::vector<double>&dissipative = trial.loads_end.dissipative, &external = trial.loads_end.external;
  const PresentLoads& start = in.companion.loads;
  const auto first = [&](const std::vector<double>& at_start, const std::vector<double>& at_end) {
    return rule.is_mean() ? at_end.data() : at_start.data();
  };
  const auto of_jumps = [&](Range v) {
    return 0.5 * rule.work(in, jumps.correction.data(), jumps.correction.data(), v, trial);
  };
  const bool jump = jumps.on && !dissipative.empty(), corrected = jump && !rule.is_mean();
  if (corrected) {
    const Index component = assembly_->component_of(bodies.begin);
    sum.dissipative += of_jumps(assembly_->components()[component].v);
  }
  for (const LocatedMotion* of_body : motions_of(bodies)) {
    const LocatedMotion& motion = *of_body;
    const Range v = motion.velocities(in);
    const auto over_step = [&](const double* a, const double* b) { return rule.work(in, a, b, v, trial); };
    sum.total += motion.work(in, step_loads(in, rule, trial)) -
                 over_step(rule.start_of_sum(in, trial), trial.loads_guess.data());
    if (!dissipative.empty()) {
      StepLoads loads{.start = first(start.dissipative, dissipative),
                      .end = dissipative.data(),
                      .is_mean = rule.is_mean()};
      sum.dissipative -= over_step(loads.start, loads.end);
      if (jump) {
        loads.jump = jumps.jump.data();
        loads.correction = jumps.correction.data();
        if (corrected) sum.dissipative -= of_jumps(v);
      }
      sum.dissipative += motion.work(in, loads);
    }
    if (external.empty()) continue;
    const StepLoads loads{.start = first(start.external, external), .end = external.data()};
    sum.external += motion.work(in, loads) - over_step(loads.start, loads.end);
  }
}

double LocatedImpacts::work_of_flights(const StepInput& in, const StepRule& rule, Range bodies,
                                       const StepTrial& trial) {
  double sum = 0.0;
  const double* const loads = in.companion.loads.total.data();
  for (const LocatedMotion* motion : motions_of(bodies)) {
    sum += motion->work(in, {loads, loads}) - rule.work_constant(in, motion->velocities(in), trial);
  }
  return sum;
}

void LocatedImpacts::forget_statistics() {
  for (LocatedMotion& motion : motions_) motion.chain().reset_statistics();
}

void LocatedImpacts::add_statistics(ChainStatistics& sum) {
  for (LocatedMotion& motion : motions_) motion.chain().take_statistics(sum);
}

}  // namespace carom
