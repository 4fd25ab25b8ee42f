#pragma once

/// \file
/// Faces of shapes that go on into each other, on ground at rest or on one body: a floor of several pieces.
///
/// The problem: where the tops of two blocks lie in one plane, the side of either is covered by the other. To
/// be hit by a corner that slides over the seam it is no side at all, although the corner stands before it to
/// rounding, and although the second top is a little higher by rounding. So where faces of two pieces end in
/// one place they are joined as two faces of a polyline are (GroundPiece::Form::face), and what other pieces
/// cover of sides is left out.

#include <carom/core/contact_filter.h>
#include <carom/core/export.h>
#include <carom/core/ground_shape_kind.h>
#include <carom/core/ids.h>
#include <carom/core/space.h>

#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace carom {

/// The boundary of a half-plane.
struct GroundLine {
  Vec<2> origin = Vec<2>::Zero();  ///< a place on it [m]
  Vec<2> along = Vec<2>::Zero();   ///< unit vector, free space on its right
};

/// A shape on ground at rest, or one of several that move together.
struct RestingShape {
  ContactFilter filter{};               ///< shapes that touch not the same bodies do not cover each other
  std::vector<GroundPiece> pieces{};    ///< where they stand
  std::optional<GroundLine> line = {};  ///< given of a half-plane, which has no pieces
  bool is_one_solid = false;            ///< its faces were made of one convex solid
};

/// Faces end in one place, or in one line, to this part of the length of the shorter one.
inline constexpr double flush_part = 1e-9;

/// Makes faces of the sharp pieces that have a corner in which a face goes on into one of another piece, in
/// one line or turning to the free side: without what others cover, and with the other's face for a
/// neighbour. Ends of faces that meet are moved into one place, by rounding (flush_part). All other pieces
/// stay as they are.
CAROM_API void join_flush_faces(std::span<RestingShape> shapes);

/// Makes faces of shapes that have to stay convex, one sharp solid each, because they touch others that move:
/// corners from which a face goes on in one of a neighbour are changed by little, so that nothing that slides
/// over them meets the side that the neighbour covers (DrawnOutline, drawn_outline.h). Other shapes stay as
/// they are. \param may_cover says of two shapes whether the first may cover the second one
CAROM_API void draw_covered_corners(std::span<RestingShape> shapes,
                                    const std::function<bool(Index, Index)>& may_cover);

}  // namespace carom
