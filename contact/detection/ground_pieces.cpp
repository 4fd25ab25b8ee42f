#include <carom/contact/detection/gap_convex.h>
#include <carom/contact/detection/gap_face.h>
#include <carom/contact/detection/gap_inside_circle.h>
#include <carom/contact/detection/ground_pieces.h>
#include <carom/core/system.h>

#include <algorithm>
#include <limits>
#include <span>

namespace carom {

namespace {

constexpr Index features_of_face = 3;  // tail, head, and what is between

Index features_of(const GroundPiece& piece) {
  const auto points = static_cast<Index>(piece.points.size());
  switch (piece.form) {
    case GroundPiece::Form::face:
      return features_of_face;
    case GroundPiece::Form::hollow:
      return 1;
    case GroundPiece::Form::solid:
      break;
  }
  return points == 1 ? 1 : 2 * points;
}

Vec<2> placed_at(const GroundMotion& motion, const Vec<2>& point) {
  const std::array<double, 2> rotation{motion.cosine, motion.sine};
  return Vec<2>(motion.point[0], motion.point[1]) + Space<2>::rotate(rotation.data(), point);
}

GroundFace face_of(const GroundPiece& piece, const Vec<2>* points) {
  return {points[0], points[1], points[2], points[3], piece.tail_is_free, piece.head_is_free, piece.depth};
}

ConvexOutline outline_of(const GroundPiece& piece, const Vec<2>* points) {
  return {{points, piece.points.size()}, piece.radius};
}

}  // namespace

GroundPieces::GroundPieces(const System& system, const GroundShapes& shapes) {
  const auto& registry = system.ground_shape_kinds();
  std::vector<GroundPiece> pieces;
  for (Index shape = 0; shape < shapes.size(); ++shape) {
    const auto place = registry.place(shapes.key(shape).serial);
    const GroundShapeKind& kind = *registry.entries()[place.entry].kind;
    pieces.clear();
    kind.pieces(place.slot, pieces);
    if (pieces.empty()) continue;
    const GroundMotion at_rest = shapes.moves(shape) ? GroundMotion{} : kind.place(place.slot, 0.0);
    Index feature = 0;
    for (GroundPiece& piece : pieces) {
      const Index first_point = static_cast<Index>(resting_.size()), features = features_of(piece);
      for (const Vec<2>& point : piece.points) resting_.push_back(placed_at(at_rest, point));
      pieces_.push_back({std::move(piece), shape, first_point, feature, kind.surface_speed(place.slot)});
      feature += features;
    }
  }
}

FeatureKey GroundPieces::key(const GroundShapes& shapes, Index piece, Index feature) const {
  FeatureKey key = shapes.key(pieces_[piece].shape);
  key.feature = pieces_[piece].first_feature + feature;
  return key;
}

void GroundPieces::place(const GroundShapes& shapes, const GroundPlaces& places, PlacedPieces& out) const {
  out.points_ = resting_;
  for (const Piece& piece : pieces_) {
    const GroundMotion* motion = shapes.motion(piece.shape, places);
    if (motion == nullptr) continue;
    for (Index i = 0; i < piece.as_described.points.size(); ++i) {
      out.points_[piece.first_point + i] = placed_at(*motion, piece.as_described.points[i]);
    }
  }
}

Bounds GroundPieces::bounds(Index piece, const PlacedPieces& placed) const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const GroundPiece& of = pieces_[piece].as_described;
  const Vec<2>* const at = points(pieces_[piece], placed);
  if (of.form == GroundPiece::Form::hollow) return {Vec<2>::Constant(-infinity), Vec<2>::Constant(infinity)};
  const bool is_face = of.form == GroundPiece::Form::face;
  const auto first = at + (is_face ? 1 : 0), last = is_face ? at + 3 : at + of.points.size();
  Bounds bounds{*first, *first};
  for (auto point = first; point != last; ++point) {
    bounds.lower = bounds.lower.cwiseMin(*point);
    bounds.upper = bounds.upper.cwiseMax(*point);
  }
  bounds.lower.array() -= of.radius;
  bounds.upper.array() += of.radius;
  return bounds;
}

int GroundPieces::find(Index piece, const PlacedPieces& placed, const ConvexOutline& a, double margin,
                       std::array<GapPoint, 2>& out) const {
  const GroundPiece& of = pieces_[piece].as_described;
  const Vec<2>* const at = points(pieces_[piece], placed);
  switch (of.form) {
    case GroundPiece::Form::face:
      return find_face_gaps(a, face_of(of, at), margin, out);
    case GroundPiece::Form::hollow:
      return find_gaps_inside_circle(a, at[0], of.radius, margin, out);
    case GroundPiece::Form::solid:
      break;
  }
  return find_gaps(a, outline_of(of, at), margin, out);
}

GapPoint GroundPieces::tracked(Index piece, const PlacedPieces& placed, const ConvexOutline& a,
                               Index feature_a, Index feature_b) const {
  const GroundPiece& of = pieces_[piece].as_described;
  const Vec<2>* const at = points(pieces_[piece], placed);
  switch (of.form) {
    case GroundPiece::Form::face:
      return tracked_gap(a, feature_a, {{at + 1, 2}, 0.0}, feature_b);
    case GroundPiece::Form::hollow:
      return gap_inside_circle(a, feature_a, at[0], of.radius);
    case GroundPiece::Form::solid:
      break;
  }
  return tracked_gap(a, feature_a, outline_of(of, at), feature_b);
}

void GroundPieces::fill_rows(Index piece, const PairSide& body, const GapPoint& at,
                             const GroundMotion* motion, const GroundMotion* after, Constraint& out) const {
  const Piece& of = pieces_[piece];
  const bool is_hollow = of.as_described.form == GroundPiece::Form::hollow;
  const double radius = is_hollow ? -of.as_described.radius : of.as_described.radius;
  fill_pair_rows(body, motion == nullptr ? PairSide::at_rest(radius) : PairSide::of_motion(*motion, radius),
                 at, out);
  if (motion != nullptr && after != nullptr) add_motion_after(at, *motion, *after, out);
  out.surface_velocity[1] += of.surface_speed;
  out.surface_velocity_after[1] += of.surface_speed;
}

}  // namespace carom
