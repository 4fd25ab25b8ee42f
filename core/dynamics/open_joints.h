#pragma once

/// \file
/// Joints that a description leaves open: close_joints() moves bodies to close them, which is probably not
/// what was meant where they move far.

#include <carom/core/dynamics/joint_closure.h>
#include <carom/core/export.h>
#include <carom/core/joint_kind.h>
#include <carom/core/model_finding.h>
#include <carom/core/state.h>

#include <optional>
#include <span>
#include <vector>

namespace carom {

class Assembly;
class JointConstraints;
class System;

/// Appends the joints of a component that a state leaves open by more than a thousandth: of a radian, or of
/// the largest coordinate or radius of gyration of its bodies. None where a drawing has three digits.
/// A joint between points is far open where that is more than a tenth of the size of its bodies: of their
/// radii of gyration, the levers of its ends, or the length of a rod. \param joints of the component, brought
/// to the state \param at the state with the rotations of its bodies \param lengths Assembly::length_scales()
CAROM_API void list_open_joints(const Assembly& assembly, Index component, const JointConstraints& joints,
                                const State& state, const JointView& at, const std::vector<double>& lengths,
                                std::vector<OpenJoint>& out);
/// Throws ModelError if a joint is far open, unless System::close_joints() was called. The error names the
/// joint, its gap, and the point where an end would close it.
CAROM_API void demand_roughly_closed(const System& system, std::span<const OpenJoint> open);
/// The finding about such joints; none if there are none.
[[nodiscard]] CAROM_API std::optional<ModelFinding> finding_of(const System& system,
                                                               std::span<const OpenJoint> open);

}  // namespace carom
