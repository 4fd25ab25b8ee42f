#pragma once

/// \file
/// A whole model at rest as equations with dense matrices, f(q) + G(q)^T l = 0, g(q) = 0, and their
/// derivatives. Used for equilibria and modes.

#include <carom/analysis/resting_constraints.h>
#include <carom/core/assembly.h>
#include <carom/core/evaluation.h>
#include <carom/core/joint_kind.h>
#include <carom/core/state.h>

#include <Eigen/Core>
#include <Eigen/QR>

#include <array>
#include <string>
#include <vector>

namespace carom {

/// Displacements x and forces are in lengths: coordinate i of the velocities is multiplied, its force
/// divided, by lengths()[i].
class RestingModel {
public:
  /// Takes the contacts with gaps up to `contact_tolerance` as closed. Throws ModelError for a state or
  /// elements that cannot be. \param purpose begins messages, e.g. "equilibrium"
  RestingModel(const Assembly& assembly, const State& start, double contact_tolerance, std::string purpose);

  [[nodiscard]] const State& state() const { return state_; }                           ///< where it stands
  [[nodiscard]] const RestingConstraints& constraints() const { return constraints_; }  ///< G, g
  [[nodiscard]] const Eigen::VectorXd& lengths() const { return lengths_; }             ///< by velocity
  /// Name of the body that a velocity belongs to.
  [[nodiscard]] std::string body_name(Eigen::Index velocity) const;

  /// Positions of the bodies and displacements of supports: to come back to.
  struct Place {
    std::vector<double> q;
    std::vector<std::array<double, 2>> slid;
  };
  [[nodiscard]] Place place() const { return {state_.q, constraints_.slid()}; }
  /// Moves from a place by a displacement x, supports that stick along their tangents.
  void move(const Place& from, const Eigen::VectorXd& x);
  /// Multipliers that come nearest to balance, the smallest of them.
  void balance();

  [[nodiscard]] const Eigen::VectorXd& loads() const { return loads_; }    ///< f
  [[nodiscard]] const Eigen::VectorXd& multipliers() const { return l_; }  ///< l, of balance()
  /// f + G^T l.
  [[nodiscard]] Eigen::VectorXd left() const { return loads_ + constraints_.rows().transpose() * l_; }
  /// Smallest x with G x = right.
  [[nodiscard]] Eigen::VectorXd close(const Eigen::VectorXd& right) const { return factors_.solve(right); }
  /// Orthonormal directions that the rows leave, columns.
  [[nodiscard]] Eigen::MatrixXd directions() const;
  /// Largest coordinate, at least 1 [m].
  [[nodiscard]] double size() const;

  /// d(f + G^T l)/dx and df/dv at the multipliers of balance().
  void differentiate(Eigen::MatrixXd& by_position, Eigen::MatrixXd& by_velocity) const;
  /// Masses, in lengths.
  [[nodiscard]] Eigen::MatrixXd mass() const;

  /// Demands that supports press and are within their cones of friction; shares forces that are not
  /// determined so that they do. Throws SolverError. \param allowed excess of forces [N]
  void check_supports(double allowed);
  /// Demands that no open contact is penetrated. Throws SolverError.
  void check_open_contacts(double tolerance) const;
  /// Throws a SolverError. \param residual of it \param parts that it names
  [[noreturn]] void fail(const std::string& what, double residual, std::vector<std::string> parts) const;

  /// Multiplier of a row as the joint or contact means it.
  [[nodiscard]] double multiplier(Eigen::Index row) const { return l_[row] / constraints_.norms()[row]; }
  /// Gap of a row as the joint or contact means it.
  [[nodiscard]] double gap(Eigen::Index row) const {
    return constraints_.gaps()[row] * constraints_.norms()[row];
  }
  /// Forces of a joint.
  [[nodiscard]] JointReaction reaction(const RestingConstraints::Joint& joint) const;

private:
  void update();
  void add_load_derivatives(Eigen::MatrixXd& by_position, Eigen::MatrixXd& by_velocity) const;
  void add_constraint_derivatives(Eigen::MatrixXd& by_position) const;

  const Assembly* assembly_;
  std::string purpose_;
  State state_;
  Evaluation evaluation_;
  Eigen::VectorXd lengths_;
  RestingConstraints constraints_;
  Eigen::VectorXd loads_, l_;
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> factors_;
};

}  // namespace carom
