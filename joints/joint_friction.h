#pragma once

/// \file
/// Dry friction in joints.

#include <carom/core/joint_kind.h>
#include <carom/core/part.h>

#include <string_view>

namespace carom {

/// Dry friction (Coulomb) along the coordinate of a joint, a set-valued law: at rest the friction force is
/// any value up to the bound that keeps the coordinate at rest; at a nonzero rate it is the bound, opposite
/// to the rate. The bound is  bound + coefficient |R|,  R the force between the bodies of the joint
/// (JointReaction::force). With a coefficient > 0 friction acts in impacts too, and R must be unique:
/// redundant joints are refused at the start of a run. The loss is EnergyFlow::joint_friction.
struct JointFriction {
  static constexpr Role role = Role::joint;
  /// Its type, for System::add().
  [[nodiscard]] CAROM_API static PartType<JointKind> part_type();

  JointId joint{};     ///< along whose coordinate (required)
  double bound = 0.0;  ///< constant part while sliding, >= 0 [N m, N]
  double coefficient =
      0.0;  ///< factor of the force in the joint, >= 0: for a pin its radius times mu [m], else mu
  double static_factor = 1.0;  ///< ratio of the bound of sticking to that of sliding, >= 1
};

namespace planar {
using carom::JointFriction;
}  // namespace planar
namespace spatial {
using carom::JointFriction;
}  // namespace spatial

}  // namespace carom
