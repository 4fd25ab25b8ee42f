#pragma once

/// \file
/// Narrow phase: where two outlines touch. One table of closed forms, which bodies and ground use alike.
///
/// The table has an entry for each pair of forms (OutlineForm): two functions, of which the one finds the
/// contacts of two outlines, and the other follows the contact of two given features. Each entry is a file of
/// its own, which states its equation: gap_discs.h, gap_convex.h, gap_inside_circle.h, gap_face.h,
/// gap_chain.h.
///
/// To add a closed form, write such a file (gap_discs.h is the shortest), and its line in narrow_phase.cpp:
/// that is all. The line may replace that of a more general entry, as of a disc and a polygon. Where outlines
/// of a new form are to be told apart, OutlineForm gets a name for it, and PlacedOutline what they are made
/// of. tests/contact/detection/narrow_phase_test.cpp looks at every pair of forms.
///
/// Shapes on ground without pieces have no outline: a half-plane or a half-space (gap_point_half_space.h),
/// and shapes of users, tell the distance of a point themselves (GroundShapeKind::gap).

#include <carom/contact/detection/convex_outline.h>
#include <carom/contact/detection/gap_point.h>
#include <carom/contact/detection/placed_outline.h>
#include <carom/core/export.h>

#include <array>
#include <cstddef>
#include <limits>

namespace carom {

/// Entry of the narrow phase: how gaps of outlines of two forms are found.
struct NarrowPhase {
  /// Finds the contacts of two outlines with gap <= `margin` [m], the one with the least gap first; it is the
  /// distance between the sets, or minus a way that separates them. \returns how many
  int (*find)(const PlacedOutline& a, const PlacedOutline& b, double margin,
              std::array<GapPoint, 2>& out) = nullptr;
  /// The gap of two given features, whether or not they are the ones that meet: a smooth function of where
  /// the outlines are. Of a contact that has just been found it is the same to the bit.
  GapPoint (*follow)(const PlacedOutline& a, Index feature_a, const PlacedOutline& b,
                     Index feature_b) = nullptr;
};

/// Entries by the forms of a and b. None of two forms on ground, and of a chain but with discs.
using NarrowPhaseTable = std::array<std::array<NarrowPhase, outline_forms>, outline_forms>;

/// All entries.
CAROM_API extern const NarrowPhaseTable narrow_phase_table;

/// Entry of two forms.
[[nodiscard]] inline const NarrowPhase& narrow_phase(OutlineForm a, OutlineForm b) {
  return narrow_phase_table[static_cast<std::size_t>(a)][static_cast<std::size_t>(b)];
}

/// Finds the contacts of two outlines, as NarrowPhase::find.
[[nodiscard]] inline int find_gaps(const PlacedOutline& a, const PlacedOutline& b, double margin,
                                   std::array<GapPoint, 2>& out) {
  return narrow_phase(a.form, b.form).find(a, b, margin, out);
}
/// Finds the contacts of two discs or polygons, as NarrowPhase::find.
[[nodiscard]] inline int find_gaps(const ConvexOutline& a, const ConvexOutline& b, double margin,
                                   std::array<GapPoint, 2>& out) {
  return find_gaps(PlacedOutline(a), PlacedOutline(b), margin, out);
}
/// The gap of two given features of two outlines, as NarrowPhase::follow.
[[nodiscard]] inline GapPoint follow_gap(const PlacedOutline& a, Index feature_a, const PlacedOutline& b,
                                         Index feature_b) {
  return narrow_phase(a.form, b.form).follow(a, feature_a, b, feature_b);
}
/// The least gap of two outlines, however far they are from each other. Where places are no numbers, that of
/// their first features, which is no number either.
[[nodiscard]] inline GapPoint nearest_gap(const PlacedOutline& a, const PlacedOutline& b) {
  std::array<GapPoint, 2> found;
  const bool is_found = find_gaps(a, b, std::numeric_limits<double>::infinity(), found) > 0;
  return is_found ? found[0] : follow_gap(a, 0, b, 0);
}

}  // namespace carom
