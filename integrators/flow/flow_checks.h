#pragma once

/// \file
/// Demands of every flow on its caller, and its failures.

#include <carom/core/errors.h>
#include <carom/core/export.h>
#include <carom/integrators/flow/flow.h>

#include <cstddef>
#include <string>

namespace carom {

/// Each throws ModelError naming the call, the number and what is allowed.
CAROM_API void check_flow_problem(const FlowProblem& problem, double relative_tolerance);
CAROM_API void check_flow_bind(const FlowProblem& problem, std::size_t size, std::size_t integrals);
CAROM_API void check_flow_step(const FlowStep& step, std::size_t numbers);
CAROM_API void check_flow_size(std::size_t given, std::size_t size, const char* call);
CAROM_API void check_flow_start(double time, double first_step);
CAROM_API void check_flow_advance(bool started, double longest);
CAROM_API void check_flow_time(const Flow& flow, double time, const char* call);

/// Throws SolverError: a step from `time` of length `step` failed [s].
[[noreturn]] CAROM_API void fail_flow(const std::string& why, double time, double step);
/// Throws SolverError: a step from `time` of length `step` failed [s], because the rates at `where` are not
/// finite.
[[noreturn]] CAROM_API void fail_flow_not_finite(double where, double time, double step);
/// Throws SolverError: a step from `time` of length `step` failed [s], because steps have become as short as
/// the rounding of time.
[[noreturn]] CAROM_API void fail_flow_too_short(double time, double step);

}  // namespace carom
