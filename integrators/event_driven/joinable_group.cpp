// Problem: a clock group among others, which it may meet: it goes on event by event, becomes part of another
// group where bodies touch, and parts where nothing lasting connects them.

#include <carom/integrators/event_driven/group_stages.h>
#include <carom/integrators/event_driven/joinable_group.h>

#include <algorithm>
#include <limits>

namespace carom {

namespace {

/// Adds the closed contacts of another group that this one has pairs of.
void take_closed_contacts(const GroupParts& from, GroupParts& to) {
  const std::vector<ContactPair>& pairs = to.motion.model().pairs;
  for (const ActiveContact& contact : from.motion.active().list()) {
    const auto place = std::find(pairs.begin(), pairs.end(), contact.pair);
    if (place == pairs.end()) continue;
    to.motion.active().list().emplace_back(contact).place = static_cast<Index>(place - pairs.begin());
  }
}

}  // namespace

void JoinableGroup::go_ahead(double target) try {
  if (group_->phase.kind != Phase::flowing) return;
  group_->memory->motion.limit.restart();
  group_->limits.demand_reachable(target);
  static_cast<void>(group_->flow.borrow());
  make_step(*group_);
} catch (const EvaluationLimit::Reached&) {
  group_->limits.fail_evaluations();
}

void JoinableGroup::place(const State& state) {
  group_->clock = {state.time, state.time};
  group_->phase = {Phase::at_event, {state.time, Guard::start}};
  group_->motion.model().unknowns.gather(state, group_->y);
  group_->motion.active().list().clear();
}

bool JoinableGroup::has_unbounded_force() const { return group_->phase.event.guard == Guard::painleve; }

void JoinableGroup::output(double target, EventBalance& balance) {
  group_->memory->motion.limit.restart();
  write_output(target, *group_, balance);
}

double JoinableGroup::due() {
  if (group_->phase.kind == Phase::at_rest) return std::numeric_limits<double>::infinity();
  if (group_->phase.kind != Phase::ahead) return group_->clock.now;
  return group_->phase.event.guard != Guard::nothing ? group_->phase.event.time : group_->flow.borrow().end();
}

void JoinableGroup::reach_due(EventBalance& balance) try {
  group_->memory->motion.limit.restart();
  if (group_->phase.event.guard != Guard::nothing) return land(group_->phase.event, *group_);
  accept_step(*group_, balance);
} catch (const EvaluationLimit::Reached&) {
  group_->limits.fail_evaluations();
}

void JoinableGroup::arrive(EventBalance& balance) try {
  group_->memory->motion.limit.restart();
  EventInstant at(group_->motion, group_->memory->instant, group_->clock.now, group_->y, balance);
  arrive_at(group_->phase.event, *group_, at);
} catch (const EvaluationLimit::Reached&) {
  group_->limits.fail_evaluations();
}

bool JoinableGroup::resolve(EventBalance& balance) try {
  group_->memory->motion.limit.restart();
  resolve_event(*group_, balance);
  balance.settle();
  if (group_->phase.kind != Phase::parted) return true;
  book_end(balance);
  return false;
} catch (const EvaluationLimit::Reached&) {
  group_->limits.fail_evaluations();
}

/// Books the works up to the present: others go on with the motion.
void JoinableGroup::book_end(EventBalance& balance) {
  std::copy(group_->y.begin(), group_->y.end(), group_->output.y().begin());
  group_->output.book(0.0, balance);
}

/// Ends a motion at a time of its last step: books it up to there and writes its state.
void JoinableGroup::end(double time, State& state, EventBalance& balance) {
  if (group_->phase.kind == Phase::ahead) {
    Flow& flow = group_->flow.borrow();
    flow.land(std::min(time, flow.end()), group_->y);  // a discontinuity is behind the end
    group_->flow.keep_step(flow.next_step());
  }
  group_->clock.now = time;
  book_end(balance);
  group_->motion.model().unknowns.scatter(group_->y, state);
  group_->flow.leave(true, false);
}

void JoinableGroup::join(std::span<ClockGroup* const> groups, double time, double output, State& state,
                         EventBalance& balance) try {
  group_->memory->motion.limit.restart();
  group_->motion.active().list().clear();
  group_->impacts.start();
  group_->modes.start();
  double step = std::numeric_limits<double>::infinity();
  for (ClockGroup* const clock_group : groups) {
    JoinableGroup(*clock_group).end(time, state, balance);
    const GroupParts& group = clock_group->parts();
    take_closed_contacts(group, *group_);
    group_->impacts.take(group.impacts);
    group_->modes.take(group.modes, time);
    if (group.flow.kept_step() > 0.0) step = std::min(step, group.flow.kept_step());
  }
  state.time = time;
  group_->clock = {time, output};
  group_->motion.model().unknowns.gather(state, group_->y);
  group_->output.start(group_->y);
  group_->detector.start();
  group_->flow.keep_step(step < std::numeric_limits<double>::infinity() ? step : 0.0);
  group_->phase = {Phase::at_event, {time, Guard::meeting}};
} catch (const EvaluationLimit::Reached&) {
  group_->limits.fail_evaluations();
}

void JoinableGroup::count_meeting() try {
  group_->memory->motion.limit.restart();
  group_->limits.count_event(group_->phase.event, group_->y.data(), group_->memory->instant.now);
} catch (const EvaluationLimit::Reached&) {
  group_->limits.fail_evaluations();
}

void JoinableGroup::part(const ClockGroup& last, State& state, EventBalance& balance) try {
  const GroupParts& from = last.parts();
  group_->memory->motion.limit.restart();
  from.motion.model().unknowns.scatter(from.y, state);
  group_->clock = from.clock;
  group_->motion.model().unknowns.gather(state, group_->y);
  group_->output.start(group_->y);
  group_->impacts.start();
  group_->impacts.take(from.impacts);
  group_->modes.start();
  group_->modes.take(from.modes, from.clock.now);  // an end that follows at once is another one
  group_->detector.start();
  group_->flow.keep_step(from.flow.kept_step());
  group_->motion.active().list().clear();
  take_closed_contacts(from, *group_);
  EventInstant at(group_->motion, group_->memory->instant, group_->clock.now, group_->y, balance);
  at.update();
  at.scales = event_scales(group_->motion, at.now, at.contacts);
  group_->phase = {start_flow(*group_, at)};
} catch (const EvaluationLimit::Reached&) {
  group_->limits.fail_evaluations();
}

void JoinableGroup::sample(double time, bool landed, Forces forces, MotionSample& out) try {
  group_->memory->motion.limit.restart();
  std::vector<double>& y = group_->memory->detection.y;
  y.assign(group_->y.begin(), group_->y.end());
  if (group_->phase.kind == Phase::ahead && time > group_->clock.now) {
    Flow& flow = group_->flow.borrow();
    time = std::min(time, flow.end());  // a discontinuity is behind the end
    if (landed) {
      flow.land(time, y);
    } else {
      flow.sample(time, y);
    }
  }
  group_->motion.sample(time, y.data(), forces, out);
} catch (const EvaluationLimit::Reached&) {
  group_->limits.fail_evaluations();
}

}  // namespace carom
