// Problem: modes of all that touches, where events have just ended some, and forces may not exist.

#include <carom/contact/detection/pair_rows.h>
#include <carom/contact/detection/rolling_resistance.h>
#include <carom/contact/frame_of_contact.h>
#include <carom/contact/pressed_bodies.h>
#include <carom/core/dynamics/answering_bodies.h>
#include <carom/integrators/event_driven/dead_points.h>
#include <carom/integrators/event_driven/mode_selection.h>
#include <carom/integrators/run/time_resolution.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace carom {

namespace {

/// Acceleration of the ground at a contact along its rows: 0 where it does not move [m/s^2].
std::array<double, 2> acceleration_of_ground(const Constraint& contact, const EventInstant& at) {
  const GroupModel& model = at.motion.model();
  const GroundMotion* const motion = ground_motion_of(*model.detector, contact, at.now.places);
  if (motion == nullptr || contact.attached) return {};
  const BodySlot slot = model.assembly->layout()->bodies()[contact.body()];
  const ContactFrame place = frame_of_contact(contact, at.now.state.q.data() + slot.q);
  const Vec<2> acceleration =
      PairSide::of_motion(*motion, 0.0).acceleration_at({place.point[0], place.point[1]});
  const double *const n = contact.row(0), *const t = contact.row(1);
  return {n[0] * acceleration[0] + n[1] * acceleration[1], t[0] * acceleration[0] + t[1] * acceleration[1]};
}

/// The contacts of candidates that nothing keeps. Ground that turns round stands still and presses all the
/// same: its acceleration stands for its velocity then.
ConstraintSet unkept_contacts(std::span<const Candidate> candidates, const EventInstant& at) {
  ConstraintSet contacts;
  for (const Candidate& candidate : candidates) {
    Constraint& contact = contacts.add(candidate.at);
    const std::array<double, 2> acceleration = acceleration_of_ground(contact, at);
    for (std::size_t row = 0; row < acceleration.size(); ++row) {
      double& velocity = contact.surface_velocity_after[row];
      if (velocity == 0.0) velocity = acceleration[row];
    }
  }
  return contacts;
}

}  // namespace

void ModeSelection::start() {
  forget_ends();
  unbounded_->clear();
}

void ModeSelection::forget_ends() {
  exhausted_.clear();
  releasing_.clear();
  stopped_ = {};
}

void ModeSelection::note(const Event& event, ActiveSet& active, double noise) {
  // Events of several bodies at one instant are resolved one after the other: ends of contacts stay ends. So
  // does a force that ends again at the next times there are: where all loads vanish, it is rounding.
  if (!(event.time - ended_at_ <= shortest_step_at(event.time))) {
    exhausted_.clear();
    releasing_.clear();
  }
  ended_at_ = event.time;
  const std::vector<ActiveContact>& closed = active.list();
  stopped_ = event.guard == Guard::slip ? closed[event.which].pair : ContactPair{};
  if (event.guard != Guard::force) return;
  active.margins(memory_->margins);
  const ForceMargin& at = memory_->margins[event.which];
  for (std::size_t i = at.first; i < at.last; ++i) {
    const ActiveContact& c = closed[i];
    if (!c.sets_margin) continue;
    if (c.at.normals > 0 && c.normal <= at.margin + noise && c.normal <= noise) {
      releasing_.push_back(c.pair);
    } else if (c.sticks() &&
               c.margin_scale() * (c.friction * c.normal - c.tangential_force()) <= at.margin + noise) {
      exhausted_.push_back({c.pair, c.tangential[0], noise});
    }
  }
}

void ModeSelection::take(const ModeSelection& other, double time) {
  if (other.ended_at_ != time) return;
  // Parts of one group remember the same: no end counts twice.
  for (const ExhaustedFriction& end : other.exhausted_) {
    const auto known = std::ranges::find(exhausted_, end.pair, &ExhaustedFriction::pair);
    if (known == exhausted_.end()) exhausted_.push_back(end);
  }
  for (const ContactPair& end : other.releasing_) {
    if (std::ranges::count(releasing_, end) < std::ranges::count(other.releasing_, end))
      releasing_.push_back(end);
  }
  ended_at_ = time;
  if (other.stopped_ != ContactPair{}) stopped_ = other.stopped_;
}

