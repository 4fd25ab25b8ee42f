#pragma once

/// \file
/// The contact of a pair of a vertex and an outline, of two bodies or of a body and a shape on ground: its
/// gap, its rows, its name.

#include <carom/contact/detection/ground_pieces.h>
#include <carom/contact/detection/outline_pair.h>
#include <carom/contact/detection/pair_rows.h>
#include <carom/core/constraint.h>
#include <carom/core/export.h>
#include <carom/core/ids.h>
#include <carom/core/state.h>
#include <carom/core/surface.h>

namespace carom {

/// The two sides of a pair where they are. A view.
struct PairSides {
  OutlinePair at;
  PairSide of_vertex, of_outline;
  FeatureKey vertex, surface;            ///< names of the vertex, and of the outline as a whole
  const Surface* law = nullptr;          ///< between the two sides
  bool vertex_is_first = true;           ///< the normal of the contact points to the side of the vertex
  const GroundPieces* pieces = nullptr;  ///< of which the outline is a chain; null: it is none
  Index chain = none;                    ///< number of the chain among `pieces`
};

/// The gap of a pair at one feature of its outline (FeatureRegions), or at the nearest one (`none`), in
/// space. Its a is the side of the vertex.
[[nodiscard]] CAROM_API GapPoint gap_of(const PairSides& sides, Index feature);

/// Writes the contact of a pair, whatever its gap. \param out any constraint
CAROM_API void write_contact(const PairSides& sides, const StateView& state, Constraint& out);

/// Brings rows, gap and drift of the contact of a pair to where its sides are, as long as its vertex stays
/// with one feature of the outline, whichever is the nearest: a smooth function of the motion, also a little
/// beyond the border where another feature takes over. Key and law stay.
CAROM_API void follow(const PairSides& sides, Index feature, Constraint& contact);

}  // namespace carom
