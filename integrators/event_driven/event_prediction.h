#pragma once

/// \file
/// First event in a step by polynomials of its guards: gaps to rounding, other guards to a part of the step.

#include <carom/core/export.h>
#include <carom/integrators/event_driven/event.h>
#include <carom/integrators/event_driven/searched_step.h>

#include <vector>

namespace carom {

/// Guards of a step that turned out to be false alarms.
struct FalseAlarms {
  std::vector<double> gaps;  ///< by pair: its gap is looked at from then on [s]
  std::vector<char> forces;  ///< by island that touches: not looked at
};

/// The first event, or `nothing` at the end of the step.
[[nodiscard]] CAROM_API Event predict_event(SearchedStep& step, const FalseAlarms& passed_over);
/// The first closing of a gap before an event, else that event.
[[nodiscard]] CAROM_API Event predict_gap(SearchedStep& step, const FalseAlarms& passed_over, Event before);

}  // namespace carom
