#pragma once

/// \file
/// Events of a clock group: why its flow stops, and what it is in between.

#include <cstddef>
#include <cstdint>

namespace carom {

/// Guards of a clock group: what ends a smooth phase.
enum class Guard : std::uint8_t {
  nothing,          ///< no event
  start,            ///< a motion begins: gaps within the tolerance count as touching
  meeting,          ///< groups were joined within their motions: bodies of two of them touch
  gap,              ///< a gap closes
  force,            ///< a contact force comes to its end
  slip,             ///< sliding stops
  feature,          ///< a vertex comes to the end of the feature of an outline that it touches
  switching_point,  ///< loads of an element change their form
  discontinuity,    ///< a law of time jumps
  painleve,         ///< forces of contact grow without bound
  restart,          ///< a false alarm: the flow is to start anew
  missed_loads      ///< a step passed over loads: it is to be repeated, shorter
};

/// An event within a step.
struct Event {
  double time = 0.0;  ///< [s]
  Guard guard = Guard::nothing;
  std::size_t which = 0;  ///< pair, island that touches, closed contact, or guard of an element
  double sign = 1.0;      ///< of the guard of an element before
};

/// State of a clock group.
struct Phase {
  enum Kind : std::uint8_t {
    at_event,  ///< its time is that of `event`, which is not resolved yet
    flowing,   ///< modes are decided; the flow stands at its time
    ahead,     ///< modes are decided; the flow made a step beyond its time, in which `event` is the first
    parted,    ///< modes are decided, and nothing lasting connects all components
    at_rest    ///< nothing moves, nor will
  };
  Kind kind = at_event;
  Event event{};
};

}  // namespace carom
