// Problem: many groups at their own pace, of which few meet at a time.

#include <carom/core/numerics/never.h>
#include <carom/integrators/event_driven/group_meetings.h>
#include <carom/integrators/event_driven/joinable_group.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace carom {

GroupMeetings::GroupMeetings(const Assembly& assembly, const Detector& detector, const EventDriven& options,
                             GroupMemory& memory, GroupSet& groups)
    : assembly_(&assembly),
      options_(&options),
      memory_(&memory),
      groups_(&groups),
      flights_(assembly, detector),
      search_(assembly, detector, groups, flights_, options),
      now_(assembly),
      end_(assembly),
      joined_(assembly.layout()) {
  for (MotionSample* sample : {&now_, &end_}) sample->note_places(assembly.components().size());
}

/// Distance at which bodies take part in an event of their neighbours [m].
double GroupMeetings::near() const {
  // As islands are found at an event (EventInstant::find_islands()).
  constexpr double moved = 4.0;
  return moved * options_->gap_tolerance;
}

void GroupMeetings::regroup(const State& state) {
  groups_->part_all();
  memory_->motion.limit.restart();
  flights_.start(state, near());
  groups_->for_each([&](ClockGroup& group) { JoinableGroup(group).place(state); });
  const auto count = static_cast<Index>(assembly_->components().size());
  std::vector<char> is_taken(count, 0);
  std::vector<std::vector<Index>> groups;
  for (Index component = 0; component < count; ++component) {
    if (is_taken[component] != 0) continue;
    list_.assign(1, &groups_->of(component));
    search_.add_near(state.time, near(), list_);
    std::vector<Index> components;
    for (const ClockGroup* group : list_) components.push_back(GroupSet::first_component(*group));
    std::sort(components.begin(), components.end());
    for (const Index of : components) is_taken[of] = 1;
    if (components.size() > 1) groups.push_back(std::move(components));
  }
  for (const std::vector<Index>& components : groups) groups_->put(groups_->make(components));
}

void GroupMeetings::start(double time) {
  queue_.start(static_cast<Index>(assembly_->components().size()));
  groups_->for_each([&](ClockGroup& group) { queue_.add(time, GroupSet::first_component(group), none); });
  target_ = time;
}

void GroupMeetings::aim_at(double to) {
  from_ = target_;
  target_ = to;
}

void GroupMeetings::advance(double to, EventBalance& balance, double& reached) {
  Appointment at;
  while (queue_.take(to, at)) {
    reached = at.time;
    keep(at, balance);
  }
  reached = to;
}

void GroupMeetings::output(double to, EventBalance& balance) {
  groups_->for_each([&](ClockGroup& group) { JoinableGroup(group).output(to, balance); });
}

void GroupMeetings::keep(const Appointment& at, EventBalance& balance) {
  ClockGroup& group = groups_->of(at.a);
  if (at.b != none) {
    ClockGroup& other = groups_->of(at.b);
    if (&group == &other) return;
    double time = at.time;
    if (at.guess.pair.body != none) time = search_.locate(at.guess);
    if (time > at.time) {
      if (time < never) queue_.add(time, at.a, at.b);
      return;
    }
    list_.assign({&group, &other});
    search_.add_near(time, near(), list_);
    // Found a little earlier than guessed, it may be before steps that have begun since.
    for (const ClockGroup* const meets : list_) time = std::max(time, meets->now());
    ClockGroup& joined = join(time, balance);
    JoinableGroup(joined).count_meeting();
    return resolve(joined, balance);
  }
  if (group.is_at_event()) return resolve(group, balance);
  list_.assign(1, &group);
  if (at.time < JoinableGroup(group).due()) return go_on(at.time);
  JoinableGroup(group).reach_due(balance);
  if (!group.is_at_event()) return go_on(at.time);
  if (!JoinableGroup(group).has_unbounded_force()) search_.add_near(at.time, near(), list_);
  if (list_.size() == 1) return resolve(group, balance);
  JoinableGroup(group).arrive(balance);
  resolve(join(at.time, balance), balance);
}

/// Joins the groups of the list.
ClockGroup& GroupMeetings::join(double time, EventBalance& balance) {
  std::vector<Index> components;
  for (const ClockGroup* group : list_) {
    for (const MotionUnknowns::Part& part : group->motion().model().parts()) {
      components.push_back(part.component);
      queue_.change(part.component);
    }
  }
  std::sort(components.begin(), components.end());
  std::unique_ptr<ClockGroup> joined = groups_->make(components);
  JoinableGroup(*joined).join(list_, time, from_, joined_, balance);
  return groups_->put(std::move(joined));
}

/// Resolves the event of a group; it goes on, or its parts do.
void GroupMeetings::resolve(ClockGroup& group, EventBalance& balance) {
  const bool whole = JoinableGroup(group).resolve(balance);
  for (const MotionUnknowns::Part& part : group.motion().model().parts()) queue_.change(part.component);
  const double time = group.now();
  list_.assign(1, &group);
  if (!whole) part(group, balance);
  go_on(time);
}

/// Parts a group into what closed contacts connect; the list has the parts then.
void GroupMeetings::part(ClockGroup& group, EventBalance& balance) {
  const std::unique_ptr<ClockGroup> last = groups_->take(group);
  std::vector<std::pair<Index, Index>> by_set;  // the set that a component is of, and the component
  for (const MotionUnknowns::Part& part : last->motion().model().parts()) {
    by_set.emplace_back(memory_->components.partition.island_of(part.component), part.component);
  }
  std::sort(by_set.begin(), by_set.end());
  list_.clear();
  std::vector<Index> components;
  for (std::size_t i = 0; i < by_set.size(); ++i) {
    components.push_back(by_set[i].second);
    if (i + 1 < by_set.size() && by_set[i + 1].first == by_set[i].first) continue;
    ClockGroup& fresh = components.size() == 1 ? groups_->put_alone(components.front())
                                               : groups_->put(groups_->make(components));
    JoinableGroup(fresh).part(*last, joined_, balance);
    list_.push_back(&fresh);
    components.clear();
  }
}

/// The groups of the list make their next steps, if they are at the end of one, and are looked after until
/// their horizons.
void GroupMeetings::go_on(double time) {
  for (ClockGroup* const group : list_) {
    JoinableGroup(*group).go_ahead(target_);
    static_cast<void>(flights_.follow(*group, time, now_, end_));
  }
  for (ClockGroup* const group : list_) {
    search_.find(*group, time, queue_);
    const Index first = GroupSet::first_component(*group);
    const double horizon = flights_.horizon(first);
    if (horizon < std::numeric_limits<double>::infinity()) queue_.add(horizon, first, none);
  }
}

}  // namespace carom
