#pragma once

/// \file
/// From time stepping to the event-driven mode: time stepping leaves bodies a little inside shapes on ground,
/// and in each other. Contacts with ground that approach are resolved by an impact, then bodies are moved out
/// and apart (docs/method.md, section 7).

#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/integrators/event_driven/event_driver.h>
#include <carom/integrators/run/companion.h>
#include <carom/integrators/run/recorded_events.h>
#include <carom/integrators/run/step_report.h>

#include <vector>

namespace carom {

/// Changes the state so that an event-driven run can start from it, books the energy as `mode_switch`, and
/// tells the largest displacement (StepReport::projected) and the contacts. Throws SolverError naming
/// contacts of bodies that have no room, and ModelError of a state that is no start; nothing has changed
/// then. \param driver that is to run
CAROM_API void prepare_for_events(const Assembly& assembly, EventDriver& driver, State& state,
                                  Companion& companion, StepReport& report, RecordedEvents& events);

}  // namespace carom
