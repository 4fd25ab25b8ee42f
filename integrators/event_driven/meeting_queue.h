#pragma once

/// \file
/// Times at which something is to be done about clock groups, the earliest first.

#include <carom/contact/detection/contact_pair.h>
#include <carom/core/export.h>
#include <carom/core/ids.h>

#include <cstdint>
#include <vector>

namespace carom {

/// A meeting whose time is a guess: to be found exactly when it is due, since most do not come about.
struct Guess {
  ContactPair pair = {};  ///< none: the time is no guess
  double from = 0.0;      ///< time from which on it was searched [s]
};

/// Something to be done about the group of a component, or of two that meet.
struct Appointment {
  double time = 0.0;  ///< [s]
  Index a = none;     ///< a component
  Index b = none;     ///< the component that `a` meets; `none`: the own step of `a` ends, or its volume
  std::uint32_t of_a = 0, of_b = 0;  ///< motions of `a` and `b` that it was made for
  Guess guess = {};                  ///< of a meeting that is about then
};

/// Appointments. Those that were made for a motion that has changed since are void.
class CAROM_API MeetingQueue {
public:
  /// Begins with none. \param count number of components
  void start(Index count);
  /// The motion of a component changes: all its appointments are void.
  void change(Index component) { ++motion_[component]; }
  /// Makes one. \param b may be `none` \param guess of a meeting whose time is one
  void add(double time, Index a, Index b, const Guess& guess = {});
  /// Takes out the earliest one that is not later than a time; of one time meetings, in the order of
  /// components, then the others. False if there is none.
  [[nodiscard]] bool take(double until, Appointment& out);

private:
  std::vector<std::uint32_t> motion_;  // of each component, counted
  std::vector<Appointment> heap_;      // the earliest first, as std::push_heap() has it
};

}  // namespace carom
