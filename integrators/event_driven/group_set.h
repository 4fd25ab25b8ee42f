#pragma once

/// \file
/// Clock groups of a model: one for each component, and those into which components are joined for a while.

#include <carom/contact/detection/body_pairs.h>
#include <carom/contact/detection/detector.h>
#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/integrators/event_driven/clock_group.h>
#include <carom/integrators/event_driven/group_memory.h>
#include <carom/integrators/run/event_driven.h>

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace carom {

/// The groups. At any time each component is of one.
class CAROM_API GroupSet {
public:
  /// All must outlive it. Throws ModelError as ClockGroup.
  GroupSet(const Assembly& assembly, const Detector& detector, const EventDriven& options,
           GroupMemory& memory);

  /// The group of a component.
  [[nodiscard]] ClockGroup& of(Index component) { return *of_[component]; }
  /// Calls f(group) for each group, in the order of their first components.
  template <class F>
  void for_each(F&& f) {
    for (Index component = 0; component < of_.size(); ++component) {
      if (first_component(*of_[component]) == component) f(*of_[component]);
    }
  }
  /// The first component of a group.
  [[nodiscard]] static Index first_component(const ClockGroup& group) {
    return group.motion().model().parts().front().component;
  }

  /// Pairs of bodies that may touch; there must be some (Detector::bodies_touch()).
  [[nodiscard]] const BodyPairs& pairs() const { return *pairs_; }
  /// The group that some components would be. It is none of the set until it is put there. \param components
  /// ascending
  [[nodiscard]] std::unique_ptr<ClockGroup> make(std::span<const Index> components) const;
  /// Each component is a group of its own from now on.
  void part_all();
  /// Puts a group in place of those that its components were of, which must have no others.
  ClockGroup& put(std::unique_ptr<ClockGroup> group);
  /// A component is a group of its own from now on; its last group is to be put away when all are parted.
  ClockGroup& put_alone(Index component);
  /// The last group of a component, out of the set: to be kept as long as it is read. Null of one alone.
  [[nodiscard]] std::unique_ptr<ClockGroup> take(const ClockGroup& group);

private:
  const Assembly* assembly_;
  const Detector* detector_;
  const EventDriven* options_;
  GroupMemory* memory_;
  std::optional<BodyPairs> pairs_;                   // none where no two bodies may touch
  std::vector<std::unique_ptr<ClockGroup>> alone_;   // by component
  std::vector<std::unique_ptr<ClockGroup>> joined_;  // by first component; empty until there is one
  std::vector<ClockGroup*> of_;                      // by component
};

}  // namespace carom
