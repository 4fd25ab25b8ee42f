// Problem: a component's smooth phases: make steps, find the first event in each, be looked at in between.

#include <carom/integrators/event_driven/clock_group.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace carom {

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double never = std::numeric_limits<double>::infinity();

}  // namespace

ClockGroup::ClockGroup(const Assembly& assembly, const Detector& detector, const EventDriven& options,
                       Index component, DriverWorkspace& work)
    : assembly_(&assembly),
      detector_(&detector),
      options_(options),
      work_(&work),
      motion_(assembly, detector, component, options, work.motion),
      y_(motion_.size()),
      output_state_(motion_.size()) {
  is_active_.assign(motion_.pairs().size(), 0);
  before_at_.assign(motion_.pairs().size(), none);
  if (assembly.layout()->dimension() == 3 && !motion_.pairs().empty()) {
    // Sliding in two directions has modes that are not written yet; taken as planar it would stick at once.
    const BodyId body = assembly.layout()->id(motion_.pairs().front().body);
    throw ModelError(
        "event-driven mode: " + assembly.system().name(body) +
        " may touch an obstacle in space; allowed: contact in the plane (time stepping does both)");
  }
}

void ClockGroup::demand_start(const State& state) {
  work_->y.resize(motion_.size());
  work_->motion.limit.restart();
  motion_.gather(state, work_->y);
  motion_.evaluate(state.time, work_->y.data(), false);
  Constraint contact;
  for (std::size_t i = 0; i < motion_.pairs().size(); ++i) {
    motion_.contact(i, contact);
    if (contact.gap >= -options_.gap_tolerance) continue;
    throw ModelError("event-driven mode: gap of " + detector_->name(contact.key) + " is " +
                     to_text(contact.gap) + " m at the start; allowed: not below -gap_tolerance, " +
                     to_text(-options_.gap_tolerance) + " m");
  }
}

void ClockGroup::start(const State& state, const ContactModes& present) {
  demand_start(state);
  flow_.reset();
  time_ = output_time_ = state.time;
  landed_at_ = never;
  motion_.gather(state, y_);
  output_state_ = y_;
  delivered_ = {};
  output_projection_ = 0.0;
  pending_ = resting_ = in_phase_ = false;
  fresh_ = true;
  step_ = 0.0;
  last_impacts_.clear();
  breaking_.clear();
  releasing_.clear();
  events_.start(time_);
  steps_.start(time_);
  guards_.forget(motion_.guards().count());

  motion_.active().list().clear();
  motion_.evaluate(time_, y_.data(), false);
  Constraint contact;
  for (std::size_t i = 0; i < motion_.pairs().size(); ++i) {
    motion_.contact(i, contact);
    const auto known =
        std::lower_bound(present.begin(), present.end(), contact.key,
                         [](const auto& entry, const ConstraintKey& key) { return entry.first < key; });
    const bool open =
        known == present.end() || known->first != contact.key || known->second == ContactMode::open;
    if (open) continue;
    ActiveContact& closed = motion_.active().list().emplace_back();
    closed.pair = motion_.pairs()[i];
    closed.place = static_cast<Index>(i);
    closed.mode = known->second;
    closed.at = contact;
  }
}

void ClockGroup::go_to(double target, EventBalance& balance) {
  bool within_reach = false;
  for (;;) {
    work_->motion.limit.restart();
    if (!in_phase_) begin_phase(balance);
    if (resting_) time_ = target;
    if (time_ == target) {
      output_state_ = y_;
      output_at(0.0, target, balance);
      break;
    }
    borrow_flow();
    if (!pending_) {
      if (!within_reach) demand_time(target);
      within_reach = true;
      count_step();
      take_step();
    }
    const double until = next_.guard == Guard::nothing ? flow_->end() : next_.time;
    if (target < until) {
      output_within_step(target, balance);
      break;
    }
    if (next_.guard == Guard::nothing) {
      accept_step(balance);
    } else {
      go_to_event(balance);
    }
  }
  leave_flow();
}

void ClockGroup::output_within_step(double target, EventBalance& balance) {
  flow_->land(target, output_state_);
  double projected = 0.0;
  if (!motion_.joints().empty()) {
    bool changed = false;
    motion_.evaluate(target, output_state_.data(), true);
    projected = project(output_state_, changed, balance);
  }
  output_at(projected, target, balance);
}

