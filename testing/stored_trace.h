#pragma once

/// \file
/// Traces that are kept beside the tests.

#include <carom/core/trace_comparison.h>
#include <carom/testing/verdict.h>

#include <string>

namespace carom::energy_test {

/// Name of the environment variable by which stored traces are rewritten on purpose.
inline constexpr const char* rewrite_variable = "CAROM_REWRITE_TRACES";

/// Whether the environment asks for stored traces to be rewritten: the variable is "1". Not if it is "0",
/// empty or not there. Throws ModelError for anything else.
[[nodiscard]] bool rewrite_requested();

/// "traces/pair.csv" -> "traces/pair.produced.csv": where a trace goes that does not match.
[[nodiscard]] std::string produced_path(const std::string& path);

/// Compares a trace with the one stored at `path`. If it does not match, cannot be compared, or there is no
/// stored one, the trace is written to produced_path() and the verdict says so, with the report and with how
/// to accept the trace. \param test name of the test, for that advice
[[nodiscard]] Verdict check_against_stored(const EnergyTrace& trace, const std::string& path,
                                           const TraceTolerances& tolerances, const std::string& test);

/// Stores a trace at `path` in place of what was there. Holds, and says what was done; or does not and says
/// why it cannot be written.
[[nodiscard]] Verdict rewrite_stored(const EnergyTrace& trace, const std::string& path);

}  // namespace carom::energy_test
