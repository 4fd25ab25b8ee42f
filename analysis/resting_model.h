#pragma once

/// \file
/// A whole model at rest as equations with dense matrices, f(q) + G(q)^T l = 0, g(q) = 0, and their
/// derivatives. Used for equilibria and modes.

#include <carom/contact/detection/detector.h>
#include <carom/core/assembly.h>
#include <carom/core/evaluation.h>
#include <carom/core/joint_kind.h>
#include <carom/core/numerics/sparse_factors.h>
#include <carom/core/state.h>

#include <Eigen/Core>
#include <Eigen/QR>

#include <array>
#include <string>
#include <vector>

namespace carom {

/// Rows are joints first, then supports. Displacements x and forces are in lengths: coordinate i of the
/// velocities is multiplied, its force divided, by lengths()[i]. Rows are divided by their norms.
class RestingModel {
public:
  /// A joint and its rows.
  struct Joint {
    Index kind, slot;
    Index row;  ///< the first
    JointId id;
  };
  /// A closed contact and its rows: the normal, and the tangents if it sticks.
  struct Support {
    ContactPair pair;
    Constraint at;
    Index row = 0;                 ///< the first
    int rows = 1;                  ///< how many
    std::array<double, 2> slid{};  ///< how far the place of touch has moved along the tangents [m]
    [[nodiscard]] double friction() const { return rows > 1 ? at.law.sticking_friction() : 0.0; }
  };

  /// Takes the contacts with gaps up to `contact_tolerance` as closed. Throws ModelError for a state or
  /// elements that cannot be. \param purpose begins messages, e.g. "equilibrium"
  RestingModel(const Assembly& assembly, const State& start, double contact_tolerance, std::string purpose);

  [[nodiscard]] const State& state() const { return state_; }                       ///< where it stands
  [[nodiscard]] const std::vector<Joint>& joints() const { return joints_; }        ///< all with rows
  [[nodiscard]] const std::vector<Support>& supports() const { return supports_; }  ///< closed contacts
  [[nodiscard]] const Eigen::VectorXd& lengths() const { return lengths_; }         ///< by velocity
  /// Name of a closed contact.
  [[nodiscard]] std::string name(const Support& support) const { return detector_.name(support.at.key); }
  /// Name of the body that a velocity belongs to.
  [[nodiscard]] std::string body_name(Eigen::Index velocity) const;
  /// Name of what a row belongs to.
  [[nodiscard]] std::string row_name(Eigen::Index row) const;

  /// Where bodies stand and what tangents slid: to come back to.
  struct Place {
    std::vector<double> q;
    std::vector<std::array<double, 2>> slid;
  };
  [[nodiscard]] Place place() const;
  /// Moves from a place by a displacement x, and knows then what the tangents slid.
  void move(const Place& from, const Eigen::VectorXd& x);
  /// Multipliers that come nearest to balance, the smallest of them.
  void balance();

  [[nodiscard]] const Eigen::VectorXd& loads() const { return loads_; }                   ///< f
  [[nodiscard]] const Eigen::MatrixXd& rows() const { return rows_; }                     ///< G
  [[nodiscard]] const Eigen::VectorXd& gaps() const { return gaps_; }                     ///< g
  [[nodiscard]] const Eigen::VectorXd& multipliers() const { return l_; }                 ///< l, of balance()
  [[nodiscard]] Eigen::VectorXd left() const { return loads_ + rows_.transpose() * l_; }  ///< f + G^T l
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
  /// determined so that they do. Throws SolverError. \param allowed what forces may be outside [N]
  void check_supports(double allowed);
  /// Demands that no open contact is penetrated. Throws SolverError.
  void check_open_contacts(double tolerance) const;

  /// Multiplier of a row as the joint or contact means it.
  [[nodiscard]] double multiplier(Eigen::Index row) const { return l_[row] / norms_[row]; }
  /// Gap of a row as the joint or contact means it.
  [[nodiscard]] double gap(Eigen::Index row) const { return gaps_[row] * norms_[row]; }
  /// Forces of a joint.
  [[nodiscard]] JointReaction reaction(const Joint& joint) const;

private:
  void locate();
  void refuse_internals() const;
  void find_supports(double tolerance);
  /// The normal force of a support, and what its friction is beyond its cone.
  [[nodiscard]] double outside(const Support& support, const Eigen::VectorXd& l) const;
  void share();

  const Assembly* assembly_;
  std::string purpose_;
  Detector detector_;
  ObstaclePlaces places_;
  State state_;
  Evaluation evaluation_;
  Eigen::VectorXd lengths_;
  std::vector<Joint> joints_;
  std::vector<Support> supports_;
  std::vector<std::vector<std::size_t>> joints_of_body_, supports_of_body_;
  std::vector<JointRow> joint_rows_;
  Eigen::MatrixXd rows_;
  Eigen::VectorXd norms_, gaps_, loads_, l_;
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> factors_;
};

}  // namespace carom
