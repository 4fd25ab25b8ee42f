// Problem: of thousands of steps whose contact is not exact, write the few problems that are worth a look.

#include <carom/core/part_check.h>
#include <carom/integrators/run/failure_file.h>
#include <carom/integrators/time_stepping/capped_problem.h>

#include <algorithm>
#include <utility>

namespace carom {

bool CappedProblem::wants(const IslandProblem& problem) const {
  const ContactReport& report = problem.report();
  if (directory_.empty() || report.outcome != Outcome::accepted_at_cap) return false;
  return report.residual > std::max(worst_, found_ ? found_->residual : 0.0);
}

std::string CappedProblem::write() {
  const SolverFailure found = std::move(*found_);
  found_.reset();
  worst_ = found.residual;
  try {
    return save_problem_of(found, directory_,
                           "accepted at the cap of sweeps, residual " + to_text(found.residual));
  } catch (const FileError& error) {
    return error.what();
  }
}

}  // namespace carom
