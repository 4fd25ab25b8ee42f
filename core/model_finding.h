#pragma once

/// \file
/// Findings of a check of a model: descriptions that are possible, but probably mistakes.

#include <carom/core/export.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace carom {

/// Kinds of findings. Bodies touch obstacles (shapes on ground), and each other where their materials have a
/// law of contact.
enum class FindingKind : std::uint8_t {
  law_without_effect,   ///< System::between() two materials that never meet
  contact_without_law,  ///< a part that touches and an obstacle without a law; a Simulation refuses it
  touches_nothing,      ///< shapes, or particles with a material, without obstacles or a law between bodies
  untouched_obstacle,   ///< obstacles in a system in which nothing can touch an obstacle
  body_without_shape,   ///< rigid bodies on which only fields act, without a shape, beside obstacles
  keep_without_joint,   ///< System::keep_place() of bodies that no joint binds
  hidden_by_filter,     ///< parts that could touch each other, but for their filters
  open_joint            ///< joints that a Simulation has to move bodies for, to close them
};
/// Number of kinds.
inline constexpr std::size_t finding_kind_count = 8;

/// Name of a kind: "law without effect", ...
[[nodiscard]] CAROM_API std::string_view to_string(FindingKind kind);

/// One finding of System::check(), or of a Simulation.
struct ModelFinding {
  FindingKind kind = FindingKind::law_without_effect;  ///< what is probably wrong
  std::vector<std::string> parts;                      ///< names of the parts (of a law: its materials)
  std::string text;                                    ///< the finding in words, with the reason
};

}  // namespace carom
