#pragma once

/// \file
/// Which sides of shapes on ground others cover at one time, where one of them moves (covered_side.h). Of
/// shapes at rest join_flush_faces() finds that once.

#include <carom/contact/detection/corner_meeting.h>
#include <carom/contact/detection/ground_pieces.h>
#include <carom/contact/detection/ground_shapes.h>
#include <carom/core/contact_filter.h>
#include <carom/core/export.h>
#include <carom/core/ids.h>
#include <carom/core/space.h>

#include <vector>

namespace carom {

/// The sharp solids on ground. It keeps no reference to what it is made of.
class CAROM_API CoveringGround {
public:
  /// Of no ground.
  CoveringGround() = default;
  /// \param pieces of the shapes
  CoveringGround(const GroundShapes& shapes, const GroundPieces& pieces);

  /// The side of a corner of one shape that others cover, of those which a body may touch. \param corner in
  /// space \param shape whose corner it is \param filter of the body \param places of all shapes
  /// \param pieces,shapes those that this was made of
  [[nodiscard]] HiddenSide side(const SharpCorner& corner, Index shape, const ContactFilter& filter,
                                const GroundPlaces& places, const GroundShapes& shapes,
                                const GroundPieces& pieces) const;

private:
  std::vector<Index> all_, moving_;  // outlines
};

}  // namespace carom
