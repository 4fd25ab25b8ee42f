// Problem: a clock group from event to event, with output in between.

#include <carom/core/dynamics/force_directions.h>
#include <carom/integrators/event_driven/clock_group.h>
#include <carom/integrators/event_driven/joinable_group.h>

#include <algorithm>
#include <cmath>

namespace carom {

ClockGroup::ClockGroup(const Assembly& assembly, const Detector& detector, const EventDriven& options,
                       const GroupComponents& components, GroupMemory& memory)
    : memory_(&memory),
      motion_(assembly, detector, components, options, memory.motion),
      failure_(motion_.model(), clock_),
      detector_(motion_, failure_, unbounded_, memory.detection),
      impacts_(options, failure_, memory.impacts, memory.chain),
      modes_(failure_, impacts_, unbounded_, memory.modes, memory.chain),
      projection_(motion_, failure_),
      limits_(motion_, failure_),
      flow_(memory.flows, motion_),
      output_(motion_.model().unknowns),
      y_(motion_.size()) {
  if (assembly.layout()->dimension() == 3 && !motion_.model().pairs.empty()) {
    // Sliding in two directions has modes that are not written yet; taken as planar it would stick at once.
    const BodyId body = assembly.layout()->id(motion_.model().pairs.front().body);
    throw ModelError(
        "event-driven mode: " + assembly.system().name(body) +
        " may touch an obstacle in space; allowed: contact in the plane (time stepping does both)");
  }
}

/// The event as one page. The last step may end behind the target, events at the target are resolved.
void ClockGroup::advance(double target, EventBalance& balance) try {
  memory_->motion.limit.restart();
  bool is_reachable = false;
  for (;;) {
    if (phase_.kind == Phase::at_event) {
      resolve_event(balance);  // impacts, modes, projection; flow or rest
      balance.settle();
    }
    if (phase_.kind == Phase::at_rest) clock_.now = target;
    if (clock_.now == target) break;
    memory_->motion.limit.restart();
    const Flow& flow = flow_.borrow();
    if (phase_.kind == Phase::flowing) {
      if (!is_reachable) limits_.demand_reachable(target);
      is_reachable = true;
      make_step();
    }
    const bool has_event = phase_.event.guard != Guard::nothing;
    if (target < (has_event ? phase_.event.time : flow.end())) break;
    if (has_event) {
      land(phase_.event);
    } else {
      accept_step(balance);
    }
  }
  output(target, balance);  // changes nothing of the run
  flow_.leave(phase_.kind == Phase::at_rest,
              motion_.model().parts().size() == motion_.model().assembly->components().size());
} catch (const EvaluationLimit::Reached&) {
  limits_.fail_evaluations();
}

void ClockGroup::make_step() {
  limits_.count_step(clock_.now, y_.data(), memory_->instant.now);
  phase_ = {Phase::ahead, detector_.step(flow_.change(), clock_.now, y_, limits_.longest_step())};
}

void ClockGroup::resolve_event(EventBalance& balance) {
  const Event event = phase_.event;
  const bool starts = event.guard == Guard::start;
  EventInstant at(motion_, memory_->instant, clock_.now, y_, balance);
  if (!starts) arrive_at(event, at);
  at.update();
  at.scales = event_scales(motion_, at.now, at.contacts);
  at.touch_gap = starts ? motion_.model().options->gap_tolerance : 4.0 * at.scales.gap_noise;
  if (starts && !motion_.active().list().empty()) projection_.apply_to_known_contacts(at);
  at.take_contacts_before();
  at.find_islands();
  if (impacts_.resolve(at)) {
    modes_.forget_ends();  // what stopped moves again,
    at.update();           // and loads may depend on velocities
  }
  modes_.select(at);
  phase_ = {JoinableGroup(*this).is_connected() ? start_flow(at) : Phase::parted};
  unbounded_.clear();
}

/// Follows an event on which the flow landed, before anything touches or parts by it.
void ClockGroup::arrive_at(const Event& event, EventInstant& at) {
  motion_.sample(at.time, at.y.data(), Forces::all, at.now);
  limits_.count_event(event, at.now);
  if (event.guard != Guard::meeting) modes_.note(event, motion_.active(), 4.0 * detector_.force_noise(event));
  record_event(event, at.balance);
  // Contacts push but do not pull: where the rate of a driver jumps, what was closed may part, or be hit.
  // Slower jumps count as none, as impacts do.
  if (event.guard == Guard::discontinuity) {
    const GroupModel& model = motion_.model();
    const std::span<double> velocities = at.y.subspan(model.unknowns.q_size(), model.unknowns.v_size());
    const std::span<const double> impulses = motion_.joints().follow_jump(
        at.now, velocities, model.options->capture_speed, at.balance.flows[EnergyFlow::external]);
    at.rate_jumps = !impulses.empty();
    if (at.rate_jumps) at.balance.list_joint_impulses(impulses, at.time, model, at.now);
  }
  if (at.rate_jumps) return;
  if (event.guard == Guard::slip) {
    projection_.apply_with_contact_stuck(event.which, at.now, at.y, at.balance);
  } else {
    projection_.apply(at.now, at.y, at.balance);
  }
}

/// Records events of elements and of laws of time.
void ClockGroup::record_event(const Event& event, EventBalance& balance) {
  const GroupModel& model = motion_.model();
  if (event.guard == Guard::switching_point) {
    balance.record(EventKind::switching_point, event.time, {}, *model.assembly).element =
        motion_.guards().element(event.which);
    detector_.pass(event);
  }
  if (event.guard != Guard::discontinuity) return;
  for (const Discontinuity& at : discontinuities_at(model.discontinuities, event.time)) {
    EventRecord& record = balance.record(EventKind::discontinuity, event.time, {}, *model.assembly);
    record.element = at.element;
    record.joint = at.joint;
    record.obstacle = at.obstacle;
  }
}

/// Starts the flow in the modes selected, unless nothing moves.
Phase::Kind ClockGroup::start_flow(EventInstant& at) {
  MotionSample& now = at.now;
  motion_.sample(at.time, y_.data(), Forces::all, now);
  if (!now.has_forces) {
    failure_.demand_finite_loads(now);
    failure_.fail("the forces of closed contacts contradict each other", {});
  }
  if (projection_.apply(now, y_, at.balance)) motion_.sample(at.time, y_.data(), Forces::all, now);
  const GroupModel& model = motion_.model();
  const ElementId lost = model.find_without_direction(now, at.scales.speed_noise);
  if (lost.valid()) {
    failure_.fail(tell_without_direction(*model.assembly, lost), {model.assembly->system().name(lost)});
  }
  if (is_at_rest(now)) return Phase::at_rest;
  detector_.begin_phase(at.time, y_.data(), at.scales);
  // A method of many steps is not helped by the length that the last step had.
  const FlowMethod method = model.options->method;
  flow_.start(at.time, y_, method == FlowMethod::explicit_runge_kutta || method == FlowMethod::one_step);
  return Phase::flowing;
}

/// True if nothing moves, and forces of contact keep what loads would move. \param now sample of the present,
/// overwritten
bool ClockGroup::is_at_rest(MotionSample& now) {
  constexpr double no_speed = 1e-14, no_acceleration = 1e-12;
  const GroupModel& model = motion_.model();
  if (model.loads.depends_on_time || model.unknowns.z_size() != 0) return false;
  // The surface of a conveyor does work on what stands.
  for (const ActiveContact& contact : motion_.active().list()) {
    if (contact.at.surface_velocity[1] != 0.0) return false;
  }
  const auto largest = [&](const std::vector<double>& numbers) {
    double size = 0.0;
    model.unknowns.for_velocities([&](Range v, std::size_t) {
      for (Index i = v.begin; i < v.end; ++i) {
        size = std::max(size, std::abs(numbers[i]) * memory_->motion.lengths[i]);
      }
    });
    return size;
  };
  if (largest(now.state.v) > no_speed) return false;
  motion_.sample(clock_.now, y_.data(), Forces::without_contact, now);
  const double free = largest(now.acceleration);
  motion_.sample(clock_.now, y_.data(), Forces::all, now);
  return largest(now.acceleration) <= no_acceleration * free;
}

void ClockGroup::land(const Event& event) {
  Flow& flow = flow_.change();
  clock_.now = event.time;
  detector_.land(flow, event, y_);
  // In front of forces without bound steps have shrunk to nothing.
  flow_.keep_step(event.guard == Guard::painleve ? 0.0 : flow.next_step());
  phase_ = {Phase::at_event, event};
}

void ClockGroup::accept_step(EventBalance& balance) {
  Flow& flow = flow_.change();
  clock_.now = flow.end();
  y_.assign(flow.state().begin(), flow.state().end());
  phase_ = {Phase::flowing};
  detector_.accept();
  if (motion_.active().list().empty() && motion_.joints().rows().empty()) return;
  MotionSample& now = memory_->instant.now;
  motion_.sample(clock_.now, y_.data(), Forces::all, now);
  if (projection_.apply(now, y_, balance)) flow.correct(y_);
}

/// Writes the output state: the present one, or one within the last step, projected onto the joints.
void ClockGroup::output(double target, EventBalance& balance) {
  if (phase_.kind == Phase::at_rest) clock_.now = target;
  double projected = 0.0;
  if (clock_.now == target) {
    std::copy(y_.begin(), y_.end(), output_.y().begin());
  } else {
    flow_.borrow().land(target, output_.y());
    if (!motion_.joints().rows().empty()) {
      MotionSample& then = memory_->instant.now;
      motion_.sample(target, output_.y().data(), Forces::all, then);
      projected = projection_.apply_to_output(then, output_.y(), balance);
    }
  }
  output_.book(projected, balance);
  clock_.output = target;
}

void ClockGroup::demand_start(const State& state) {
  memory_->motion.limit.restart();
  std::vector<double>& y = memory_->detection.y;
  y.resize(motion_.size());
  motion_.model().unknowns.gather(state, y);
  MotionSample& now = memory_->instant.now;
  motion_.sample(state.time, y.data(), Forces::without_contact, now);
  Constraint contact;
  const double tolerance = motion_.model().options->gap_tolerance;
  for (std::size_t i = 0; i < motion_.model().pairs.size(); ++i) {
    motion_.contact(i, now, contact);
    if (contact.gap >= -tolerance) continue;
    throw ModelError("event-driven mode: gap of " + failure_.name(contact) + " is " + to_text(contact.gap) +
                     " m at the start; allowed: not below -gap_tolerance, " + to_text(-tolerance) + " m");
  }
}

void ClockGroup::start(const State& state, const ContactModes& present) {
  demand_start(state);
  flow_.forget();
  clock_ = {state.time, state.time};
  motion_.model().unknowns.gather(state, y_);
  output_.start(y_);
  phase_ = {Phase::at_event, {state.time, Guard::start}};
  impacts_.start();
  modes_.start();
  limits_.start(clock_.now);
  detector_.start();
  close_known_contacts(present);
}

/// Takes contacts known to be closed into the active set, in their modes.
void ClockGroup::close_known_contacts(const ContactModes& present) {
  std::vector<ActiveContact>& active = motion_.active().list();
  active.clear();
  MotionSample& now = memory_->instant.now;
  motion_.sample(clock_.now, y_.data(), Forces::without_contact, now);
  Constraint contact;
  for (std::size_t i = 0; i < motion_.model().pairs.size(); ++i) {
    motion_.contact(i, now, contact);
    const auto known =
        std::lower_bound(present.begin(), present.end(), contact.key,
                         [](const auto& entry, const ConstraintKey& key) { return entry.first < key; });
    const bool open =
        known == present.end() || known->first != contact.key || known->second == ContactMode::open;
    if (open) continue;
    ActiveContact& closed = active.emplace_back();
    closed.pair = motion_.model().pairs[i];
    closed.place = static_cast<Index>(i);
    closed.mode = known->second;
    closed.at = contact;
  }
}

void ClockGroup::write(State& state, ContactModes& modes) const {
  motion_.model().unknowns.scatter(output_.y(), state);
  for (const ActiveContact& contact : motion_.active().list()) {
    modes.emplace_back(contact.at.key, contact.mode);
  }
}

JointReaction ClockGroup::reaction(const JointKind& kind, Index slot, JointId joint) {
  memory_->motion.limit.restart();
  MotionSample& at = memory_->instant.now;
  motion_.sample(clock_.output, output_.y().data(), Forces::all, at);
  const std::vector<ActiveContact>& closed = motion_.active().list();
  if (kind.has_dry_friction()) {
    const auto has_dry_friction =
        std::find_if(closed.begin(), closed.end(), [&](const ActiveContact& contact) {
          return contact.at.has_dry_friction() && contact.at.key.a.serial == joint.serial;
        });
    const double force = has_dry_friction == closed.end() ? 0.0 : has_dry_friction->tangential;
    return kind.reaction(at.joint_view(), slot, &force);
  }
  const std::span<const double> multipliers = motion_.joints().multipliers(at, closed);
  std::size_t row = 0;
  while (motion_.joints().rows().joint(row) != joint) ++row;
  return kind.reaction(at.joint_view(), slot, multipliers.data() + row);
}

}  // namespace carom
