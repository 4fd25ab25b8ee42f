#pragma once

/// \file
/// Contact problems as files, so that a failure can be sent to somebody: JSON, described in
/// docs/contact_problems.md. The program carom-solve-contact solves them.

#include <carom/contact/solvers/contact_problem.h>
#include <carom/core/export.h>

#include <optional>
#include <string>
#include <vector>

namespace carom {

/// Notes of a file beside the problem; they change no answer.
struct ProblemNotes {
  std::string comment{};                ///< where it comes from
  std::optional<double> time{};         ///< when it arose [s]
  std::vector<std::string> contacts{};  ///< name of each group of rows, or none at all
};

/// A problem with its notes.
struct ProblemFile {
  ContactProblem problem;
  ProblemNotes notes;
};

/// Whether the library was built with JSON; without it both functions below throw.
[[nodiscard]] CAROM_API bool problem_files_available();

/// Writes a problem, every number exactly; an existing file is replaced only when the new one is complete.
/// Throws FileError.
CAROM_API void save_problem(const std::string& path, const ContactProblem& problem,
                            const ProblemNotes& notes);
/// Writes a problem without notes, every number exactly; an existing file is replaced only when the new one
/// is complete. Throws FileError.
CAROM_API void save_problem(const std::string& path, const ContactProblem& problem);

/// Reads a problem and groups it. Throws FileError naming the file, the field, its value and what is allowed:
/// W and b may hold "inf", "-inf" and "nan", sets must be such that ContactProblem::group() takes them, and W
/// symmetric to a part of 1e-12 of sqrt(W_ii W_jj).
[[nodiscard]] CAROM_API ProblemFile load_problem(const std::string& path);

}  // namespace carom
