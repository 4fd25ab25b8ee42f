#include <carom/core/errors.h>
#include <carom/core/listed.h>

#include <utility>

namespace carom {

SolverError::SolverError(const std::string& message, SolverFailure failure)
    : Error(shortened(message, longest_message)), failure_(std::move(failure)) {}

const ContactProblem& SolverError::problem() const {
  if (!has_problem()) throw std::logic_error("SolverError::problem: no contact problem is attached");
  return *failure_.problem;
}

}  // namespace carom
