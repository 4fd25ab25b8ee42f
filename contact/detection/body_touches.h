#pragma once

/// \file
/// Where bodies touch each other: pairs of convex outlines whose gap is closed. Two outlines touch where
/// their materials have a law of contact, unless both are points or a filter parts them
/// (contact/detection/pair_filter.h).

#include <carom/contact/detection/box.h>
#include <carom/contact/detection/broad_phase.h>
#include <carom/contact/detection/contact_query.h>
#include <carom/contact/detection/outlines.h>
#include <carom/contact/detection/pair_rows.h>
#include <carom/core/constraint_set.h>
#include <carom/core/export.h>

#include <span>
#include <utility>
#include <vector>

namespace carom {

/// Memory of a search for contacts of bodies: its answer does not depend on it.
struct BodyContactSearch {
  BroadPhase<2> broad;
  std::vector<Box<2>> boxes;                              ///< around all outlines
  std::vector<Vec<2>> placed;                             ///< vertices of all outlines
  std::vector<RowSide> sides;                             ///< bodies of all outlines
  std::vector<std::pair<Index, Index>> pairs;             ///< of outlines that may touch
  std::vector<Touch> touching;                            ///< contacts among `pairs`
  std::vector<ConstraintKey> lasting;                     ///< contacts of the step before
  std::vector<std::pair<Index, Index>> pairs_of_lasting;  ///< outlines of `lasting` that are of bodies
  SingleConstraint trial;                                 ///< of one that turning may have opened
  std::vector<Index> near;                                ///< outlines near a corner
};

/// An outline where its body is.
[[nodiscard]] inline ConvexOutline placed_outline(const BodyOutline& outline,
                                                  const BodyContactSearch& memory) {
  return {std::span(memory.placed).subspan(outline.vertices.begin, outline.vertices.size()), outline.radius};
}

/// Finds all places where bodies touch each other, ordered by the first outline, then the second one, in the
/// order of assembly. Valid as long as `memory` is left alone.
[[nodiscard]] CAROM_API std::span<const Touch> find_body_touches(const Outlines& outlines,
                                                                 const ContactQuery& query,
                                                                 BodyContactSearch& memory);

/// Writes the contact of one of those that find_body_touches() has found last, as Outlines::write() but
/// without its drift. \param out any constraint of a set; of the same contact only the numbers are written
/// anew
CAROM_API void write_rows(const Outlines& outlines, const Touch& touch, const BodyContactSearch& memory,
                          const StateView& state, Constraint& out);

/// The corners nearest to where two sharp outlines of bodies touch.
[[nodiscard]] CornerMeeting meeting_of_bodies(const Outlines& outlines, const Touch& touch,
                                              const ContactQuery& query, BodyContactSearch& memory);

}  // namespace carom
