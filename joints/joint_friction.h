#pragma once

/// \file
/// Dry friction in joints.

#include <carom/core/joint_kind.h>
#include <carom/joints/on_coordinate.h>

#include <string_view>

namespace carom {

class JointFrictionKind;

/// Dry friction (Coulomb) along the coordinate of a joint, a set-valued law: at rest the friction force is
/// any value up to the bound that keeps the coordinate at rest; at a nonzero rate it is the bound, opposite
/// to the rate. The bound is  bound + coefficient |R|,  R the force between the bodies of the joint
/// (JointReaction::force). With a coefficient > 0 friction acts in impacts too, and R must be unique:
/// redundant joints are refused at the start of a run. The loss is EnergyFlow::joint_friction.
struct JointFriction {
  static constexpr Role role = Role::joint;
  using Kind = JointFrictionKind;

  JointId joint{};     ///< along whose coordinate (required)
  double bound = 0.0;  ///< constant part while sliding, >= 0 [N m, N]
  double coefficient =
      0.0;  ///< factor of the force in the joint, >= 0: for a pin its radius times mu [m], else mu
  double static_factor = 1.0;  ///< ratio of the bound of sticking to that of sliding, >= 1
};

/// All friction in joints of a system.
class CAROM_API JointFrictionKind final : public OnCoordinate<JointFriction, JointFrictionKind, JointKind> {
public:
  static constexpr std::string_view part_label() { return "joint friction"; }

  /// Checks and stores a part. Throws ModelError.
  void add(const JointFriction& part, const PartCheck& check);

  [[nodiscard]] std::string_view label() const override { return part_label(); }
  [[nodiscard]] Index rows() const override { return 0; }
  void pattern(Index, JointRow*) const override {}
  void evaluate(const JointView&, Index, JointRow*) const override {}
  void derivatives(const JointView&, Index, JointRowDerivative*) const override {}
  [[nodiscard]] bool has_dry_friction() const override { return true; }
  [[nodiscard]] JointDryFriction dry_friction(Index joint) const override;
  /// Friction is given as the moment of the reaction: it acts along the coordinate.
  [[nodiscard]] JointReaction reaction(const JointView&, Index, const double* multipliers) const override;
  void fingerprint(Fingerprint& print) const override;
};

namespace planar {
using carom::JointFriction;
}  // namespace planar
namespace spatial {
using carom::JointFriction;
}  // namespace spatial

}  // namespace carom
