#pragma once

/// \file
/// Pieces of the shapes on ground of a model, which the outlines of bodies touch: where they are, and the
/// contacts with them.

#include <carom/contact/detection/convex_outline.h>
#include <carom/contact/detection/gap_point.h>
#include <carom/contact/detection/ground_shapes.h>
#include <carom/contact/detection/pair_rows.h>
#include <carom/core/constraint.h>
#include <carom/core/export.h>
#include <carom/core/ground_shape_kind.h>
#include <carom/core/space.h>

#include <array>
#include <vector>

namespace carom {

/// Places of the points of all pieces at one time. A workspace that GroundPieces::place() fills.
class PlacedPieces {
private:
  friend class GroundPieces;
  std::vector<Vec<2>> points_;
};

/// Box with sides along the axes.
struct Bounds {
  Vec<2> lower = Vec<2>::Zero(), upper = Vec<2>::Zero();  ///< corners; infinite where nothing bounds it [m]
};

/// Pieces of all shapes that have any, by number: shape after shape, in the order of GroundShapes.
class CAROM_API GroundPieces {
public:
  /// \param shapes of the system, in the same order
  GroundPieces(const System& system, const GroundShapes& shapes);

  /// Number of pieces.
  [[nodiscard]] Index size() const { return static_cast<Index>(pieces_.size()); }
  /// Number of a piece's shape.
  [[nodiscard]] Index shape(Index piece) const { return pieces_[piece].shape; }
  /// A feature of a piece, as find() numbers it, as feature of its shape.
  [[nodiscard]] FeatureKey key(const GroundShapes& shapes, Index piece, Index feature) const;

  /// Says where the pieces are. \param places from GroundShapes::place()
  void place(const GroundShapes& shapes, const GroundPlaces& places, PlacedPieces& out) const;
  /// Bounds of what is solid of a piece and can be touched first: of a solid the whole, of a face the line,
  /// of a hollow everything.
  [[nodiscard]] Bounds bounds(Index piece, const PlacedPieces& placed) const;
  /// Contacts of a body's outline (a) with a piece (b), with gap <= `margin` [m], the one with the least gap
  /// first. \returns how many
  [[nodiscard]] int find(Index piece, const PlacedPieces& placed, const ConvexOutline& a, double margin,
                         std::array<GapPoint, 2>& out) const;
  /// The gap of given features, as tracked_gap() (gap_convex.h).
  [[nodiscard]] GapPoint tracked(Index piece, const PlacedPieces& placed, const ConvexOutline& a,
                                 Index feature_a, Index feature_b) const;
  /// Writes the rows of a contact with a piece, as fill_pair_rows(), the velocity of a conveyor's surface
  /// with them. \param motion of its shape, null at rest \param after likewise at the end of the step; null
  /// where no time passes
  void fill_rows(Index piece, const PairSide& body, const GapPoint& at, const GroundMotion* motion,
                 const GroundMotion* after, Constraint& out) const;

private:
  struct Piece {
    GroundPiece as_described;
    Index shape;          // number in GroundShapes
    Index first_point;    // in PlacedPieces
    Index first_feature;  // within its shape
    double surface_speed;
  };
  [[nodiscard]] const Vec<2>* points(const Piece& piece, const PlacedPieces& placed) const {
    return placed.points_.data() + piece.first_point;
  }

  std::vector<Piece> pieces_;
  std::vector<Vec<2>> resting_;  // points of all pieces where they are at rest, or described
};

}  // namespace carom