void ModeSelection::select(EventInstant& at) {
  constexpr int most_rounds = 100;  // impacts without collision change the candidates
  at.motion.active().list().clear();
  for (std::size_t island = 0; island < at.islands.size(); ++island) {
    const std::span<const Index> pairs = at.islands.pairs(island);
    int rounds = 0;
    while (!select_island(pairs, at)) {
      if (++rounds < most_rounds) continue;
      failure_->fail("impacts without collision do not come to an end",
                     {failure_->name(at.contacts[pairs.front()])});
    }
  }
  record_changes(at);
  stopped_ = {};
}

/// False if an impact without collision happened, or slow contacts were settled in its place: then everything
/// is to be decided anew.
bool ModeSelection::select_island(std::span<const Index> pairs, EventInstant& at) {
  collect_candidates(pairs, at);
  if (memory_->candidates.empty()) return true;
  Decision decision = decide_candidates(pairs, at);
  const bool found = decision == Decision::made || decision == Decision::several;
  if (found && leave_dead_points(memory_->decision, at, memory_->candidates))
    decision = decide_candidates(pairs, at);
  if (decision == Decision::impossible || decision == Decision::failed) {
    failure_->demand_finite_loads(at.now);
    // Where forces are neither found nor excluded, the limit of an impact may find either: closed contacts in
    // line stand within rounding of a singular position, on one side of which there are no forces and on the
    // other ones without bound; and of many contacts not all modes are enumerated.
    if ((decision == Decision::impossible || any_slides()) && strike(pairs, at)) {
      unbounded_->clear();
      stopped_ = {};
      return false;
    }
    decision = decide_by_limit(decision, at);
  }
  if (decision == Decision::several) record_choice(at);
  close_candidates(at.motion.active());
  return true;
}

/// Settles what is slow, or solves an impact without collision. False if there is none.
bool ModeSelection::strike(std::span<const Index> pairs, EventInstant& at) {
  if (impacts_->settle(pairs, at)) return true;
  if (!memory_->impact.resolve(memory_->candidates, *impacts_, *chain_, at)) return false;
  impacts_->settle(at);
  return true;
}

/// Modes by forces that the search for an impact without collision came to. The problem of accelerations had
/// an answer in which impulses stop what slides; of several answers this is another one. Fails where there
/// are none. \param decision without them
Decision ModeSelection::decide_by_limit(Decision decision, EventInstant& at) {
  const std::span<const ForceOnCandidate> forces = memory_->impact.forces();
  const bool searched = decision == Decision::impossible || any_slides();
  if (searched && !forces.empty() && !has_unbounded_force()) {
    const Decision by_forces = memory_->decision.decide_by(forces, at.motion, at.now, memory_->candidates);
    if (by_forces != Decision::failed) return by_forces;
  }
  if (decision == Decision::impossible) fail_unkept(at);
  const bool by_joints = std::ranges::any_of(memory_->candidates, [&](const Candidate& candidate) {
    return at.motion.joints().depends_on_joint_force(candidate.at);
  });
  const std::string why = by_joints ? std::string("; ") + unsettled_friction : std::string{};
  const ConstraintSet unkept = unkept_contacts(memory_->candidates, at);
  failure_->fail("the contact problem of the accelerations is not solved" + why, failure_->names(unkept),
                 &memory_->decision.problem(), unkept);
}

/// True if a contact slides.
bool ModeSelection::any_slides() const {
  const auto slides = [](const Candidate& at) { return at.slip != 0.0 && at.at.normals > 0; };
  return std::ranges::any_of(memory_->candidates, slides);
}

