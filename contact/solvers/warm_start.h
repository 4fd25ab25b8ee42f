#pragma once

/// \file
/// An answer to start from: that of a problem of the same rows, solved before. An iteration around a contact
/// problem could not settle if the answers jumped between several solutions, so solvers keep to the modes of
/// the answer before as long as they are those of a solution.

#include <carom/contact/solvers/contact_mode.h>
#include <carom/contact/solvers/contact_problem.h>
#include <carom/contact/solvers/newton_polish.h>
#include <carom/core/export.h>

#include <span>
#include <vector>

namespace carom {

/// Residual up to which impulses to start from are an answer as they are, so that nothing is factored:
/// rounding of the sums that it is made of. Bodies at rest stay where they are, to the rounding of places.
inline constexpr double certified_start = 1e-14;

/// Solves a problem in given modes. Keeps memory only.
class CAROM_API WarmStart {
public:
  /// Improves impulses within their modes; false, with the impulses as they were, if the modes are not those
  /// of a solution. \param found out: residual of the answer
  [[nodiscard]] bool keep_modes(const ContactProblem& problem, std::span<const ContactMode> modes,
                                std::vector<double>& impulse, Residual& found);

private:
  NewtonPolish polish_;
  std::vector<double> trial_, xi_;
};

}  // namespace carom
