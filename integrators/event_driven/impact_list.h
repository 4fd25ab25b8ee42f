#pragma once

/// \file
/// The contacts in the report of an event-driven step: what its impacts were. Records of both are large, and
/// a step that nobody looks at may have very many events.

#include <carom/core/export.h>
#include <carom/integrators/run/recorded_events.h>
#include <carom/integrators/run/step_report.h>

#include <cstddef>

namespace carom {

/// Lists the impacts among the latest records of a run in the report of the step that they are of.
/// \param latest how many records the step made
CAROM_API void list_impacts(const RecordedEvents& events, std::size_t latest, StepReport& report);

}  // namespace carom
