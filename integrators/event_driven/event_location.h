#pragma once

/// \file
/// The time of a predicted event, by steps of the flow that end on it.

#include <carom/core/export.h>
#include <carom/integrators/event_driven/event.h>
#include <carom/integrators/event_driven/searched_step.h>

namespace carom {

/// Locates an event. Returns `painleve` where a force has a pole in place of an end, `restart` where nothing
/// is found. \param landing out: the state at the event, if a step ended there
[[nodiscard]] CAROM_API Event locate_event(SearchedStep& step, const Event& predicted, Landing& landing);

}  // namespace carom
