#pragma once

// Impacts of planar mechanisms by dense matrices, written down apart from the library.

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <vector>

namespace joint_scenes {

/// Rigid bodies, their constraint rows G and what impulses do to them,
///     v+ = v- + A H^T P,   A = M^-1 - M^-1 G^T (G M^-1 G^T)^-1 G M^-1.
class DenseMechanism {
public:
  using Rows = Eigen::MatrixXd;
  static constexpr int fixed = -1;  ///< the ground as a body

  explicit DenseMechanism(int bodies)
      : inverse_mass_(Eigen::VectorXd::Zero(3 * bodies)), constraints_(0, 3 * bodies) {}

  void body(int body, double mass, double inertia) {
    inverse_mass_.segment(3 * body, 3) << 1.0 / mass, 1.0 / mass, 1.0 / inertia;
  }
  /// The velocity (x, y) of the point of a body at a lever from its centre.
  [[nodiscard]] Rows point(int body, const Eigen::Vector2d& lever) const {
    Rows rows = Rows::Zero(2, inverse_mass_.size());
    if (body == fixed) return rows;
    rows.block(0, 3 * body, 2, 3) << 1.0, 0.0, -lever[1], 0.0, 1.0, lever[0];
    return rows;
  }
  void constrain(const Rows& rows) {
    Rows all(constraints_.rows() + rows.rows(), constraints_.cols());
    all << constraints_, rows;
    constraints_ = all;
  }
  void pin(int from, const Eigen::Vector2d& lever_from, int to, const Eigen::Vector2d& lever_to) {
    constrain(point(to, lever_to) - point(from, lever_from));
  }

  /// A.
  [[nodiscard]] Eigen::MatrixXd inverse_mass() const {
    const Eigen::MatrixXd inverse = inverse_mass_.asDiagonal();
    const Eigen::MatrixXd across = constraints_ * inverse;
    return inverse - across.transpose() * (across * constraints_.transpose()).ldlt().solve(across);
  }
  [[nodiscard]] const Rows& constraints() const { return constraints_; }

private:
  Eigen::VectorXd inverse_mass_;
  Rows constraints_;
};

/// An impact at one contact with velocities (normal, tangential): restitution e along the normal, none along
/// the tangent, friction mu. Tries the modes; `solutions` counts those that hold.
struct SingleImpact {
  Eigen::Vector2d impulse = Eigen::Vector2d::Zero();
  int solutions = 0;
  bool sticks = false;

  SingleImpact(const Eigen::Matrix2d& w, const Eigen::Vector2d& before, double e, double mu) {
    const Eigen::Vector2d aim(-(1.0 + e) * before[0], -before[1]);
    const Eigen::Vector2d stick = w.inverse() * aim;
    if (std::abs(stick[1]) <= mu * stick[0]) {
      impulse = stick;
      sticks = true;
      ++solutions;
    }
    for (const double s : {-1.0, 1.0}) {
      if (mu == 0.0 && s > 0.0) continue;
      const double normal = aim[0] / (w(0, 0) - s * mu * w(0, 1));
      const double after = before[1] + (w(0, 1) - s * mu * w(1, 1)) * normal;
      if (!(normal > 0.0) || (mu > 0.0 && s * after <= 0.0)) continue;
      impulse = Eigen::Vector2d(normal, -s * mu * normal);
      ++solutions;
    }
  }
};

}  // namespace joint_scenes
