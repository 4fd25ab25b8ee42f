#include <carom/contact/solvers/problem_file.h>
#include <carom/core/part_check.h>
#include <carom/integrators/run/failure_file.h>

#include <filesystem>
#include <system_error>

namespace carom {

namespace fs = std::filesystem;

void check_failure_directory(const std::string& directory, const std::string& mode) {
  if (directory.empty()) return;
  const auto refuse = [&](const std::string& allowed) {
    throw ModelError(mode + ": failure_directory is '" + directory + "'; allowed: " + allowed);
  };
  if (!problem_files_available()) refuse("none, since this carom was built without JSON (CAROM_WITH_JSON)");
  std::error_code error;
  if (!fs::is_directory(directory, error)) refuse("an existing directory, or none");
}

std::string save_problem_of(const SolverFailure& failure, const std::string& directory,
                            const std::string& comment) {
  const std::string stem = "contact_problem_t" + to_text(failure.time);
  fs::path path = fs::path(directory) / (stem + ".json");
  std::error_code error;
  // Another run, or a further try of the step, may have left one.
  for (int i = 2; fs::exists(path, error); ++i) {
    path = fs::path(directory) / (stem + "_" + std::to_string(i) + ".json");
  }
  ProblemNotes notes{.comment = comment, .time = failure.time, .contacts = {}};
  if (failure.parts.size() == failure.problem->groups().size()) notes.contacts = failure.parts;
  save_problem(path.string(), *failure.problem, notes);
  return path.string();
}

std::string write_failure(const std::string& directory, const SolverFailure& failure,
                          const std::string& message) {
  if (directory.empty() || failure.problem == nullptr) return {};
  try {
    return "; the problem is in '" + save_problem_of(failure, directory, message) + "'";
  } catch (const FileError& problem) {
    return std::string("; ") + problem.what();
  }
}

}  // namespace carom
