#pragma once

/// \file
/// The report of a step that was made in parts: of its time, or of its bodies.

#include <carom/core/export.h>
#include <carom/integrators/run/step_report.h>

namespace carom {

/// Adds the report of the next part of a step to that of the parts before it, but for the length. Findings
/// stay. Joints must be the same in both.
CAROM_API void add(const StepReport& part, StepReport& sum);
/// Joins the report of the same step of other bodies, but for the length. Findings stay.
CAROM_API void join(const StepReport& part, StepReport& sum);

}  // namespace carom
