// Problem: a clock group among others, which it may meet: it goes on event by event, becomes part of another
// group where bodies touch, and parts where nothing lasting connects them.

#include <carom/core/numerics/union_find.h>
#include <carom/integrators/event_driven/joinable_group.h>

#include <algorithm>
#include <limits>

namespace carom {

void JoinableGroup::go_ahead(double target) try {
  if (group_->phase_.kind != Phase::flowing) return;
  group_->memory_->motion.limit.restart();
  group_->limits_.demand_reachable(target);
  static_cast<void>(group_->flow_.borrow());
  group_->make_step();
} catch (const EvaluationLimit::Reached&) {
  group_->limits_.fail_evaluations();
}

void JoinableGroup::place(const State& state) {
  group_->clock_ = {state.time, state.time};
  group_->phase_ = {Phase::at_event, {state.time, Guard::start}};
  group_->motion_.model().unknowns.gather(state, group_->y_);
  group_->motion_.active().list().clear();
}

bool JoinableGroup::has_unbounded_force() const { return group_->phase_.event.guard == Guard::painleve; }

void JoinableGroup::output(double target, EventBalance& balance) {
  group_->memory_->motion.limit.restart();
  group_->output(target, balance);
}

double JoinableGroup::due() {
  if (group_->phase_.kind == Phase::at_rest) return std::numeric_limits<double>::infinity();
  if (group_->phase_.kind != Phase::ahead) return group_->clock_.now;
  return group_->phase_.event.guard != Guard::nothing ? group_->phase_.event.time
                                                      : group_->flow_.borrow().end();
}

void JoinableGroup::reach_due(EventBalance& balance) try {
  group_->memory_->motion.limit.restart();
  if (group_->phase_.event.guard != Guard::nothing) return group_->land(group_->phase_.event);
  group_->accept_step(balance);
} catch (const EvaluationLimit::Reached&) {
  group_->limits_.fail_evaluations();
}

void JoinableGroup::arrive(EventBalance& balance) try {
  group_->memory_->motion.limit.restart();
  EventInstant at(group_->motion_, group_->memory_->instant, group_->clock_.now, group_->y_, balance);
  group_->arrive_at(group_->phase_.event, at);
} catch (const EvaluationLimit::Reached&) {
  group_->limits_.fail_evaluations();
}

bool JoinableGroup::resolve(EventBalance& balance) try {
  group_->memory_->motion.limit.restart();
  group_->resolve_event(balance);
  balance.settle();
  if (group_->phase_.kind != Phase::parted) return true;
  book_end(balance);
  return false;
} catch (const EvaluationLimit::Reached&) {
  group_->limits_.fail_evaluations();
}

/// True if closed contacts connect all components.
bool JoinableGroup::is_connected() const {
  const std::vector<MotionUnknowns::Part>& parts = group_->motion_.model().parts();
  if (parts.size() == 1) return true;
  const Assembly& assembly = *group_->motion_.model().assembly;
  UnionFind& sets = group_->memory_->components;
  sets.start(static_cast<Index>(assembly.components().size()));
  for (const ActiveContact& contact : group_->motion_.active().list()) {
    if (contact.pair.other == none) continue;
    sets.join(assembly.component_of(contact.pair.body), assembly.component_of(contact.pair.other));
  }
  const Index first = sets.find(parts.front().component);
  return std::all_of(parts.begin(), parts.end(),
                     [&](const MotionUnknowns::Part& part) { return sets.find(part.component) == first; });
}

/// Books the works up to the present: others go on with the motion.
void JoinableGroup::book_end(EventBalance& balance) {
  std::copy(group_->y_.begin(), group_->y_.end(), group_->output_.y().begin());
  group_->output_.book(0.0, balance);
}

/// Ends a motion at a time of its last step: books it up to there and writes its state.
void JoinableGroup::end(double time, State& state, EventBalance& balance) {
  if (group_->phase_.kind == Phase::ahead) {
    Flow& flow = group_->flow_.borrow();
    flow.land(time, group_->y_);
    group_->flow_.keep_step(flow.next_step());
  }
  group_->clock_.now = time;
  book_end(balance);
  group_->motion_.model().unknowns.scatter(group_->y_, state);
  group_->flow_.leave(true, false);
}

void JoinableGroup::join(std::span<ClockGroup* const> groups, double time, double output, State& state,
                         EventBalance& balance) try {
  group_->memory_->motion.limit.restart();
  std::vector<ActiveContact>& active = group_->motion_.active().list();
  active.clear();
  group_->impacts_.start();
  group_->modes_.start();
  double step = std::numeric_limits<double>::infinity();
  const std::vector<ContactPair>& pairs = group_->motion_.model().pairs;
  for (ClockGroup* const group : groups) {
    JoinableGroup(*group).end(time, state, balance);
    for (const ActiveContact& contact : group->motion_.active().list()) {
      const auto place = std::find(pairs.begin(), pairs.end(), contact.pair);
      active.emplace_back(contact).place = static_cast<Index>(place - pairs.begin());
    }
    group_->impacts_.take(group->impacts_);
    group_->modes_.take(group->modes_, time);
    if (group->flow_.kept_step() > 0.0) step = std::min(step, group->flow_.kept_step());
  }
  state.time = time;
  group_->clock_ = {time, output};
  group_->motion_.model().unknowns.gather(state, group_->y_);
  group_->output_.start(group_->y_);
  group_->limits_.start(time);
  group_->detector_.start();
  group_->flow_.keep_step(step < std::numeric_limits<double>::infinity() ? step : 0.0);
  group_->phase_ = {Phase::at_event, {time, Guard::meeting}};
} catch (const EvaluationLimit::Reached&) {
  group_->limits_.fail_evaluations();
}

void JoinableGroup::part(const ClockGroup& from, State& state, EventBalance& balance) try {
  group_->memory_->motion.limit.restart();
  from.motion_.model().unknowns.scatter(from.y_, state);
  group_->clock_ = from.clock_;
  group_->motion_.model().unknowns.gather(state, group_->y_);
  group_->output_.start(group_->y_);
  group_->impacts_.start();
  group_->impacts_.take(from.impacts_);
  group_->modes_.start();
  group_->limits_.start(group_->clock_.now);
  group_->detector_.start();
  group_->flow_.keep_step(from.flow_.kept_step());
  std::vector<ActiveContact>& active = group_->motion_.active().list();
  active.clear();
  const std::vector<ContactPair>& pairs = group_->motion_.model().pairs;
  for (const ActiveContact& contact : from.motion_.active().list()) {
    const auto place = std::find(pairs.begin(), pairs.end(), contact.pair);
    if (place == pairs.end()) continue;
    active.emplace_back(contact).place = static_cast<Index>(place - pairs.begin());
  }
  EventInstant at(group_->motion_, group_->memory_->instant, group_->clock_.now, group_->y_, balance);
  at.update();
  at.scales = event_scales(group_->motion_, at.now, at.contacts);
  group_->phase_ = {group_->start_flow(at)};
} catch (const EvaluationLimit::Reached&) {
  group_->limits_.fail_evaluations();
}

void JoinableGroup::sample(double time, bool landed, MotionSample& out) try {
  group_->memory_->motion.limit.restart();
  std::vector<double>& y = group_->memory_->detection.y;
  y.assign(group_->y_.begin(), group_->y_.end());
  if (group_->phase_.kind == Phase::ahead && time > group_->clock_.now) {
    Flow& flow = group_->flow_.borrow();
    if (landed) {
      flow.land(time, y);
    } else {
      flow.sample(time, y);
    }
  }
  group_->motion_.sample(time, y.data(), Forces::all, out);
} catch (const EvaluationLimit::Reached&) {
  group_->limits_.fail_evaluations();
}

}  // namespace carom
