#pragma once

/// \file
/// Forces of the closed contacts of a model at rest against their cones of friction.

#include <carom/analysis/resting_constraints.h>

#include <Eigen/Core>

namespace carom {

/// Distance of the force of a support from its cone, <= 0 inside [N]. \param l multipliers of the divided
/// rows
[[nodiscard]] double outside_cone(const RestingConstraints& constraints,
                                  const RestingConstraints::Support& support, const Eigen::VectorXd& l);

/// Multipliers with the same sum G^T l whose supports are within their cones, if the rows leave that open.
[[nodiscard]] Eigen::VectorXd shared_within_cones(const RestingConstraints& constraints,
                                                  const Eigen::VectorXd& l);

}  // namespace carom
