#pragma once

/// \file
/// Bounds of dry friction in joints: a constant, and the force between the bodies of the joint, which follows
/// from the multipliers of its rows.

#include <carom/core/assembly.h>
#include <carom/core/constraint.h>
#include <carom/core/dynamics/joint_constraints.h>
#include <carom/core/export.h>
#include <carom/core/joint_kind.h>

#include <vector>

namespace carom {

/// Friction in the joints of one component, or of several, that is bound by forces of joints.
class CAROM_API FrictionBounds {
public:
  /// Of no component: empty.
  FrictionBounds() = default;
  /// All but `joints` must outlive it.
  FrictionBounds(const Assembly& assembly, Index component, const JointConstraints& joints) {
    add(assembly, component, joints);
  }
  /// Adds a component, whose rows are behind those of the components before.
  void add(const Assembly& assembly, Index component, const JointConstraints& joints);

  /// True if no friction is bound by the force of a joint.
  [[nodiscard]] bool empty() const { return bearings_.empty(); }
  /// True if that of a contact is.
  [[nodiscard]] bool depends_on_joint_force(const Constraint& contact) const {
    return find(contact) != nullptr;
  }
  /// The rows, among those of the component, whose multipliers bound that of a contact; empty if none do.
  [[nodiscard]] Range rows(const Constraint& contact) const;
  /// Takes note of the multipliers of all rows of the component's joints: forces, or impulses over a duration
  /// [s] (0: of an impact; 1 for forces). They must outlive the calls of update().
  /// \param size of loads whose rounding is in the multipliers, as these
  void take(const double* multipliers, double duration, double size = 0.0);
  /// Sets `friction_bound` of friction in a joint. Returns the change against the number itself, or against
  /// that of the largest force in the component where it is small; does nothing and returns 0 for what is
  /// bound by a constant only.
  double update(Constraint& contact, const JointView& at) const;

private:
  struct Bearing {
    Index serial;            // of the friction
    const JointKind* joint;  // that presses
    Index slot;
    std::size_t row;  // its first among those of all components
    double bound, coefficient;
  };
  [[nodiscard]] const Bearing* find(const Constraint& contact) const;
  std::vector<Bearing> bearings_;  // by serial number
  std::size_t rows_ = 0;           // of all components
  const double* multipliers_ = nullptr;
  double duration_ = 1.0, largest_ = 0.0;  // of multipliers_
};

}  // namespace carom
