#pragma once

/// \file
/// The kind of dry friction in joints.

#include <carom/core/joint_kind.h>
#include <carom/joints/joint_friction.h>
#include <carom/joints/on_coordinate.h>

#include <string_view>

namespace carom {

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
  [[nodiscard]] Index friction_rows() const override { return 1; }
  [[nodiscard]] JointDryFriction dry_friction(Index joint) const override;
  /// Friction is given as the moment of the reaction: it acts along the coordinate.
  [[nodiscard]] JointReaction reaction(const JointView&, Index, const double* multipliers) const override;
  void fingerprint(Fingerprint& print) const override;
};

}  // namespace carom
