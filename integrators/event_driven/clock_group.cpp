// Problem: a clock group from event to event, with output in between.

#include <carom/contact/contact_parties.h>
#include <carom/integrators/event_driven/clock_group.h>
#include <carom/integrators/event_driven/group_stages.h>
#include <carom/integrators/event_driven/overlap_check.h>
#include <carom/integrators/event_driven/slip_directions.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace carom {

/// The event as one page. The last step may end behind the target, events at the target are resolved.
void ClockGroup::advance(double target, bool output, EventBalance& balance) try {
  parts_.memory->motion.limit.restart();
  bool is_reachable = false;
  for (;;) {
    if (parts_.phase.kind == Phase::at_event) {
      resolve_event(parts_, balance);  // impacts, modes, projection; flow or rest
      balance.settle();
    }
    if (parts_.phase.kind == Phase::at_rest) parts_.clock.now = target;
    if (parts_.clock.now == target) break;
    parts_.memory->motion.limit.restart();
    const Flow& flow = parts_.flow.borrow();
    if (parts_.phase.kind == Phase::flowing) {
      if (!is_reachable) parts_.limits.demand_reachable(target);
      is_reachable = true;
      make_step(parts_);
    }
    const bool has_event = parts_.phase.event.guard != Guard::nothing;
    if (target < (has_event ? parts_.phase.event.time : flow.end())) break;
    if (has_event) {
      land(parts_.phase.event, parts_);
    } else {
      accept_step(parts_, balance);
    }
  }
  if (output) write_output(target, parts_, balance);  // changes nothing of the run
  leave_flow();
} catch (const EvaluationLimit::Reached&) {
  parts_.limits.fail_evaluations();
}

/// Lets other groups have the flow.
void ClockGroup::leave_flow() {
  const GroupModel& model = parts_.motion.model();
  parts_.flow.leave(parts_.phase.kind == Phase::at_rest,
                    model.parts().size() == model.assembly->components().size());
}

void ClockGroup::look_at(double time, State& state, ContactModes& modes, EventBalance& balance) try {
  parts_.memory->motion.limit.restart();
  const GroupClock clock = parts_.clock;
  GroupOutput before = parts_.output;
  const bool was_borrowed = parts_.flow.is_borrowed();
  write_output(time, parts_, balance);
  if (!was_borrowed) leave_flow();
  write(state, modes);
  parts_.output = std::move(before);
  parts_.clock = clock;
} catch (const EvaluationLimit::Reached&) {
  parts_.limits.fail_evaluations();
}

void resolve_event(GroupParts& group, EventBalance& balance) {
  const Event event = group.phase.event;
  const bool starts = event.guard == Guard::start;
  EventInstant at(group.motion, group.memory->instant, group.clock.now, group.y, balance);
  if (!starts) arrive_at(event, group, at);
  at.update();
  at.scales = event_scales(group.motion, at.now, at.contacts);
  if (starts) {
    at.take_accelerations_before();
  } else {
    demand_apart(at, group.failure);
  }
  at.find_touch_gap(starts);
  if (starts && !group.motion.active().list().empty()) group.closure.apply_to_known_contacts(at);
  at.take_contacts_before();
  at.find_islands();
  if (group.impacts.resolve(at)) {
    group.modes.forget_ends();  // what stopped moves again,
    at.update();                // and loads may depend on velocities
    group.impacts.settle(at);
  }
  group.modes.select(at);
  group.phase = {is_connected(group) ? start_flow(group, at) : Phase::parted};
  group.unbounded.clear();
}

void ClockGroup::demand_start(const State& state) {
  if (parts_.motion.model().pairs.empty()) return;
  parts_.memory->motion.limit.restart();
  std::vector<double>& y = parts_.memory->detection.y;
  y.resize(parts_.motion.size());
  parts_.motion.model().unknowns.gather(state, y);
  MotionSample& now = parts_.memory->instant.now;
  parts_.motion.sample(state.time, y.data(), Forces::without_contact, now);
  SingleConstraint contact;
  const double tolerance = parts_.motion.model().options->gap_tolerance;
  for (std::size_t i = 0; i < parts_.motion.model().pairs.size(); ++i) {
    if (parts_.motion.model().pairs[i].rolling) continue;
    parts_.motion.contact(i, now, contact);
    if (contact.gap < -tolerance) refuse_start(parts_.failure.name(contact), contact.gap, tolerance);
  }
}

