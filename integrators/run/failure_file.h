#pragma once

/// \file
/// Files that a failed step leaves behind in a directory that was set for it.

#include <carom/core/errors.h>
#include <carom/core/export.h>

#include <string>

namespace carom {

/// Throws ModelError "<mode>: failure_directory is ..." unless it is empty or a directory in which problems
/// can be written (the library was built with JSON).
CAROM_API void check_failure_directory(const std::string& directory, const std::string& mode);

/// Writes the contact problem that a failure has to a new file in the directory. Returns its path. Throws
/// FileError. \param comment of the file
[[nodiscard]] CAROM_API std::string save_problem_of(const SolverFailure& failure,
                                                    const std::string& directory, const std::string& comment);

/// Writes the contact problem of a failure, if it has one, to a new file in the directory. Returns the text
/// that the message of the error should add: "; the problem is in '<path>'", or why it could not be written;
/// nothing where no directory is set. Never throws for a file.
[[nodiscard]] CAROM_API std::string write_failure(const std::string& directory, const SolverFailure& failure,
                                                  const std::string& message);

}  // namespace carom