/// What is shown stands on the joints; that is taken back where the run goes on.
void ClockGroup::output_at(double projected, double target, EventBalance& balance) {
  balance.flows[EnergyFlow::projection] += projected - output_projection_;
  output_projection_ = projected;
  for (Index line = 0; line < motion_.work_count(); ++line) {
    const double value = output_state_[motion_.work_place(static_cast<WorkLine>(line))];
    constexpr std::array<EnergyFlow, work_lines> flows{EnergyFlow::dashpot, EnergyFlow::sliding,
                                                       EnergyFlow::external, EnergyFlow::joint_friction};
    balance.flows[flows[line]] += value - delivered_[line];
    delivered_[line] = value;
  }
  output_time_ = target;
}

void ClockGroup::borrow_flow() {
  if (flow_) return;
  flow_ = work_->flows.borrow(motion_);
  flow_->resume(left_);
  is_recorded_ = true;
}

/// Lets other components have the flow.
void ClockGroup::leave_flow() {
  const bool alone = assembly_->components().size() == 1;
  if (!flow_ || (!resting_ && (alone || !(is_recorded_ || flow_->leave(left_))))) return;
  flow_.reset();
}

void ClockGroup::write(State& state, ContactModes& modes) const {
  motion_.scatter(output_state_, state);
  for (const ActiveContact& contact : motion_.active().list())
    modes.emplace_back(contact.at.key, contact.mode);
}

JointReaction ClockGroup::reaction(const JointKind& kind, Index slot, JointId joint) {
  work_->motion.limit.restart();
  motion_.evaluate(output_time_, output_state_.data(), true);
  const MotionWorkspace& work = work_->motion;
  const JointView at{work.trial.view(), work.evaluation.rotation.data()};
  if (kind.has_dry_friction()) {
    const auto& closed = motion_.active().list();
    const auto has_dry_friction =
        std::find_if(closed.begin(), closed.end(), [&](const ActiveContact& contact) {
          return contact.at.has_dry_friction() && contact.at.key.a.serial == joint.serial;
        });
    const double force = has_dry_friction == closed.end() ? 0.0 : has_dry_friction->tangential;
    return kind.reaction(at, slot, &force);
  }
  const std::span<const double> multipliers = motion_.joint_multipliers();
  std::size_t row = 0;
  while (motion_.joints().joint(row) != joint) ++row;
  return kind.reaction(at, slot, multipliers.data() + row);
}

double ClockGroup::longest_step() const {
  // Free flight would allow steps of any length; gaps would then be small differences of large numbers.
  constexpr double longest_flight = 1.0;
  const bool seen_everywhere = !motion_.depends_on_time() && motion_.guards().all_have_motion();
  return seen_everywhere ? longest_flight : options_.longest_step;
}

void ClockGroup::take_step() {
  const std::vector<Discontinuity>& breaks = motion_.breaks();
  const auto due = std::upper_bound(breaks.begin(), breaks.end(), time_,
                                    [](double t, const Discontinuity& at) { return t < at.time; });
  const double until_break = due == breaks.end() ? never : due->time - time_;
  landed_at_ = never;
  pending_ = true;
  is_recorded_ = false;
  const auto end_here = [&](const char* why) {
    unbounded_force_ = why;
    next_ = {time_, Guard::painleve, 0};
    landed_at_ = time_;
    landed_ = y_;
  };
  bool anew = false;
  do {
    try {
      flow_->advance(std::min(longest_step(), until_break));
    } catch (const SolverError& error) {
      if (!find_unbounded_force()) fail_flow(error);
      end_here(error.what());
      return;
    }
    if (!sample_guards(flow_->end(), flow_->state().data(), end_)) fail_loads();
    work_->looks.forget();
    work_->guard_looks.forget();
    landed_at_ = never;
    next_ = find_event();
    if (stands_still(next_) && find_unbounded_force()) {
      end_here("steps have no length any more");
      return;
    }
    // Forces that were infinite within the step: nearer to there they are seen to grow.
    constexpr double nearer = 0.25;
    if (next_.guard == Guard::painleve) flow_->start(time_, y_, nearer * (next_.time - time_));
    anew = next_.guard == Guard::painleve;
    if (!anew && (next_.guard == Guard::leap || lands_off_path(next_))) {
      flow_->start(time_, y_, 0.5 * (next_.time - time_));
      anew = true;
    }
  } while (anew);
  const bool at_break =
      until_break < never && flow_->end() >= due->time - 2.0 * epsilon * std::abs(due->time);
  if (next_.guard == Guard::nothing && at_break) next_ = {due->time, Guard::law, 0};
}

