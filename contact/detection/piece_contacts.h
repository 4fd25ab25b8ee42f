#pragma once

/// \file
/// Contacts of bodies with the pieces of shapes on ground: pairs of a body's outline and an outline on ground
/// whose gap is closed.

#include <carom/contact/detection/body_outlines.h>
#include <carom/contact/detection/box_grid.h>
#include <carom/contact/detection/contact_pair.h>
#include <carom/contact/detection/contact_query.h>
#include <carom/contact/detection/corner_meeting.h>
#include <carom/contact/detection/covering_ground.h>
#include <carom/contact/detection/feature_region.h>
#include <carom/contact/detection/gap_point.h>
#include <carom/contact/detection/ground_pieces.h>
#include <carom/contact/detection/ground_shapes.h>
#include <carom/contact/detection/outline_pair.h>
#include <carom/contact/detection/pair_sides.h>
#include <carom/core/assembly.h>
#include <carom/core/constraint_set.h>
#include <carom/core/export.h>
#include <carom/core/surface.h>

#include <optional>
#include <span>
#include <vector>

namespace carom {

/// Outlines of the bodies of an assembly, pieces of shapes on ground, and the laws between them.
class CAROM_API PieceContacts {
public:
  /// Throws ModelError where a body's polygon is not convex. Laws must be known to be there (GroundLaws).
  /// \param assembly outlives it \param lengths to which features are told apart
  explicit PieceContacts(const Assembly& assembly, const FeatureLengths& lengths = {});

  /// True if there are no pieces, or nothing that may touch them.
  [[nodiscard]] bool empty() const { return outlines_.empty(); }
  /// All shapes on ground.
  [[nodiscard]] const GroundShapes& shapes() const { return shapes_; }
  /// Outlines of bodies.
  [[nodiscard]] const BodyOutlines& outlines() const { return outlines_; }
  /// Pieces and outlines on ground.
  [[nodiscard]] const GroundPieces& pieces() const { return pieces_; }

  /// Appends the contacts of one component that a query asks for, ordered by body.
  void find(Index component, const ContactQuery& query, ConstraintSet& out) const;
  /// Appends the contacts of one body that a query asks for.
  void find_of(Index body, const ContactQuery& query, ConstraintSet& out) const;
  /// Appends all pairs of one component that may touch, ordered by body.
  void append_pairs(Index component, std::vector<ContactPair>& out) const;
  /// The vertex and the outline that the key of a contact of these names; of other keys nothing.
  [[nodiscard]] std::optional<ContactPair> pair_of(const ConstraintKey& key) const;

  /// Law of a pair.
  [[nodiscard]] const Surface& law(const ContactPair& pair) const;
  /// The two sides of a pair. \param places of all shapes
  [[nodiscard]] PairSides sides(const ContactPair& pair, const StateView& state, const Evaluation& evaluation,
                                const GroundPlaces& places) const;
  /// The vertex and the outline of a pair.
  [[nodiscard]] OutlinePair outline_pair(const ContactPair& pair, const StateView& state,
                                         const Evaluation& evaluation, const GroundPlaces& places) const;

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
  /// Outline of a body, and number of one on ground.
  struct Sides {
    const BodyOutline& body;
    Index on_ground;
  };

  void find_laws();
  void fill_families();
  [[nodiscard]] bool may_touch(const BodyOutline& a, const GroundOutline& b) const;
  [[nodiscard]] static ConstraintKey key_of(const BodyOutline& a, const GroundOutline& b,
                                            const GapPoint& gap);
  [[nodiscard]] Range outlines_of(Index body) const { return {begin_[body], begin_[body + 1]}; }
  [[nodiscard]] Sides sides_of(const ContactPair& pair) const;
  void find_in(const Family& family, const BodyOutline& outline, const ContactQuery& query,
               ConstraintSet& out) const;
  void find_piece(Index piece, const Search& search, ConstraintSet& out) const;
  [[nodiscard]] std::optional<CornerMeeting> meeting_near(const Search& search, Index ground,
                                                          const GapPoint& contact) const;
  bool add(const Search& search, Index ground, const GapPoint& local, double most, bool of_corners,
           ConstraintSet& out) const;
  void fill(const ConstraintKey& key, const BodyOutline& a, Index ground, const GapPoint& gap,
            const StateView& state, const GroundMotion* motion, const GroundAtEnd& end,
            Constraint& out) const;

  const Assembly* assembly_;
  GroundShapes shapes_;
  GroundPieces pieces_;
  BodyOutlines outlines_;
  std::vector<Index> begin_;   // of each body: its first outline
  std::vector<Surface> laws_;  // row-major: material of the outline, shape; any where they may not touch
  std::vector<Family> families_;
  CoveringGround covering_;
};

}  // namespace carom
