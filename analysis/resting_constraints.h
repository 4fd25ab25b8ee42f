#pragma once

/// \file
/// Joints and closed contacts of a model at rest as rows of dense matrices, G(q) and g(q).

#include <carom/contact/detection/detector.h>
#include <carom/core/assembly.h>
#include <carom/core/evaluation.h>
#include <carom/core/joint_kind.h>
#include <carom/core/state.h>

#include <Eigen/Core>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace carom {

/// A place in an array, as Eigen counts.
[[nodiscard]] inline Eigen::Index eigen_index(Index i) { return static_cast<Eigen::Index>(i); }

/// Rows are joints first, then supports, each divided by its norm. Displacements are in lengths: coordinate i
/// of the velocities is multiplied by lengths[i].
class RestingConstraints {
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
    SingleConstraint at;
    Index row = 0;                 ///< the first
    int rows = 1;                  ///< how many
    std::array<double, 2> slid{};  ///< displacement of the place of touch along the tangents [m]
    [[nodiscard]] double friction() const { return rows > 1 ? at.law.sticking_friction() : 0.0; }
  };
  /// An open contact that bodies have entered.
  struct Entered {
    std::string name;
    double gap;  ///< < 0 [m]
  };

  /// Takes the contacts with gaps up to `contact_tolerance` as closed. The position group of `evaluation`
  /// must be up to date, here and below.
  RestingConstraints(const Assembly& assembly, const State& state, const Evaluation& evaluation,
                     double contact_tolerance);

  [[nodiscard]] const std::vector<Joint>& joints() const { return joints_; }        ///< all with rows
  [[nodiscard]] const std::vector<Support>& supports() const { return supports_; }  ///< closed contacts
  [[nodiscard]] const Eigen::MatrixXd& rows() const { return rows_; }               ///< G
  [[nodiscard]] const Eigen::VectorXd& gaps() const { return gaps_; }               ///< g
  [[nodiscard]] const Eigen::VectorXd& norms() const { return norms_; }  ///< by which rows are divided
  /// Name of a closed contact.
  [[nodiscard]] std::string name(const Support& support) const { return detector_.name(support.at.key); }
  /// Name of the joint or contact that a row belongs to.
  [[nodiscard]] std::string row_name(Eigen::Index row) const;

  /// Evaluates rows and gaps at a state.
  void update(const StateView& at, const Evaluation& evaluation, const Eigen::VectorXd& lengths);
  /// Displacements of all supports along their tangents.
  [[nodiscard]] std::vector<std::array<double, 2>> slid() const;
  /// Sets the displacements of all supports along their tangents.
  void set_slid(const std::vector<std::array<double, 2>>& slid);
  /// True if a support sticks.
  [[nodiscard]] bool sticks() const;
  /// Adds a part of a displacement of the bodies to those of the supports that stick.
  void slide(const StateView& at, const Evaluation& evaluation, double part, const Eigen::VectorXd& change);

  /// True if rows act on a body.
  [[nodiscard]] bool acts_on(Index body) const {
    return !joints_of_body_[body].empty() || !supports_of_body_[body].empty();
  }
  /// Adds the forces of all rows that act on a body, by the multipliers of rows that are not divided.
  void add_forces(Index body, const JointView& at, const Evaluation& evaluation,
                  const Eigen::VectorXd& multipliers, double* forces) const;
  /// First open contact that is entered by more than `tolerance`.
  [[nodiscard]] std::optional<Entered> find_entered(const StateView& at, const Evaluation& evaluation,
                                                    double tolerance) const;

private:
  void list_joints();
  void find_supports(const StateView& at, const Evaluation& evaluation, double tolerance);
  void list_bodies();

  const Assembly* assembly_;
  Detector detector_;
  GroundPlaces places_;
  std::vector<Joint> joints_;
  std::vector<Support> supports_;
  std::vector<std::vector<std::size_t>> joints_of_body_, supports_of_body_;
  std::vector<JointRow> joint_rows_;
  Eigen::MatrixXd rows_;
  Eigen::VectorXd norms_, gaps_;
};

}  // namespace carom
