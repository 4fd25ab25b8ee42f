#include <carom/analysis/support_forces.h>
#include <carom/core/numerics/sparse_factors.h>

#include <Eigen/QR>

#include <algorithm>
#include <cmath>

namespace carom {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

}  // namespace

double outside_cone(const RestingConstraints& constraints, const RestingConstraints::Support& support,
                    const VectorXd& l) {
  const VectorXd& norms = constraints.norms();
  const Eigen::Index row = eigen_index(support.row);
  const double normal = l[row] / norms[row];
  double along = 0.0;
  for (int i = 1; i < support.rows; ++i) along = std::hypot(along, l[row + i] / norms[row + i]);
  return std::max(-normal, along - support.friction() * std::max(normal, 0.0));
}

VectorXd shared_within_cones(const RestingConstraints& constraints, const VectorXd& given) {
  // Forces that balance are a plane, those within all cones a convex set: projected on one and the other in
  // turn they come to a point of both, if there is one.
  constexpr int most_turns = 20000;
  const MatrixXd& rows = constraints.rows();
  const VectorXd& norms = constraints.norms();
  VectorXd l = given.cwiseQuotient(norms);
  const VectorXd right = rows.transpose() * given;
  const MatrixXd plain = norms.asDiagonal() * rows;
  Eigen::CompleteOrthogonalDecomposition<MatrixXd> factors;
  factors.setThreshold(std::sqrt(dependent_pivot));
  factors.compute(plain.transpose());
  double scale = l.lpNorm<Eigen::Infinity>();
  for (int turn = 0; turn < most_turns; ++turn) {
    for (const RestingConstraints::Support& support : constraints.supports()) {
      const Eigen::Index row = eigen_index(support.row);
      const double mu = support.friction();
      auto along = l.segment(row + 1, support.rows - 1);
      const double normal = l[row], tangential = along.norm();
      if (tangential <= mu * normal) continue;
      const double on_edge = (normal + mu * tangential) / (1.0 + mu * mu);
      l[row] = std::max(on_edge, 0.0);
      if (tangential > 0.0) along *= mu * l[row] / tangential;
    }
    const VectorXd change = factors.solve(VectorXd(plain.transpose() * l - right));
    l -= change;
    if (change.lpNorm<Eigen::Infinity>() <= 1e-12 * scale) break;
  }
  return l.cwiseProduct(norms);
}

}  // namespace carom
