#pragma once

/// \file
/// Errors: invalid models, computations that do not succeed, files. A violated invariant of the library
/// itself is an assert.

#include <carom/core/export.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace carom {

class ContactProblem;

/// Base of everything the library throws.
class CAROM_API Error : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// An invalid model, state, option or call. The message names the part, the value and what is allowed.
class CAROM_API ModelError : public Error {
public:
  using Error::Error;
};

/// Data of a computation that did not succeed.
struct SolverFailure {
  double time = 0.0;                                ///< time of the last good state [s]
  double step = 0.0;                                ///< step that failed [s]
  double suggested_step = 0.0;                      ///< step expected to succeed [s], 0 if unknown
  double residual = 0.0;                            ///< the residual that was too large, 0 if there is none
  std::vector<std::string> parts{};                 ///< names of the parts involved, the worst first
  std::shared_ptr<const ContactProblem> problem{};  ///< contact problem that failed, may be null
};

/// A computation that did not succeed. The simulation is at its last good state.
class CAROM_API SolverError : public Error {
public:
  SolverError(const std::string& message, SolverFailure failure);

  /// Data of the failure.
  [[nodiscard]] const SolverFailure& failure() const { return failure_; }
  /// True if a contact problem is attached.
  [[nodiscard]] bool has_problem() const { return failure_.problem != nullptr; }
  /// The contact problem that failed. Throws std::logic_error if there is none.
  [[nodiscard]] const ContactProblem& problem() const;

private:
  SolverFailure failure_;
};

/// A file that cannot be read or written, or does not fit the model.
class CAROM_API FileError : public Error {
public:
  using Error::Error;
};

}  // namespace carom
