#pragma once

/// \file
/// Options of time stepping for bodies that stand in each other, or in shapes on ground.

#include <optional>

namespace carom {

/// At the start of a run, and within its steps. Without any of it, what overlaps at the start is in contact,
/// goes no deeper and is not moved apart, and what is fast enough passes through what is thin.
struct OverlapRules {
  /// At the start, after set_state() and after an edit: a body that stands deeper than this in another one or
  /// in a shape on ground is refused with a ModelError that names the pair and the depth; >= 0 [m]. Of no
  /// effect where separate_at_start is set.
  std::optional<double> largest_at_start{};
  /// Move bodies that overlap then apart, and out of the ground, by the smallest displacement in the
  /// mass norm, along their joints: no gap is left below rounding. StepReport::projected has its size.
  bool separate_at_start = false;
  /// Let nothing pass through anything in the plane, however fast: a step in which a body would come deeper
  /// into another one, or into a shape on ground, than an eighth of the radii of the largest circles in both
  /// ends there, and the rest of it is another step, which begins with their impact (docs/method.md, section
  /// 6). What closes faster than `capture_speed` is then resolved at the start of steps, as sequential
  /// impacts are; a contact that closes more slowly does not rebound. Half-planes cannot be passed in any
  /// case. Excludes `control`, and impacts that are located.
  bool never_tunnel = false;
};

}  // namespace carom
