#pragma once

/// \file
/// Mean forces over a step, whose parts each have their own records.

#include <carom/core/export.h>
#include <carom/integrators/run/lasting_contact.h>
#include <carom/integrators/run/step_report.h>

#include <vector>

namespace carom {

/// True if a step of time stepping has records of several parts: two halves of step control, or parts between
/// closings. The directions of one contact then differ by what turns within the step.
[[nodiscard]] CAROM_API bool is_parted(const StepReport& report);
/// Mean forces of the contacts and limits that last in a step of time stepping, one for each, those of
/// impacts left out; in the order of their first records, with the places of their last ones where
/// is_parted().
[[nodiscard]] CAROM_API std::vector<LastingContact> forces_of_step(const StepReport& report);

}  // namespace carom
