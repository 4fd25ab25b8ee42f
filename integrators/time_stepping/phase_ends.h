#pragma once

/// \file
/// The end of a phase that is looked for: the root of a gap over the length of the phase, by Newton's method
/// and then by secants, kept between an end at which all is open and one at which it is not. Answers of
/// contact may jump from one end to the next.

#include <carom/contact/detection/contact_pair.h>
#include <carom/core/export.h>
#include <carom/core/numerics/never.h>
#include <carom/integrators/time_stepping/step_closings.h>

namespace carom {

/// A gap where a phase has ended.
struct EndGap {
  ContactPair pair = {};         ///< whose gap it is
  double time = never;           ///< then [s]; infinite: nothing was looked at
  double gap = 0.0, rate = 0.0;  ///< [m], [m/s]
};

/// Ends of one phase that were tried.
class CAROM_API PhaseEnds {
public:
  /// Begins a phase. \param begin of the phase \param last end that it may have [s]
  PhaseEnds(double begin, double last) : begin_(begin), last_(last), open_(begin) {}

  /// A time, or the middle where that is not between the latest open end and the last one.
  [[nodiscard]] double between(double time) const {
    return time > open_ && time < last_ ? time : 0.5 * (open_ + last_);
  }
  /// Takes note of an end that was tried. \param gap of what closes, or is headed for, there \param is_late
  /// whether something closes before it
  void take(const EndGap& gap, double end, bool is_late);
  /// Forgets how far all is open.
  void reopen() { open_ = begin_; }
  /// Forgets all ends.
  void restart() { *this = PhaseEnds(begin_, last_); }
  /// The latest end up to which all is open [s].
  [[nodiscard]] double open() const { return open_; }
  /// The earliest end before which something closes; infinite: none is known [s].
  [[nodiscard]] double closed() const { return closed_; }
  /// True if no end between the two is better than the later one: the gap falls by much more between them
  /// than its rates explain, since answers of contact jump there; or it is closed at both, and hardly deeper
  /// at the later one. \param closing that is headed for
  [[nodiscard]] bool are_as_near_as_can_be(const StepClosing& closing) const;
  /// The end that is to be tried next. What is found may lie just before each end that is tried: then the
  /// ends are halved. \param closing that is headed for \param guess by its rate, or on the way of the phase
  [[nodiscard]] double next(const StepClosing& closing, double guess);

private:
  [[nodiscard]] double by_secant(const StepClosing& closing, double guess) const;

  double begin_, last_;
  double open_, closed_ = never;
  EndGap at_open_, at_closed_;
  EndGap now_, before_;   // of the last two ends that were tried
  double width_ = never;  // when it was halved last
  int idle_ = 0;          // ends that were tried since
};

}  // namespace carom
