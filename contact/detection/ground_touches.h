#pragma once

/// \file
/// Where bodies touch pieces of shapes on ground: pairs of a body's outline and an outline on ground whose
/// gap is closed.

#include <carom/contact/detection/box.h>
#include <carom/contact/detection/box_grid.h>
#include <carom/contact/detection/contact_pair.h>
#include <carom/contact/detection/contact_query.h>
#include <carom/contact/detection/corner_meeting.h>
#include <carom/contact/detection/gap_point.h>
#include <carom/contact/detection/outlines.h>
#include <carom/core/constraint_set.h>
#include <carom/core/export.h>
#include <carom/core/function_ref.h>

#include <optional>
#include <vector>

namespace carom {

/// Pieces on ground by place, and the outlines of each body. Members take the outlines that it was made of.
class CAROM_API GroundTouches {
public:
  explicit GroundTouches(const Outlines& outlines);

  /// Appends the contacts of one body with pieces that a query asks for, outline by outline.
  void find(const Outlines& outlines, Index body, const ContactQuery& query, ConstraintSet& out) const;
  /// Appends all pairs of some bodies and the ground that may touch, ordered by body, then outline.
  void append_pairs(const Outlines& outlines, Range bodies, std::vector<ContactPair>& out) const;
  /// Lists the pieces that overlap a box, and those that have no bounds, ascending. \param box_in the box in
  /// the frame of a shape that moves; asked with `none` of what is at rest
  void list_near(FunctionRef<Box<2>(Index shape)> box_in, std::vector<Index>& out) const;

private:
  /// Pieces at rest, or those of one shape that moves, in its frame.
  struct Family {
    Index shape = none;  ///< none: at rest
    double reach = 0.0;  ///< radius of a circle around its point o that holds the bounded pieces [m]
    BoxGrid<2> grid;     ///< of bounded pieces
    std::vector<Index> unbounded;
  };
  /// One body's outline before one family.
  struct Search;

  static void find_in(const Family& family, Search& search, ConstraintSet& out);
  static void find_piece(Index piece, const Search& search, ConstraintSet& out);
  [[nodiscard]] static std::optional<CornerMeeting> meeting_near(const Search& search, Index on_ground,
                                                                 const GapPoint& contact);
  static bool add(const Search& search, Index on_ground, const GapPoint& local, double most, bool of_corners,
                  ConstraintSet& out);

  std::vector<Index> begin_;  // of each body: its first outline
  std::vector<Family> families_;
};

/// Appends the pairs of an outline of a body and one on ground, if they may touch: each vertex of the body
/// against the outline on ground; and, where the body has edges or is a point, each corner of the ground
/// against the outline of the body. \param outline,on_ground their numbers among those of bodies, and among
/// those on ground
CAROM_API void append_pairs(const Outlines& outlines, Index outline, Index on_ground,
                            std::vector<ContactPair>& out);

}  // namespace carom
