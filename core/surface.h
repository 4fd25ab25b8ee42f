#pragma once

/// \file
/// The contact law of a pair of surfaces (docs/method.md, section 2; Johansson 1999, section 2).

#include <limits>

namespace carom {

/// Coefficients of the contact law between two surfaces. `friction` and `normal_restitution` are required.
struct Surface {
  double friction = std::numeric_limits<double>::quiet_NaN();            ///< coefficient of friction, >= 0
  double normal_restitution = std::numeric_limits<double>::quiet_NaN();  ///< e_n in [0, 1]
  double tangential_restitution = 0.0;                                   ///< e_t in [0, 1]
};

}  // namespace carom