void ModeSelection::collect_candidates(std::span<const Index> pairs, const EventInstant& at) {
  std::vector<Candidate>& candidates = memory_->candidates;
  constexpr std::size_t few = 8;
  candidates.clear();
  candidates.reserve(std::min(pairs.size(), few));
  const double speed_noise = at.scales.speed_noise;
  const double* const velocity = at.velocities();
  for (const Index i : pairs) {
    const Constraint& contact = at.contacts[i];
    const bool rolling = at.motion.model().pairs[i].rolling;
    if (rolling && (candidates.empty() || candidates.back().place + 1 != i)) continue;
    if (!at.touches(i) || contact.normal_velocity(velocity) > speed_noise) continue;
    Candidate& candidate = candidates.emplace_back();
    candidate.pair = at.motion.model().pairs[i];
    candidate.place = i;
    candidate.at = contact;
    take_coming_feature(at, candidate);
    if (contact.normals == 0) candidate.stiffness = std::numeric_limits<double>::infinity();
    const double slip = contact.tangential_velocity(velocity);
    const double noise = at.scales.noise_of(at.motion, contact);
    const bool rests = candidate.pair == stopped_ || (!rolling && at.is_stopped(i, slip));
    candidate.slip = std::abs(slip) > noise && !rests ? slip : 0.0;
    candidate.frictionless = contact.law.sticking_friction() == 0.0;
    if (at.before_at[i] != none) candidate.present = at.before[at.before_at[i]].mode;
    const auto exhausted = std::ranges::find(exhausted_, candidate.pair, &ExhaustedFriction::pair);
    if (exhausted != exhausted_.end()) {
      candidate.starts_slipping = true;
      candidate.exhausted_friction = exhausted->force;
      candidate.noise = exhausted->noise;
    }
    const auto ends = std::count(releasing_.begin(), releasing_.end(), candidate.pair);
    candidate.releases = ends > 0;
    candidate.stays_open = ends > 1;
  }
}

/// At the border of two features the rows are the same, and their rates are not: what is decided is to hold
/// for the feature that the motion comes to.
void ModeSelection::take_coming_feature(const EventInstant& at, Candidate& candidate) {
  if (!candidate.pair.has_outline()) return;
  const FeatureRegions regions = at.motion.regions(candidate.pair, at.now);
  if (regions.is_sharp() || !regions.has_several()) return;
  const Index feature = regions.coming(at.scales.speed_noise, margin_noise(at.scales));
  if (feature == regions.nearest()) return;
  follow(*at.motion.model().detector, candidate.pair, feature, at.now.view(), at.now.evaluation,
         at.now.places, candidate.at);
}

bool ModeSelection::has_unbounded_force() const {
  const auto contains = [&](const Candidate& candidate) { return unbounded_->contains(candidate.pair); };
  return std::ranges::any_of(memory_->candidates, contains);
}

Decision ModeSelection::decide(EventInstant& at) {
  return memory_->decision.decide(at.motion, at.now, memory_->candidates, *chain_);
}

/// Modes of the candidates collected. States before and behind p = 0 cannot be told from each other where
/// time, or the contact problem, has no numbers in between. Then friction is taken for as much larger as it
/// takes to be behind.
Decision ModeSelection::decide_candidates(std::span<const Index> pairs, EventInstant& at) {
  const bool unbounded = has_unbounded_force();
  if (!unbounded) {
    const Decision decision = decide(at);
    if (decision != Decision::failed) return decision;
  }
  if (decide_by_excess(pairs, at) == Decision::impossible) return Decision::impossible;
  collect_candidates(pairs, at);
  // Where larger friction leaves forces too, sliding stops at once: an impact as well.
  return unbounded ? Decision::impossible : decide(at);
}

/// Fails where neither forces nor an impact without collision keep the candidates.
void ModeSelection::fail_unkept(const EventInstant& at) const {
  const char* const what = "no forces keep the contact, and no impact without collision does";
  const ConstraintSet unkept = unkept_contacts(memory_->candidates, at);
  failure_->fail(has_unbounded_force()
                     ? unbounded_->reason() + "; forces of contact grow without bound (Painleve); " + what
                     : what,
                 failure_->names(unkept), &memory_->impact.problem(), unkept);
}