void ClockGroup::start(const State& state, const ContactModes& present) {
  demand_start(state);
  parts_.flow.forget();
  parts_.clock = {state.time, state.time};
  parts_.motion.model().unknowns.gather(state, parts_.y);
  parts_.output.start(parts_.y);
  parts_.phase = {Phase::at_event, {state.time, Guard::start}};
  parts_.impacts.start();
  parts_.modes.start();
  parts_.limits.start(parts_.clock.now);
  parts_.detector.start();
  close_known_contacts(present);
}

/// Takes contacts known to be closed into the active set, in their modes. Time stepping keeps some closed
/// that turning has opened: those that are far from touching are open here.
void ClockGroup::close_known_contacts(const ContactModes& present) {
  std::vector<ActiveContact>& active = parts_.motion.active().list();
  active.clear();
  MotionSample& now = parts_.memory->instant.now;
  parts_.motion.sample(parts_.clock.now, parts_.y.data(), Forces::without_contact, now);
  SingleConstraint contact;
  for (std::size_t i = 0; i < parts_.motion.model().pairs.size(); ++i) {
    parts_.motion.contact(i, now, contact);
    const auto known =
        std::lower_bound(present.begin(), present.end(), contact.key,
                         [](const auto& entry, const ConstraintKey& key) { return entry.first < key; });
    const bool open =
        known == present.end() || known->first != contact.key || known->second == ContactMode::open;
    if (open || contact.gap > near_gap(*parts_.motion.model().options)) continue;
    ActiveContact& closed = active.emplace_back();
    closed.pair = parts_.motion.model().pairs[i];
    closed.place = static_cast<Index>(i);
    closed.mode = known->second;
    closed.at = contact;
    closed.friction = contact.friction;
    if (!closed.pair.rolling) continue;
    // Its mode is not written down: it follows from the relative spin.
    const double spin = contact.tangential_velocity(now.state.v.data());
    const double noise = event_scales(parts_.motion, now, contact.alone()).noise_of(parts_.motion, contact);
    closed.mode = mode_by_sign(std::abs(spin) <= noise ? 0.0 : spin);
  }
}

void ClockGroup::write(State& state, ContactModes& modes) const {
  parts_.motion.model().unknowns.scatter(parts_.output.y(), state);
  for (const ActiveContact& contact : parts_.motion.active().list()) {
    if (!contact.at.attached) modes.emplace_back(contact.at.key, contact.mode);
  }
}

JointReaction ClockGroup::reaction(const JointKind& kind, Index slot, JointId joint) {
  parts_.memory->motion.limit.restart();
  MotionSample& at = parts_.memory->instant.now;
  parts_.motion.sample(parts_.clock.output, parts_.output.y().data(), Forces::all, at);
  const std::vector<ActiveContact>& closed = parts_.motion.active().list();
  if (kind.friction_rows() > 0) {
    const auto friction = std::find_if(closed.begin(), closed.end(), [&](const ActiveContact& contact) {
      return contact.at.key.is_of_joint() && contact.at.key.a.serial == joint.serial;
    });
    const double force =
        friction == closed.end() ? 0.0 : friction->at.of_joint.length * friction->tangential[0];
    return kind.reaction(at.joint_view(), slot, &force);
  }
  const std::span<const double> multipliers = parts_.motion.joints().multipliers(at, closed);
  std::size_t row = 0;
  while (parts_.motion.joints().rows().joint(row) != joint) ++row;
  return kind.reaction(at.joint_view(), slot, multipliers.data() + row);
}

/// Rolling resistance follows its contact in the list.
void ClockGroup::list_forces(std::vector<LastingContact>& out) {
  if (parts_.motion.active().list().empty()) return;
  parts_.memory->motion.limit.restart();
  MotionSample& at = parts_.memory->instant.now;
  parts_.motion.sample(parts_.clock.output, parts_.output.y().data(), Forces::all, at);
  // Of forces that are not unique those that the law allows.
  parts_.motion.active().margins(parts_.memory->detection.margins);
  const Assembly& assembly = *parts_.motion.model().assembly;
  for (const ActiveContact& contact : parts_.motion.active().list()) {
    if (contact.at.attached) {
      out.back().rolling_moment = contact.at.of_joint.length * contact.tangential[0];
    } else if (!contact.at.key.is_of_joint()) {
      LastingContact& force = out.emplace_back();
      const Constraint& closed = contact.at;
      write_place(closed, assembly, at.state.q.data(), force);
      force.velocity[0] = closed.normal_velocity(at.state.v.data());
      force.force[0] = contact.normal;
      for_tangents(closed, [&](std::size_t k, int row) {
        force.velocity[1 + k] = closed.velocity(row, at.state.v.data());
        force.force[1 + k] = contact.tangential[k];
      });
      force.mode = contact.mode;
    }
  }
}

}  // namespace carom
