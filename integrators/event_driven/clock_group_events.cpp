// Problem: what happens at an event: impacts until nothing approaches, then the modes of all that touches.

#include <carom/core/dynamics/force_directions.h>
#include <carom/integrators/event_driven/clock_group.h>
#include <carom/integrators/run/failure_file.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom {

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

// Gaps this small against the coordinates are rounding of sums of a few terms.
constexpr double gap_rounding = 256.0 * epsilon;

// Velocities this small against those before an impact are zero: answers of contact problems are certified to
// 1e-12. So are those well below the tolerance, which would start phases that end at once.
constexpr double speed_rounding = 1e-12;

}  // namespace

void ClockGroup::set_scales() {
  const Range q = assembly_->components()[motion_.component()].q,
              v = assembly_->components()[motion_.component()].v;
  const MotionWorkspace& work = work_->motion;
  double size = 1.0;
  for (Index i = q.begin; i < q.end; ++i) size = std::max(size, std::abs(work.trial.q[i]));
  gap_noise_ = gap_rounding * size;
  velocity_scale_ = force_scale_ = 0.0;
  for (Index i = v.begin; i < v.end; ++i) {
    velocity_scale_ = std::max(velocity_scale_, std::abs(work.trial.v[i]) * work.lengths[i]);
    force_scale_ = std::max(force_scale_, std::abs(work.momentum[i]) / work.lengths[i]);
  }
  for (const Constraint& contact : work_->contacts) {
    velocity_scale_ = std::max(velocity_scale_, std::abs(contact.surface_velocity[0]));
    velocity_scale_ = std::max(velocity_scale_, std::abs(contact.surface_velocity[1]));
  }
}

double ClockGroup::speed_noise() const {
  return speed_rounding * velocity_scale_ + 0.1 * options_.absolute_tolerance;
}

/// Brings the contacts of all pairs to the state in the workspace.
void ClockGroup::locate_contacts() {
  std::vector<Constraint>& contacts = work_->contacts;
  contacts.resize(motion_.pairs().size());
  for (std::size_t i = 0; i < contacts.size(); ++i) motion_.contact(i, contacts[i]);
}

bool ClockGroup::touches(std::size_t pair) const {
  return is_active_[pair] != 0 ||
         work_->contacts[pair].gap <= (fresh_ ? options_.gap_tolerance : 4.0 * gap_noise_);
}

void ClockGroup::begin_phase(EventBalance& balance) {
  motion_.evaluate(time_, y_.data(), false);
  locate_contacts();
  set_scales();
  if (fresh_ && !motion_.active().list().empty()) project_known_contacts(balance);
  before_ = motion_.active().list();
  std::fill(is_active_.begin(), is_active_.end(), char{0});
  std::fill(before_at_.begin(), before_at_.end(), none);
  for (Index i = 0; i < before_.size(); ++i) {
    is_active_[before_[i].place] = 1;
    before_at_[before_[i].place] = i;
  }
  const bool struck = resolve_impacts(balance);
  if (struck) {
    // What stopped moves again, and loads may depend on velocities.
    stopped_ = {};
    breaking_.clear();
    releasing_.clear();
    motion_.evaluate(time_, y_.data(), false);
    locate_contacts();
  }
  decide_modes(balance);
  record_changes(balance);
  stopped_ = {};
  fresh_ = false;

  if (!motion_.evaluate(time_, y_.data(), true)) {
    demand_finite_loads();
    fail("the forces of closed contacts contradict each other", {});
  }
  if (project_onto_constraints(balance)) motion_.evaluate(time_, y_.data(), true);
  const MotionWorkspace& work = work_->motion;
  const ElementId lost = find_without_direction(*assembly_, motion_.component(), work.trial.view(),
                                                work.evaluation, speed_noise());
  if (lost.valid()) fail(tell_without_direction(*assembly_, lost), {assembly_->system().name(lost)});
  in_phase_ = true;
  resting_ = at_rest();
  if (resting_) return;
  if (!sample_guards(time_, y_.data(), start_)) fail_loads();
  guards_.update(start_.seen.guards, guard_noise());
  // A method of many steps is not helped by the length that the last step had.
  const bool one_step =
      options_.method == FlowMethod::explicit_runge_kutta || options_.method == FlowMethod::one_step;
  if (!flow_) flow_ = work_->flows.borrow(motion_);
  is_recorded_ = false;
  flow_->start(time_, y_, one_step ? step_ : 0.0);
}

