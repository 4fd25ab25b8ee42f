// Problem: what a clock group does between its events, and at them.

#include <carom/core/dynamics/force_directions.h>
#include <carom/integrators/event_driven/closed_joints.h>
#include <carom/integrators/event_driven/group_stages.h>

#include <algorithm>
#include <cmath>

namespace carom {

namespace {

/// Records events of elements and of laws of time.
void record_event(const Event& event, GroupParts& group, EventBalance& balance) {
  const GroupModel& model = group.motion.model();
  if (event.guard == Guard::switching_point) {
    balance.record(EventKind::switching_point, event.time, {}, *model.assembly).element =
        group.motion.guards().element(event.which);
    group.detector.pass(event);
  }
  if (event.guard != Guard::discontinuity) return;
  for (const Discontinuity& at : discontinuities_at(model.discontinuities, event.time)) {
    EventRecord& record = balance.record(EventKind::discontinuity, event.time, {}, *model.assembly);
    record.element = at.element;
    record.joint = at.joint;
    record.obstacle = at.obstacle;
  }
}

/// True if nothing moves, and forces of contact keep what loads would move. \param now sample of the present,
/// overwritten
bool is_at_rest(GroupParts& group, MotionSample& now) {
  constexpr double no_acceleration = 1e-12;
  const GroupModel& model = group.motion.model();
  const double no_speed = 1e-3 * model.options->absolute_tolerance;  // [m/s]
  if (model.loads.depends_on_time || model.unknowns.z_size() != 0) return false;
  // The surface of a conveyor does work on what stands.
  for (const ActiveContact& contact : group.motion.active().list()) {
    if (contact.at.surface_velocity[static_cast<std::size_t>(contact.at.tangent_row())] != 0.0) return false;
  }
  const auto largest = [&](const std::vector<double>& numbers) {
    double size = 0.0;
    model.unknowns.for_velocities([&](Range v, std::size_t) {
      for (Index i = v.begin; i < v.end; ++i) {
        size = std::max(size, std::abs(numbers[i]) * group.memory->motion.closure.lengths[i]);
      }
    });
    return size;
  };
  if (largest(now.state.v) > no_speed) return false;
  group.motion.sample(group.clock.now, group.y.data(), Forces::without_contact, now);
  const double free = largest(now.acceleration);
  group.motion.sample(group.clock.now, group.y.data(), Forces::all, now);
  return largest(now.acceleration) <= no_acceleration * free;
}

}  // namespace

void make_step(GroupParts& group) {
  group.limits.count_step(group.clock.now, group.y.data(), group.memory->instant.now);
  group.phase = {Phase::ahead, group.detector.step(group.flow.change(), group.clock.now, group.y,
                                                   group.limits.longest_step(group.y))};
}

void land(const Event& event, GroupParts& group) {
  Flow& flow = group.flow.change();
  group.clock.now = event.time;
  group.detector.land(flow, event, group.y);
  // In front of forces without bound steps have shrunk to nothing.
  group.flow.keep_step(event.guard == Guard::painleve ? 0.0 : flow.next_step());
  group.phase = {Phase::at_event, event};
}

void accept_step(GroupParts& group, EventBalance& balance) {
  Flow& flow = group.flow.change();
  group.clock.now = flow.end();
  group.y.assign(flow.state().begin(), flow.state().end());
  group.phase = {Phase::flowing};
  group.detector.accept();
  if (group.motion.active().list().empty() && group.motion.joints().rows().empty()) return;
  MotionSample& now = group.memory->instant.now;
  group.motion.sample(group.clock.now, group.y.data(), Forces::all, now);
  demand_closed(group.motion, now, group.failure);
  if (group.closure.apply(now, group.y, balance)) flow.correct(group.y);
}

namespace {

/// True if the velocity of a shape on ground jumps, by more than tolerances leave: what was closed on it
/// parts, is hit, or begins to slip, and is not projected onto the new velocity.
bool ground_jumps(const GroupParts& group, const MotionSample& now) {
  constexpr double left_by_tolerances = 10.0;
  const GroupModel& model = group.motion.model();
  const double* const velocity = now.state.v.data();
  const auto jumps = [&](double apart, double size) {
    const EventDriven& options = *model.options;
    return std::abs(apart) >
           left_by_tolerances * (options.relative_tolerance * size + options.absolute_tolerance);
  };
  const std::vector<ActiveContact>& closed = group.motion.active().list();
  return std::any_of(closed.begin(), closed.end(), [&](const ActiveContact& contact) {
    if (!moves(*model.detector, contact.pair)) return false;
    const Constraint& at = contact.at;
    return jumps(at.normal_velocity(velocity), at.speed(0, velocity)) ||
           (contact.sticks() &&
            jumps(at.tangential_velocity(velocity), at.speed(at.tangent_row(), velocity)));
  });
}

}  // namespace

void arrive_at(const Event& event, GroupParts& group, EventInstant& at) {
  group.motion.sample(at.time, at.y.data(), Forces::all, at.now);
  demand_closed(group.motion, at.now, group.failure);
  at.take_accelerations_before();
  // A meeting is counted where groups meet: others join at an event of one of them.
  if (event.guard != Guard::meeting) group.limits.count_event(event, at.y.data(), at.now);
  if (event.guard != Guard::meeting)
    group.modes.note(event, group.motion.active(), 4.0 * group.detector.force_noise(event));
  record_event(event, group, at.balance);
  // Contacts push but do not pull: where the rate of a driver jumps, what was closed may part, or be hit.
  // Slower jumps count as none, as impacts do. So may what is closed on ground that jumps, however slowly:
  // nothing else gives it the new velocity.
  if (event.guard == Guard::discontinuity) {
    const GroupModel& model = group.motion.model();
    const std::span<double> velocities = at.y.subspan(model.unknowns.q_size(), model.unknowns.v_size());
    const bool by_ground = ground_jumps(group, at.now);
    const std::span<const double> impulses = group.motion.joints().follow_jump(
        at.now, velocities, model.options->capture_speed, at.balance.flows[EnergyFlow::external]);
    at.rate_jumps = by_ground || !impulses.empty();
    if (!impulses.empty()) at.balance.list_joint_impulses(impulses, at.time, model, at.now);
  }
  if (at.rate_jumps) return;
  if (event.guard == Guard::slip) {
    group.closure.apply_with_contact_stuck(event.which, at.now, at.y, at.balance);
  } else {
    group.closure.apply(at.now, at.y, at.balance);
  }
}

Phase::Kind start_flow(GroupParts& group, EventInstant& at) {
  MotionSample& now = at.now;
  group.motion.sample(at.time, group.y.data(), Forces::all, now);
  if (!now.has_forces) {
    group.failure.demand_finite_loads(now);
    group.failure.fail("the forces of closed contacts contradict each other", {});
  }
  if (group.closure.apply(now, group.y, at.balance))
    group.motion.sample(at.time, group.y.data(), Forces::all, now);
  const GroupModel& model = group.motion.model();
  const ElementId lost = model.find_without_direction(now, at.scales.speed_noise);
  if (lost.valid()) {
    group.failure.fail(tell_without_direction(*model.assembly, lost), {model.assembly->system().name(lost)});
  }
  if (is_at_rest(group, now)) return Phase::at_rest;
  group.detector.begin_phase(at.time, group.y.data(), at.scales);
  // A method of many steps is not helped by the length that the last step had.
  const FlowMethod method = model.options->method;
  group.flow.start(at.time, group.y,
                   method == FlowMethod::explicit_runge_kutta || method == FlowMethod::one_step);
  return Phase::flowing;
}

void write_output(double target, GroupParts& group, EventBalance& balance) {
  if (group.phase.kind == Phase::at_rest) group.clock.now = target;
  double projected = 0.0;
  if (group.clock.now == target) {
    std::copy(group.y.begin(), group.y.end(), group.output.y().begin());
  } else {
    Flow& flow = group.flow.borrow();
    flow.land(std::min(target, flow.end()), group.output.y());  // a discontinuity is behind the end
    if (!group.motion.joints().rows().empty()) {
      MotionSample& then = group.memory->instant.now;
      group.motion.sample(target, group.output.y().data(), Forces::all, then);
      demand_closed(group.motion, then, group.failure);
      projected = group.closure.apply_to_output(then, group.output.y(), balance);
    }
  }
  group.output.book(projected, balance);
  group.clock.output = target;
}

bool is_connected(const GroupParts& group) {
  const std::vector<MotionUnknowns::Part>& parts = group.motion.model().parts();
  if (parts.size() == 1) return true;
  const Assembly& assembly = *group.motion.model().assembly;
  ComponentIslands& islands = group.memory->components;
  islands.joined.clear();
  for (const MotionUnknowns::Part& part : parts) islands.joined.push_back({part.component, part.component});
  for (const ActiveContact& contact : group.motion.active().list()) {
    if (contact.pair.other == none) continue;
    islands.joined.push_back(
        {assembly.component_of(contact.pair.body), assembly.component_of(contact.pair.other)});
  }
  const auto components = static_cast<Index>(assembly.components().size());
  return islands.partition.arrange(islands.joined, components).size() == 1;
}

}  // namespace carom