void ClockGroup::accept_step(EventBalance& balance) {
  is_recorded_ = false;
  time_ = flow_->end();
  y_.assign(flow_->state().begin(), flow_->state().end());
  pending_ = false;
  std::swap(start_, end_);
  guards_.update(start_.seen.guards, guard_noise());
  if (motion_.active().list().empty() && motion_.joints().empty()) return;
  motion_.evaluate(time_, y_.data(), true);
  if (project_onto_constraints(balance)) flow_->correct(y_);
}

void ClockGroup::go_to_event(EventBalance& balance) {
  time_ = next_.time;
  if (landed_at_ == time_) {
    y_ = landed_;
  } else {
    flow_->land(std::min(time_, flow_->end()), y_);
  }
  pending_ = in_phase_ = false;
  // In front of a jam steps have shrunk to nothing.
  step_ = next_.guard == Guard::painleve ? 0.0 : flow_->next_step();
  motion_.evaluate(time_, y_.data(), true);
  count_event();
  // Events of several bodies at one instant are decided one after the other: what gave way goes on doing so.
  if (time_ != gave_way_at_) {
    breaking_.clear();
    releasing_.clear();
    gave_way_at_ = time_;
  }
  const auto& closed = motion_.active().list();
  if (next_.guard == Guard::force) {
    motion_.active().margins(work_->margins);
    const ForceMargin& at = work_->margins[next_.which];
    const double noise = 4.0 * std::max(start_.noises[next_.which], end_.noises[next_.which]);
    for (std::size_t i = at.first; i < at.last; ++i) {
      const ActiveContact& c = closed[i];
      if (!c.sets_margin) continue;
      if (!c.at.has_dry_friction() && c.normal <= at.margin + noise && c.normal <= noise) {
        releasing_.push_back(c.pair);
      } else if (c.sticks() && c.friction * c.normal - std::abs(c.tangential) <= at.margin + noise) {
        breaking_.push_back({c.pair, c.tangential, noise});
      }
    }
  }
  if (next_.guard == Guard::kink) {
    record(EventKind::kink, {}, balance).element = motion_.guards().element(next_.which);
    guards_.pass({time_, next_.which, next_.sign});
  }
  if (next_.guard == Guard::law) {
    for (const Discontinuity& at : discontinuities_at(motion_.breaks(), time_)) {
      EventRecord& event = record(EventKind::law_break, {}, balance);
      event.element = at.element;
      event.joint = at.joint;
      event.obstacle = at.obstacle;
    }
  }
  stopped_ = next_.guard == Guard::slip ? closed[next_.which].pair : ContactPair{};
  // Contacts push but do not pull: where the rate of a driver jumps, what was closed may part, or be hit.
  // Slower jumps count as none, as impacts do.
  jumped_ = next_.guard == Guard::law &&
            motion_.follow_jump(y_, options_.capture_speed, balance.flows[EnergyFlow::external]);
  if (jumped_) {
    list_impulses(balance);
  } else if (next_.guard == Guard::slip) {
    project_with_contact_stuck(balance);
  } else {
    project_onto_constraints(balance);
  }
  begin_phase(balance);
  jumped_ = false;
  unbounded_forces_.clear();
}

bool ClockGroup::at_rest() {
  constexpr double no_speed = 1e-14, no_acceleration = 1e-12;
  if (motion_.depends_on_time() || !assembly_->components()[motion_.component()].z.empty()) return false;
  const Range v = assembly_->components()[motion_.component()].v;
  const MotionWorkspace& work = work_->motion;
  double fastest = 0.0;
  for (Index i = v.begin; i < v.end; ++i)
    fastest = std::max(fastest, std::abs(work.trial.v[i]) * work.lengths[i]);
  if (fastest > no_speed) return false;
  double free = 0.0, left = 0.0;
  motion_.evaluate(time_, y_.data(), false);
  for (Index i = v.begin; i < v.end; ++i)
    free = std::max(free, std::abs(work.acceleration[i]) * work.lengths[i]);
  motion_.evaluate(time_, y_.data(), true);
  for (Index i = v.begin; i < v.end; ++i)
    left = std::max(left, std::abs(work.acceleration[i]) * work.lengths[i]);
  return left <= no_acceleration * free;
}

}  // namespace carom
