// Problem: a clock group among others, which it may meet: it goes on event by event, becomes part of another
// group where bodies touch, and parts where nothing lasting connects them.

#include <carom/core/numerics/union_find.h>
#include <carom/integrators/event_driven/clock_group.h>

#include <algorithm>
#include <limits>

namespace carom {

void ClockGroup::go_ahead(double target) try {
  if (phase_.kind != Phase::flowing) return;
  memory_->motion.limit.restart();
  limits_.demand_reachable(target);
  static_cast<void>(flow_.borrow());
  make_step();
} catch (const EvaluationLimit::Reached&) {
  limits_.fail_evaluations();
}

void ClockGroup::place(const State& state) {
  clock_ = {state.time, state.time};
  phase_ = {Phase::at_event, {state.time, Guard::start}};
  motion_.model().unknowns.gather(state, y_);
  motion_.active().list().clear();
}

double ClockGroup::due() {
  if (phase_.kind == Phase::at_rest) return std::numeric_limits<double>::infinity();
  if (phase_.kind != Phase::ahead) return clock_.now;
  return phase_.event.guard != Guard::nothing ? phase_.event.time : flow_.borrow().end();
}

void ClockGroup::reach_due(EventBalance& balance) try {
  memory_->motion.limit.restart();
  if (phase_.event.guard != Guard::nothing) return land(phase_.event);
  accept_step(balance);
} catch (const EvaluationLimit::Reached&) {
  limits_.fail_evaluations();
}

void ClockGroup::arrive(EventBalance& balance) try {
  memory_->motion.limit.restart();
  EventInstant at(motion_, memory_->instant, clock_.now, y_, balance);
  arrive_at(phase_.event, at);
} catch (const EvaluationLimit::Reached&) {
  limits_.fail_evaluations();
}

bool ClockGroup::resolve(EventBalance& balance) try {
  memory_->motion.limit.restart();
  resolve_event(balance);
  balance.settle();
  if (phase_.kind != Phase::parted) return true;
  book_end(balance);
  return false;
} catch (const EvaluationLimit::Reached&) {
  limits_.fail_evaluations();
}

/// True if closed contacts connect all components.
bool ClockGroup::is_connected() const {
  const std::vector<MotionUnknowns::Part>& parts = motion_.model().parts();
  if (parts.size() == 1) return true;
  const Assembly& assembly = *motion_.model().assembly;
  UnionFind& sets = memory_->components;
  sets.start(static_cast<Index>(assembly.components().size()));
  for (const ActiveContact& contact : motion_.active().list()) {
    if (contact.pair.other == none) continue;
    sets.join(assembly.component_of(contact.pair.body), assembly.component_of(contact.pair.other));
  }
  const Index first = sets.find(parts.front().component);
  return std::all_of(parts.begin(), parts.end(),
                     [&](const MotionUnknowns::Part& part) { return sets.find(part.component) == first; });
}

/// Books the works up to the present: others go on with the motion.
void ClockGroup::book_end(EventBalance& balance) {
  std::copy(y_.begin(), y_.end(), output_.y().begin());
  output_.book(0.0, balance);
}

/// Ends a motion at a time of its last step: books it up to there and writes its state.
void ClockGroup::end(double time, State& state, EventBalance& balance) {
  if (phase_.kind == Phase::ahead) {
    Flow& flow = flow_.borrow();
    flow.land(time, y_);
    flow_.keep_step(flow.next_step());
  }
  clock_.now = time;
  book_end(balance);
  motion_.model().unknowns.scatter(y_, state);
  flow_.leave(true, false);
}

void ClockGroup::join(std::span<ClockGroup* const> groups, double time, double output, State& state,
                      EventBalance& balance) try {
  memory_->motion.limit.restart();
  std::vector<ActiveContact>& active = motion_.active().list();
  active.clear();
  impacts_.start();
  modes_.start();
  double step = std::numeric_limits<double>::infinity();
  const std::vector<ContactPair>& pairs = motion_.model().pairs;
  for (ClockGroup* const group : groups) {
    group->end(time, state, balance);
    for (const ActiveContact& contact : group->motion_.active().list()) {
      const auto place = std::find(pairs.begin(), pairs.end(), contact.pair);
      active.emplace_back(contact).place = static_cast<Index>(place - pairs.begin());
    }
    impacts_.take(group->impacts_);
    modes_.take(group->modes_, time);
    if (group->flow_.kept_step() > 0.0) step = std::min(step, group->flow_.kept_step());
  }
  state.time = time;
  clock_ = {time, output};
  motion_.model().unknowns.gather(state, y_);
  output_.start(y_);
  limits_.start(time);
  detector_.start();
  flow_.keep_step(step < std::numeric_limits<double>::infinity() ? step : 0.0);
  phase_ = {Phase::at_event, {time, Guard::meeting}};
} catch (const EvaluationLimit::Reached&) {
  limits_.fail_evaluations();
}

void ClockGroup::part(const ClockGroup& from, State& state, EventBalance& balance) try {
  memory_->motion.limit.restart();
  from.motion_.model().unknowns.scatter(from.y_, state);
  clock_ = from.clock_;
  motion_.model().unknowns.gather(state, y_);
  output_.start(y_);
  impacts_.start();
  impacts_.take(from.impacts_);
  modes_.start();
  limits_.start(clock_.now);
  detector_.start();
  flow_.keep_step(from.flow_.kept_step());
  std::vector<ActiveContact>& active = motion_.active().list();
  active.clear();
  const std::vector<ContactPair>& pairs = motion_.model().pairs;
  for (const ActiveContact& contact : from.motion_.active().list()) {
    const auto place = std::find(pairs.begin(), pairs.end(), contact.pair);
    if (place == pairs.end()) continue;
    active.emplace_back(contact).place = static_cast<Index>(place - pairs.begin());
  }
  EventInstant at(motion_, memory_->instant, clock_.now, y_, balance);
  at.update();
  at.scales = event_scales(motion_, at.now, at.contacts);
  phase_ = {start_flow(at)};
} catch (const EvaluationLimit::Reached&) {
  limits_.fail_evaluations();
}

void ClockGroup::sample(double time, bool landed, MotionSample& out) try {
  memory_->motion.limit.restart();
  std::vector<double>& y = memory_->detection.y;
  y.assign(y_.begin(), y_.end());
  if (phase_.kind == Phase::ahead && time > clock_.now) {
    Flow& flow = flow_.borrow();
    if (landed) {
      flow.land(time, y);
    } else {
      flow.sample(time, y);
    }
  }
  motion_.sample(time, y.data(), Forces::all, out);
} catch (const EvaluationLimit::Reached&) {
  limits_.fail_evaluations();
}

}  // namespace carom