/// `impossible` if friction that is larger by little leaves no forces; `failed` otherwise.
Decision ModeSelection::decide_by_excess(std::span<const Index> pairs, EventInstant& at) {
  constexpr double least_excess = 1e-12, growth = 4.0;
  for (double excess = least_excess; excess * UnboundedForces::growth <= 1.0; excess *= growth) {
    collect_candidates(pairs, at);
    for (Candidate& candidate : memory_->candidates) {
      if (candidate.slip == 0.0 || candidate.at.normals == 0) continue;
      Surface& law = candidate.at.law;
      law.friction = (1.0 + excess) * law.sliding_friction(std::abs(candidate.slip));
      law.static_friction = candidate.at.friction = law.friction;
    }
    if (decide(at) == Decision::impossible) return Decision::impossible;
  }
  return Decision::failed;
}

void ModeSelection::close_candidates(ActiveSet& active) const {
  if (active.list().empty()) active.list().reserve(memory_->candidates.size());
  for (const Candidate& candidate : memory_->candidates) {
    if (candidate.mode == ContactMode::open) continue;
    ActiveContact& closed = active.list().emplace_back();
    closed.pair = candidate.pair;
    closed.place = candidate.place;
    closed.mode = candidate.mode;
    closed.frictionless = candidate.frictionless;
    closed.at = candidate.at;
  }
}

/// Writes the motions of the bodies of a contact into its record, where records are kept.
void ModeSelection::note_motions(const Constraint& contact, const EventInstant& at, EventRecord& event) {
  if (at.balance.keeping.records)
    event.motions = motions_of(contact, at.now.view(), *at.motion.model().assembly);
}

/// Records the choice among several accelerations.
void ModeSelection::record_choice(EventInstant& at) const {
  const ContactReport& report = memory_->decision.problem().report();
  for (const Candidate& candidate : memory_->candidates) {
    if (!(candidate.stiffness <= 0.0)) continue;
    EventRecord& event = at.balance.record(EventKind::several_accelerations, at.time, candidate.at,
                                           *at.motion.model().assembly);
    note_motions(candidate.at, at, event);
    event.stiffness = candidate.stiffness;
    event.free_acceleration = candidate.free_acceleration;
    event.mode = candidate.mode;
    event.outcome = report.outcome;
    event.residual = report.residual;
    event.solver = report.solver;
  }
}

/// Records which contacts changed their mode.
void ModeSelection::record_changes(EventInstant& at) const {
  const double* const velocity = at.velocities();
  const GroupModel& model = at.motion.model();
  const std::vector<ActiveContact>& active = at.motion.active().list();
  const auto change = [&](EventKind kind, const Constraint& contact, ContactMode mode) {
    EventRecord& event = at.balance.record(kind, at.time, contact, *model.assembly);
    for (int row = 0; row < contact.rows; ++row) {
      event.velocity_before[static_cast<std::size_t>(row)] =
          event.velocity_after[static_cast<std::size_t>(row)] =
              contact.velocity(row, velocity) / contact.of_joint.length;
    }
    note_motions(contact, at, event);
    event.energy_before = event.energy_after =
        kinetic_energy_of_answering(*model.assembly, {&contact, 1}, velocity);
    event.mode = mode;
  };
  std::vector<char>& is_active = memory_->is_active;
  is_active.assign(model.pairs.size(), 0);
  for (const ActiveContact& contact : active) is_active[contact.place] = 1;
  for (const ActiveContact& contact : at.before) {
    if (is_active[contact.place] == 0 && !contact.at.attached)
      change(EventKind::lift_off, contact.at, ContactMode::open);
  }
  for (const ActiveContact& contact : active) {
    const Index before = at.before_at[contact.place];
    if (before == none) {
      if (contact.at.normals == 0) continue;  // it was there all the time
      change(EventKind::closing, contact.at, contact.mode);
    } else if (at.before[before].mode != contact.mode && !contact.frictionless) {
      const EventKind stops = contact.at.attached ? EventKind::hold : EventKind::stick;
      const EventKind starts = contact.at.attached ? EventKind::roll : EventKind::slip;
      change(contact.sticks() ? stops : starts, contact.at, contact.mode);
    }
  }
}

}  // namespace carom
