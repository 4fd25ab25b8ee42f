#pragma once

/// \file
/// First event in a step by polynomials of its guards: gaps (group_gaps.h) to rounding, other guards to a
/// part of the step.

#include <carom/core/export.h>
#include <carom/integrators/event_driven/event.h>
#include <carom/integrators/event_driven/searched_step.h>

namespace carom {

/// The first event, or `nothing` at the end of the step.
[[nodiscard]] CAROM_API Event predict_event(SearchedStep& step, const FalseAlarms& passed_over);

}  // namespace carom