void ClockGroup::decide_modes(EventBalance& balance) {
  constexpr int most_rounds = 100;  // impacts without collision change what is to be decided
  const auto& pairs = motion_.pairs();
  std::vector<ActiveContact>& list = motion_.active().list();
  list.clear();
  for (std::size_t first = 0; first < pairs.size();) {
    std::size_t last = first + 1;
    while (last < pairs.size() && motion_.mechanism(pairs[last].body) == motion_.mechanism(pairs[first].body))
      ++last;
    int rounds = 0;
    while (!decide_body(first, last, balance)) {
      if (++rounds < most_rounds) continue;
      fail("impacts without collision do not come to an end", {detector_->name(work_->contacts[first].key)});
    }
    first = last;
  }
  std::fill(is_active_.begin(), is_active_.end(), char{0});
  for (const ActiveContact& contact : list) is_active_[contact.place] = 1;
}

void ClockGroup::collect_candidates(std::size_t first, std::size_t last) {
  std::vector<Candidate>& candidates = work_->candidates;
  candidates.clear();
  const double* const velocity = work_->motion.trial.v.data();
  for (std::size_t i = first; i < last; ++i) {
    const Constraint& contact = work_->contacts[i];
    if (!touches(i) || contact.normal_velocity(velocity) > speed_noise()) continue;
    Candidate& candidate = candidates.emplace_back();
    candidate.pair = motion_.pairs()[i];
    candidate.place = static_cast<Index>(i);
    candidate.at = contact;
    if (contact.has_dry_friction()) candidate.stiffness = std::numeric_limits<double>::infinity();
    const double slip = contact.type == ConstraintType::limit ? 0.0 : contact.tangential_velocity(velocity);
    candidate.slip = std::abs(slip) > speed_noise() && candidate.pair != stopped_ ? slip : 0.0;
    candidate.frictionless = contact.law.sticking_friction() == 0.0;
    const auto same = [&](const auto& other) { return other.pair == candidate.pair; };
    if (before_at_[i] != none) candidate.present = before_[before_at_[i]].mode;
    const auto breaking = std::find_if(breaking_.begin(), breaking_.end(), same);
    if (breaking != breaking_.end()) {
      candidate.breaks = true;
      candidate.push = breaking->push;
      candidate.noise = breaking->noise;
    }
    candidate.releases = std::find(releasing_.begin(), releasing_.end(), candidate.pair) != releasing_.end();
  }
}

/// False if an impact without collision happened: then everything is to be decided anew.
bool ClockGroup::decide_body(std::size_t first, std::size_t last, EventBalance& balance) {
  collect_candidates(first, last);
  std::vector<Candidate>& candidates = work_->candidates;
  if (candidates.empty()) return true;
  const Decision decision = decide_candidates(first, last);
  if (decision == Decision::impossible || decision == Decision::failed) demand_finite_loads();
  if (decision == Decision::impossible) {
    impact_without_collision(balance);
    return false;
  }
  if (decision == Decision::failed) {
    std::vector<std::string> names;
    names.reserve(candidates.size());
    for (const Candidate& candidate : candidates) names.push_back(detector_->name(candidate.at.key));
    fail("the contact problem of the accelerations is not solved", std::move(names),
         &work_->decision.cluster());
  }
  if (decision == Decision::several) record_choice(EventKind::several_accelerations, balance);
  for (const Candidate& candidate : candidates) {
    if (candidate.mode == ContactMode::open) continue;
    ActiveContact& closed = motion_.active().list().emplace_back();
    closed.pair = candidate.pair;
    closed.place = candidate.place;
    closed.mode = candidate.mode;
    closed.frictionless = candidate.frictionless;
    closed.at = candidate.at;
  }
  return true;
}

void ClockGroup::record_choice(EventKind kind, EventBalance& balance) {
  const ContactReport& report = work_->decision.cluster().report();
  for (const Candidate& candidate : work_->candidates) {
    if (!(candidate.stiffness <= 0.0)) continue;
    EventRecord& event = record(kind, candidate.at, balance);
    event.stiffness = candidate.stiffness;
    event.free_acceleration = candidate.free_acceleration;
    event.mode = candidate.mode;
    event.outcome = report.outcome;
    event.residual = report.residual;
    event.solver = report.solver;
  }
}

