#pragma once

/// \file
/// Joints that a description leaves open: a run moves bodies to close them, which is probably not what was
/// meant where they move far.

#include <carom/core/export.h>
#include <carom/core/model_finding.h>
#include <carom/core/state.h>

#include <optional>

namespace carom {

class Assembly;

/// The joints and drivers that a state leaves open by more than a thousandth: of a radian, or of the largest
/// coordinate or radius of gyration of the bodies that joints bind to theirs. None where a drawing has three
/// digits. \param state before close_joints()
[[nodiscard]] CAROM_API std::optional<ModelFinding> find_open_joints(const Assembly& assembly,
                                                                     const State& state);

}  // namespace carom
