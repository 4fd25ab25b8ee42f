#pragma once

/// \file
/// How fast can the fixed-point iteration contract? From the derivatives K, C of the coupling forces: one
/// sweep of the trapezoidal rule multiplies an error by at most
///     rho(h) = (h^2/4) |M^-1 K| + (h/2) |M^-1 C|      (row-sum norm, angles weighed by radii of gyration).

#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/core/ids.h>

namespace carom {

/// The coupling that limits the contraction most, and a step at which the component contracts.
struct CouplingRating {
  ElementId worst{};              ///< invalid if no element depends on position or velocity
  double rate = 0.0;              ///< its own rho at the step asked about
  double component_rate = 0.0;    ///< rho of all elements together
  double contracting_step = 0.0;  ///< step at which rho of all elements is 1/2 [s]; 0 if any step contracts
};

/// Rates the couplings of one component at a state. The position group of `evaluation` must be up to date.
[[nodiscard]] CAROM_API CouplingRating rate_couplings(const Assembly& assembly, Index component,
                                                      const StateView& state, const Evaluation& evaluation,
                                                      double step);

/// The first element of the component whose loads are not finite at the state; invalid if there is none.
[[nodiscard]] CAROM_API ElementId find_non_finite(const Assembly& assembly, Index component,
                                                  const StateView& state, const Evaluation& evaluation);

/// The first element of the component whose potential is not finite at the state; invalid if there is none.
[[nodiscard]] CAROM_API ElementId find_non_finite_potential(const Assembly& assembly, Index component,
                                                            const StateView& state,
                                                            const Evaluation& evaluation);

}  // namespace carom
