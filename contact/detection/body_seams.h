#pragma once

/// \file
/// Seams between outlines of bodies that do not move against each other: of one body, or of bodies that a
/// joint binds without freedom. What slides over such a seam does not meet the side that the neighbour covers
/// (draw_covered_corners(), flush_faces.h).

#include <carom/contact/detection/body_outlines.h>
#include <carom/core/assembly.h>
#include <carom/core/ids.h>
#include <carom/core/space.h>

#include <vector>

namespace carom {

/// An outline of a body as its shape describes it.
struct DescribedOutline {
  BodyOutline outline;             ///< all but its place among others
  std::vector<Vec<2>> vertices{};  ///< in the frame of the body, from the centre of mass [m]
};

/// Adds corners to sharp polygons where neighbours cover their sides. Bodies that a joint binds are taken
/// where they stand at the start, and only if they cannot touch each other.
void draw_seams(const Assembly& assembly, std::vector<DescribedOutline>& outlines);

}  // namespace carom
