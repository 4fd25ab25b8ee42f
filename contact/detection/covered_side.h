#pragma once

/// \file
/// Sides of shapes that others cover where they stand at one time: of bodies that lie side by side, and of
/// ground that moves. Where the tops of two lie in one plane and their sides on each other, the corner
/// between is none: what slides over it does not meet the side of either. Of shapes that always lie so
/// flush_faces.h finds that once.

#include <carom/contact/detection/convex_outline.h>
#include <carom/contact/detection/corner_meeting.h>
#include <carom/contact/detection/feature_region.h>
#include <carom/core/export.h>

namespace carom {

/// The side of a corner that a neighbour covers: the corner is on the neighbour's boundary, the other edge of
/// the corner goes on there in a face of the neighbour, in one line, and below that the side is in the
/// neighbour. None of a neighbour that has no inside, or is rounded. \param lengths to which this holds
[[nodiscard]] CAROM_API HiddenSide side_covered_by(const ConvexOutline& neighbour, const SharpCorner& corner,
                                                   const FeatureLengths& lengths);

}  // namespace carom
