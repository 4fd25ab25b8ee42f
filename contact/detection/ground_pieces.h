#pragma once

/// \file
/// Pieces of the shapes on ground of a model, which the outlines of bodies touch, and what they make
/// together: outlines on ground, each of which a vertex of a body touches in one place at a time.
///
/// Places are in the frames of shapes that move, from the points about which they turn; of shapes at rest
/// they are where these stand.

#include <carom/contact/detection/box.h>
#include <carom/contact/detection/convex_outline.h>
#include <carom/contact/detection/corner_meeting.h>
#include <carom/contact/detection/face_chain.h>
#include <carom/contact/detection/feature_region.h>
#include <carom/contact/detection/gap_face.h>
#include <carom/contact/detection/gap_point.h>
#include <carom/contact/detection/ground_shapes.h>
#include <carom/contact/detection/outline_features.h>
#include <carom/contact/detection/pair_rows.h>
#include <carom/core/constraint.h>
#include <carom/core/export.h>
#include <carom/core/ground_shape_kind.h>
#include <carom/core/space.h>

#include <array>
#include <span>
#include <vector>

namespace carom {

/// A solid, a chain of faces between two concave corners, or the inside of a circle.
struct GroundOutline : OutlineFeatures {
  GroundPiece::Form form = GroundPiece::Form::solid;  ///< what it is made of
  Index shape = none;                                 ///< number in GroundShapes
  double radius = 0.0;                                ///< of a solid's outline, or of the circle [m]
  double depth = 0.0;                                 ///< of a chain: the least of its faces [m]
  bool is_closed = false;                             ///< a chain whose last vertex is joined to the first
  bool is_of_solid = false;    ///< a chain of sides of a convex solid, of which others cover some
  double surface_speed = 0.0;  ///< of a conveyor [m/s]
  double reach = 0.0;          ///< radius of a circle around the shape's point o that holds it [m]
  Box<2> box;                  ///< around it; of the inside of a circle around that

  /// True if bodies are inside of it.
  [[nodiscard]] bool is_hollow() const { return form == GroundPiece::Form::hollow; }
  /// True if it is a chain.
  [[nodiscard]] bool is_chain() const { return form == GroundPiece::Form::face; }
};

/// Pieces of all shapes that have any, by number: shape after shape, in the order of GroundShapes.
class CAROM_API GroundPieces {
public:
  /// \param shapes of the system, in the same order \param lengths to which features are told apart
  GroundPieces(const System& system, const GroundShapes& shapes, const FeatureLengths& lengths);

  /// Lengths to which features are told apart.
  [[nodiscard]] const FeatureLengths& lengths() const { return lengths_; }

  /// Number of pieces.
  [[nodiscard]] Index size() const { return static_cast<Index>(pieces_.size()); }
  /// Outline that a piece is part of.
  [[nodiscard]] Index outline(Index piece) const { return pieces_[piece].outline; }
  /// Shape that a piece is part of.
  [[nodiscard]] Index shape(Index piece) const { return outlines_[pieces_[piece].outline].shape; }
  /// False of a hollow and of a face of any depth, which may be touched everywhere.
  [[nodiscard]] bool is_bounded(Index piece) const;
  /// Box around all that touches where it overlaps a piece that is bounded: of a face down to its depth.
  [[nodiscard]] Box<2> box(Index piece) const;
  /// Contacts of a body's outline (a) with a piece (b), with gap <= `margin` [m], the one with the least gap
  /// first. Features of b are those of the outline on ground, numbered as in ConvexOutline. \returns how many
  [[nodiscard]] int find(Index piece, const ConvexOutline& a, double margin,
                         std::array<GapPoint, 2>& out) const;

  /// All outlines.
  [[nodiscard]] const std::vector<GroundOutline>& outlines() const { return outlines_; }
  /// Vertices of all outlines [m].
  [[nodiscard]] std::span<const Vec<2>> vertices() const { return vertices_; }
  /// Outline of a vertex.
  [[nodiscard]] Index outline_of(Index vertex) const { return outline_of_[vertex]; }
  /// Outline of a feature; `none` if there is none.
  [[nodiscard]] Index outline_of(const FeatureKey& feature) const;
  /// True if a vertex is a corner that an edge of a body may touch.
  [[nodiscard]] bool is_corner(Index vertex) const;
  /// An outline as a set; of a chain its vertices, of the inside of a circle that circle.
  [[nodiscard]] ConvexOutline view(Index outline) const;
  /// A chain.
  [[nodiscard]] FaceChain chain(Index outline) const;
  /// The part of an outline around a vertex, which is the first of its vertices.
  [[nodiscard]] std::span<const Vec<2>> around(Index vertex) const { return around_[vertex]; }
  /// True of a point at a height over a feature of a chain which is behind it and does not touch it: deeper
  /// than its face is touched, or out of the ground on another side (is_out_elsewhere()).
  [[nodiscard]] bool is_out_behind(Index outline, Index feature, double height, const Vec<2>& point) const;
  /// An outline as a side of a contact. \param motion of its shape, null at rest
  [[nodiscard]] PairSide side(Index outline, const GroundMotion* motion) const;

private:
  struct Piece {
    GroundPiece at;   // placed
    GroundFace face;  // of a face
    Index outline;
    Index edge;  // its number in the outline: of a face

    [[nodiscard]] PlacedOutline placed() const;
  };
  void add_solid(GroundPiece piece, Index shape, double surface_speed);
  void add_chains(std::vector<GroundPiece>& faces, const GroundOutline& all);
  void add_chain(const std::vector<GroundPiece>& faces, std::size_t first, std::size_t count,
                 GroundOutline outline);
  void finish(GroundOutline outline);
  [[nodiscard]] bool is_through(const Piece& piece, const ConvexOutline& a, const GapPoint& at) const;
  [[nodiscard]] bool is_out_elsewhere(Index outline, double height, const Vec<2>& point) const;

  FeatureLengths lengths_;
  std::vector<Piece> pieces_;
  std::vector<GroundOutline> outlines_;
  std::vector<Vec<2>> vertices_;
  std::vector<std::array<Vec<2>, 3>> around_;
  std::vector<ChainCorner> corners_;  // by vertex; of others than chains convex
  std::vector<double> depths_;        // by vertex: of the face of a chain that begins there [m]
  std::vector<Index> outline_of_;     // by vertex
};

/// A corner of an outline on ground. \param vertex number in the outline
[[nodiscard]] inline SharpCorner corner_of(const GroundPieces& pieces, Index outline, Index vertex) {
  const Range& own = pieces.outlines()[outline].vertices;
  const std::span<const Vec<2>> around = pieces.around(own.begin + vertex);  // it, behind, before
  const Index edge_before = vertex == 0 ? own.size() - 1 : vertex - 1;
  return {around[2], around[0], around[1], false, vertex, own.size() + edge_before, own.size() + vertex};
}

}  // namespace carom
