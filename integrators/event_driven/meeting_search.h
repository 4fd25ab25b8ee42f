#pragma once

/// \file
/// When bodies of one clock group meet those of others, and which of them touch at a time.

#include <carom/contact/detection/body_pair_bound.h>
#include <carom/contact/detection/contact_pair.h>
#include <carom/contact/detection/detector.h>
#include <carom/contact/detection/first_closing.h>
#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/integrators/event_driven/body_flights.h>
#include <carom/integrators/event_driven/group_set.h>
#include <carom/integrators/event_driven/meeting_queue.h>
#include <carom/integrators/event_driven/motion_sample.h>

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace carom {

/// Motions of groups at one time each: a group that is near several others is evaluated once.
class CAROM_API GroupSamples {
public:
  /// Memory for any group of a model.
  explicit GroupSamples(const Assembly& assembly) : at_(assembly) {
    at_.note_places(assembly.components().size());
  }
  /// Forgets all: groups went on.
  void forget() { known_.clear(); }
  /// Two groups at a time within their steps, by interpolation.
  [[nodiscard]] const MotionSample& at(double time, ClockGroup& a, ClockGroup& b);

private:
  void take(double time, ClockGroup& group);

  MotionSample at_;
  std::vector<std::pair<const ClockGroup*, double>> known_;  // and times
};

/// The search for meetings of groups. Keeps memory only.
class CAROM_API MeetingSearch {
public:
  /// All must outlive it.
  MeetingSearch(const Assembly& assembly, const Detector& detector, GroupSet& groups,
                const BodyFlights& flights, const EventDriven& options)
      : detector_(&detector),
        groups_(&groups),
        flights_(&flights),
        options_(&options),
        begins_(assembly),
        ends_(assembly),
        at_(assembly) {
    at_.note_places(assembly.components().size());
  }

  /// Makes appointments for all meetings of a group with others from a time on, before the horizons of both.
  /// Times of bodies that do not fly freely are guesses.
  void find(ClockGroup& group, double time, MeetingQueue& queue);
  /// When the meeting of a guess is on the exact motion [s]; infinite: there is none. \param guess of an
  /// appointment that is due and not void
  [[nodiscard]] double locate(const Guess& guess);
  /// Adds all groups that are as near to groups of a list as `near` [m], or to those added. \param time
  /// within the horizons of all
  void add_near(double time, double near, std::vector<ClockGroup*>& list);

private:
  template <class F>
  void for_neighbours(ClockGroup& group, F&& f);
  enum class Wanted : std::uint8_t { guess, exact };
  [[nodiscard]] double closing(const ContactPair& pair, double begin, Wanted wanted);
  [[nodiscard]] double least_gap(const std::array<Index, 2>& numbers, double time);
  [[nodiscard]] double noise(const ContactPair& pair, const BodyPairBound& bound) const;

  const Detector* detector_;
  GroupSet* groups_;
  const BodyFlights* flights_;
  const EventDriven* options_;
  GroupSamples begins_, ends_;      // of the times searched
  MotionSample at_;                 // of two groups
  std::vector<ContactPair> pairs_;  // of two bodies
};

}  // namespace carom
