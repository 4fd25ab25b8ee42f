#pragma once

/// \file
/// Contact problems whose answers were accepted at the cap of their sweeps, for whoever wants to solve them
/// better.

#include <carom/contact/island_problem.h>
#include <carom/core/errors.h>
#include <carom/core/export.h>

#include <optional>
#include <string>
#include <utility>

namespace carom {

/// Keeps the worst problem of a step, if none of the steps before had a worse one, and writes it.
class CAROM_API CappedProblem {
public:
  /// \param directory where problems are written; empty: nowhere
  explicit CappedProblem(const std::string& directory) : directory_(directory) {}

  /// Begins a step.
  void begin() { found_.reset(); }
  /// True of a problem that is to be kept.
  [[nodiscard]] bool wants(const IslandProblem& problem) const;
  /// Keeps it.
  void keep(SolverFailure found) { found_ = std::move(found); }
  /// Writes what the step has kept. `file` becomes its path, or why it could not be written; empty where
  /// there is none.
  void write(std::string& file) {
    file.clear();
    if (found_) file = write();
  }

private:
  [[nodiscard]] std::string write();

  std::string directory_;
  std::optional<SolverFailure> found_;
  double worst_ = 0.0;  // residual of those that were written
};

}  // namespace carom
