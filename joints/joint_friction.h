#pragma once

/// \file
/// Dry friction in joints.

#include <carom/core/joint_kind.h>
#include <carom/joints/on_coordinate.h>

#include <string_view>

namespace carom {

class JointFrictionKind;

/// Dry friction along the coordinate of a joint, set-valued: it holds the coordinate where it is as long as
/// that takes no more than the bound, and rubs with the bound against a rate that is not zero. With the force
/// R between the bodies of the joint (JointReaction::force) the bound is  bound + coefficient |R|. Where
/// friction is bound by |R| it acts in impacts too, and R must be unique: redundant joints are refused at the
/// start of a run. What it takes out of the energy is EnergyFlow::joint_friction.
struct JointFriction {
  static constexpr Role role = Role::joint;
  using Kind = JointFrictionKind;

  JointId joint{};     ///< along whose coordinate (required)
  double bound = 0.0;  ///< constant part while it slips, >= 0 [N m, N]
  double coefficient =
      0.0;  ///< part by the force in the joint, >= 0: of a pin its radius times mu [m], else mu
  double static_factor = 1.0;  ///< sticking takes this many times more, >= 1
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
  [[nodiscard]] bool rubs() const override { return true; }
  [[nodiscard]] JointRub rub(Index joint) const override;
  /// Friction is told by its moment: it acts along the coordinate.
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
