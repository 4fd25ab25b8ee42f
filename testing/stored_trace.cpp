#include <carom/core/errors.h>
#include <carom/testing/stored_trace.h>

#include <cstdlib>
#include <filesystem>

namespace carom::energy_test {

namespace {

/// Faults of the trace; empty if there is none.
std::string objections(const EnergyTrace& trace, const std::string& path, const TraceTolerances& tolerances) {
  if (!std::filesystem::exists(path)) return "there is no stored trace '" + path + "'\n";
  try {
    const TraceComparison comparison = compare(trace, EnergyTrace::load(path), tolerances);
    return comparison.agree() ? "" : comparison.report;
  } catch (const Error& error) {
    return std::string(error.what()) + "\n";
  }
}

}  // namespace

bool rewrite_requested() {
  const char* const value = std::getenv(rewrite_variable);  // NOLINT(concurrency-mt-unsafe): nobody sets it
  const std::string text = value ? value : "";
  if (text == "1") return true;
  if (text.empty() || text == "0") return false;
  throw ModelError(std::string("environment: ") + rewrite_variable + " is '" + text +
                   "'; allowed: 1 (rewrite stored traces), 0 or nothing");
}

std::string produced_path(const std::string& path) {
  std::filesystem::path produced(path);
  produced.replace_extension(".produced" + produced.extension().string());
  return produced.string();
}

Verdict check_against_stored(const EnergyTrace& trace, const std::string& path,
                             const TraceTolerances& tolerances, const std::string& test) {
  std::string text = objections(trace, path, tolerances);
  if (text.empty()) return {true, {}};
  try {
    trace.save(produced_path(path));
    text += "the produced trace is in '" + produced_path(path) + "'\n";
  } catch (const FileError& error) {
    text += std::string(error.what()) + "\n";
  }
  text += std::string("if it is right, store it: ") + rewrite_variable + "=1 ctest -R '" + test + "'\n";
  return {false, text};
}

Verdict rewrite_stored(const EnergyTrace& trace, const std::string& path) {
  try {
    if (trace.rows().empty()) throw ModelError("trace has no rows; allowed: at least one");
    trace.save(path);
    return {true, "stored trace '" + path + "' was rewritten, nothing was compared\n"};
  } catch (const Error& error) {
    return {false, std::string(error.what()) + "\n"};
  }
}

}  // namespace carom::energy_test
