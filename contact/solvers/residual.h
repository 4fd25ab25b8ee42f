#pragma once

/// \file
/// How wrong is an answer? One certificate judges every solver (docs/method.md, section 3), from the
/// problem and the impulses alone.

#include <carom/contact/solvers/contact_problem.h>
#include <carom/core/export.h>

#include <span>

namespace carom {

/// A group whose trace of W is below this part of the largest trace counts as immovable (trace zero):
/// such a trace is rounding of a zero.
inline constexpr double negligible_trace = 1e-15;

/// Trace of the block W_ii of a group [1/kg].
[[nodiscard]] inline double group_trace(const ContactProblem& problem, const RowGroup& group) {
  double sum = problem.diagonal(group.first);
  for (int i = group.first + 1; i < group.first + group.size; ++i) sum += problem.diagonal(i);
  return sum;
}

/// Worst relative residual over the groups of a problem.
struct Residual {
  double value = 0.0;  ///< dimensionless; infinity where a number is not finite
  int group = -1;      ///< group where it is found; -1 for a problem without groups
};

/// max over groups i of  |P - proj_C(P - rho xi)|_inf / P*,  rho = 1 / trace W_ii,
/// with C = [0, inf), [lower, upper], [-mu P_n, mu P_n] or the disc of that radius (P_n < 0 counts as 0), the
/// point coefficient * P_n of a proportional row whatever its xi, and
/// P* = max(|P|, |b| / trace W_ii) [N s] over the whole problem. 0 where P* = 0.
/// Infinity for one planar contact whose impulses are so large that of b in W P + b only a few digits are
/// left.
///
/// `impulse` [N s] and `xi` = W P + b [m/s] have size rows(); the problem is grouped. An immovable group
/// takes the largest trace of the problem for its own; in a problem without any mobility rho = 1 kg.
[[nodiscard]] CAROM_API Residual residual(const ContactProblem& problem, std::span<const double> impulse,
                                          std::span<const double> xi);

/// Errors of the law as velocities, against the free velocities alone: max over groups of
/// |P - proj_C(P - rho xi)|_inf / rho over max |b|. Impulses of bodies that jam can be far larger than what
/// changes their velocities needs; this tells how well the law holds all the same. 0 where there are no
/// errors, infinity where there are and b = 0.
[[nodiscard]] CAROM_API double residual_of_velocities(const ContactProblem& problem,
                                                      std::span<const double> impulse,
                                                      std::span<const double> xi);

}  // namespace carom
