// Problem: which components share a time changes in a run.

#include <carom/integrators/event_driven/group_set.h>

#include <utility>

namespace carom {

GroupSet::GroupSet(const Assembly& assembly, const Detector& detector, const EventDriven& options,
                   GroupMemory& memory)
    : assembly_(&assembly), detector_(&detector), options_(&options), memory_(&memory) {
  if (detector.bodies_touch()) pairs_.emplace(detector.outlines());
  const auto count = static_cast<Index>(assembly.components().size());
  alone_.reserve(count);
  of_.resize(count);
  for (Index component = 0; component < count; ++component) {
    alone_.push_back(make({&component, 1}));
    of_[component] = alone_.back().get();
  }
}

std::unique_ptr<ClockGroup> GroupSet::make(std::span<const Index> components) const {
  GroupComponents group;
  group.components.assign(components.begin(), components.end());
  std::vector<Index> bodies;
  if (pairs_) {
    for (const Index component : components) {
      const Range range = assembly_->components()[component].bodies;
      for (Index body = range.begin; body < range.end; ++body) bodies.push_back(body);
    }
    pairs_->append(bodies, group.body_pairs);
  }
  return std::make_unique<ClockGroup>(*assembly_, *detector_, *options_, group, *memory_);
}

void GroupSet::part_all() {
  joined_.clear();
  for (Index component = 0; component < of_.size(); ++component) of_[component] = alone_[component].get();
}

ClockGroup& GroupSet::put(std::unique_ptr<ClockGroup> group) {
  ClockGroup* const put = group.get();
  joined_.resize(of_.size());
  for (const MotionUnknowns::Part& part : put->motion().model().parts()) {
    joined_[part.component].reset();
    of_[part.component] = put;
  }
  joined_[first_component(*put)] = std::move(group);
  return *put;
}

ClockGroup& GroupSet::put_alone(Index component) {
  of_[component] = alone_[component].get();
  return *of_[component];
}

std::unique_ptr<ClockGroup> GroupSet::take(const ClockGroup& group) {
  if (joined_.empty()) return nullptr;
  return std::move(joined_[first_component(group)]);
}

}  // namespace carom
