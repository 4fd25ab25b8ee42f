#pragma once

/// \file
/// Steps whose stages passed over loads of elements that are entered and left again: their errors seem small.

#include <carom/core/export.h>
#include <carom/integrators/event_driven/event.h>
#include <carom/integrators/event_driven/searched_step.h>

namespace carom {

/// True if the motion up to a time of the step, before which no guard changes its sign, did not follow the
/// loads halfway along its path: an element is entered and left between two stages, or the one stage that
/// meets it has no weight.
[[nodiscard]] CAROM_API bool misses_loads(SearchedStep& step, double until);

/// True if a step that ends at the event leads elsewhere than the path: it may not be landed on. \param
/// landing that of the event; made if it is not there
[[nodiscard]] CAROM_API bool lands_off_path(SearchedStep& step, const Event& event, Landing& landing);

}  // namespace carom