/// Tells which contacts changed their mode.
void ClockGroup::record_changes(EventBalance& balance) {
  const double* const velocity = work_->motion.trial.v.data();
  const auto change = [&](EventKind kind, const Constraint& contact, ContactMode mode) {
    EventRecord& event = record(kind, contact, balance);
    for (int row = 0; row < contact.rows; ++row) {
      event.velocity_before[static_cast<std::size_t>(row)] =
          event.velocity_after[static_cast<std::size_t>(row)] = contact.velocity(row, velocity);
    }
    event.energy_before = event.energy_after = motion_.kinetic_energy(contact.body());
    event.mode = mode;
  };
  for (const ActiveContact& contact : before_) {
    if (is_active_[contact.place] == 0) change(EventKind::lift_off, contact.at, ContactMode::open);
  }
  for (const ActiveContact& contact : motion_.active().list()) {
    const Index before = before_at_[contact.place];
    if (before == none) {
      if (contact.at.has_dry_friction()) continue;  // it was there all the time
      change(EventKind::closing, contact.at, contact.mode);
    } else if (before_[before].mode != contact.mode && !contact.frictionless) {
      change(contact.sticks() ? EventKind::stick : EventKind::slip, contact.at, contact.mode);
    }
  }
}

EventRecord& ClockGroup::record(EventKind kind, const Constraint& contact, EventBalance& balance) {
  ++balance.counts[static_cast<std::size_t>(kind)];
  EventRecord& event = balance.events.emplace_back();
  event.time = time_;
  event.kind = kind;
  if (contact.bodies == 0) return event;
  event.contact = contact.key;
  event.body = assembly_->layout()->id(contact.body());
  if (contact.key.b.owner == FeatureKey::Owner::obstacle) {
    event.obstacle = {contact.key.b.serial, assembly_->system().token()};
  }
  return event;
}

/// Names what the event at hand is of; empty where it is of no part, or of nothing that touches.
std::vector<std::string> ClockGroup::parts_of_event() {
  const System& system = assembly_->system();
  if (next_.guard == Guard::kink) return {system.name(motion_.guards().element(next_.which))};
  const auto& closed = motion_.active().list();
  Constraint contact;
  if (next_.guard == Guard::gap) {
    motion_.contact(next_.which, contact);
  } else if (next_.guard == Guard::slip) {
    contact = closed[next_.which].at;
  } else if (!closed.empty()) {
    contact = closed.front().at;
  } else {
    return {};
  }
  return {detector_->name(contact.key)};
}

void ClockGroup::count_event() {
  if (events_.exceeds(options_.event_limit, time_)) {
    std::string what = "more than " + to_text(options_.event_limit) + " events per second (event_limit)";
    // Where two ends have met, their line turns round by rounding, and with it the force, at one event after
    // the other.
    const ElementId lost =
        find_without_direction(*assembly_, motion_.component(), work_->motion.trial.view(),
                               work_->motion.evaluation, std::numeric_limits<double>::infinity());
    if (lost.valid()) what += "; " + tell_without_direction(*assembly_, lost);
    fail(what, parts_of_event());
  }
}

void ClockGroup::fail(const std::string& what, std::vector<std::string> parts,
                      const IslandProblem* cluster) const {
  std::string message = "event-driven at t = " + to_text(time_) + " s: " + what;
  if (parts.empty()) {
    const Index body = assembly_->components()[motion_.component()].bodies.begin;
    parts.push_back(assembly_->system().name(assembly_->layout()->id(body)));
    message += "; component of " + parts.front();
  } else {
    message += ":";
    for (const std::string& part : parts) message += " " + part + (part == parts.back() ? "" : ",");
  }
  SolverFailure failure;
  failure.time = output_time_;
  failure.step = time_ - output_time_;
  failure.parts = std::move(parts);
  if (cluster != nullptr) {
    failure.residual = cluster->report().residual;
    failure.problem = std::make_shared<const ContactProblem>(cluster->problem());
    message += write_failure(options_.failure_directory, failure, message);
  }
  throw SolverError(message, std::move(failure));
}

}  // namespace carom
