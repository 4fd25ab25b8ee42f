// Problem: which of the many pieces of the ground belong together, so that a contact that slides from one to
// the next stays the same contact.

#include <carom/contact/detection/flush_faces.h>
#include <carom/contact/detection/ground_pieces.h>
#include <carom/contact/detection/narrow_phase.h>
#include <carom/core/registry.h>
#include <carom/core/system.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace carom {

namespace {

using Form = GroundPiece::Form;

Vec<2> placed_at(const GroundMotion& motion, const Vec<2>& point) {
  const std::array<double, 2> rotation{motion.cosine, motion.sine};
  return Vec<2>(motion.point[0], motion.point[1]) + Space<2>::rotate(rotation.data(), point);
}

GroundFace face_of(const GroundPiece& piece) {
  return {piece.points[0],    piece.points[1],    piece.points[2], piece.points[3],
          piece.tail_is_free, piece.head_is_free, piece.depth};
}

/// The boundary of a shape without pieces, if that is a line.
std::optional<GroundLine> line_of(const GroundShapes& shapes, Index shape) {
  if (!shapes.is_flat(shape)) return {};
  const std::array<double, 3> origin{};
  const Gap gap = shapes.gap(shape, nullptr, origin.data());
  const Vec<2> normal(gap.normal[0], gap.normal[1]);
  if (!std::isfinite(gap.distance) || !normal.allFinite()) return {};  // a user's shape, which is told later
  return GroundLine{-gap.distance * normal, Vec<2>(-normal[1], normal[0])};
}

Vec<2> direction(const Vec<2>& from, const Vec<2>& to) {
  const std::array<Vec<2>, 2> ends{from, to};
  return OutlineEdge({ends, 0.0}, 0).along;
}

/// True if a face is followed by another one in a corner that is not concave.
bool goes_on(const GroundPiece& face, const GroundPiece& next) {
  if (face.head_is_free || next.tail_is_free || face.points[2] != next.points[1]) return false;
  return corner_turn(direction(face.points[1], face.points[2]), direction(next.points[1], next.points[2])) !=
         CornerTurn::concave;
}

/// Shapes that do not move, where they stand; of those that do nothing.
std::vector<RestingShape> resting_shapes(const System& system, const GroundShapes& shapes) {
  const auto& registry = system.ground_shape_kinds();
  std::vector<RestingShape> all(shapes.size());
  for (Index shape = 0; shape < shapes.size(); ++shape) {
    if (shapes.moves(shape)) continue;
    RestingShape& at_rest = all[shape];
    at_rest.filter = shapes.filter(shape);
    if (!shapes.has_pieces(shape)) {
      at_rest.line = line_of(shapes, shape);
      continue;
    }
    const auto place = registry.place(shapes.key(shape).serial);
    const GroundShapeKind& kind = *registry.entries()[place.entry].kind;
    kind.pieces(place.slot, at_rest.pieces);
    const GroundMotion motion = kind.place(place.slot, 0.0);
    for (GroundPiece& piece : at_rest.pieces) {
      for (Vec<2>& point : piece.points) point = placed_at(motion, point);
    }
  }
  return all;
}

/// Where a chain that has no free end there ends.
ChainCorner end_corner(bool is_free, const Vec<2>& before, const Vec<2>& at, const Vec<2>& behind) {
  if (is_free) return ChainCorner::free;
  switch (corner_turn(direction(before, at), direction(at, behind))) {
    case CornerTurn::convex:
      return ChainCorner::free;
    case CornerTurn::flat:
      return ChainCorner::joined;
    case CornerTurn::concave:
      break;
  }
  return ChainCorner::concave;
}

}  // namespace

GroundPieces::GroundPieces(const System& system, const GroundShapes& shapes, const FeatureLengths& lengths)
    : lengths_(lengths) {
  std::vector<RestingShape> all = resting_shapes(system, shapes);
  join_flush_faces(all);
  const auto& registry = system.ground_shape_kinds();
  std::vector<GroundPiece> faces;
  for (Index shape = 0; shape < shapes.size(); ++shape) {
    if (!shapes.has_pieces(shape)) continue;
    std::vector<GroundPiece>& pieces = all[shape].pieces;
    if (shapes.moves(shape)) {
      const auto place = registry.place(shapes.key(shape).serial);
      registry.entries()[place.entry].kind->pieces(place.slot, pieces);
    }
    faces.clear();
    const auto first = static_cast<Index>(outlines_.size());
    const double speed = shapes.surface_speed(shape);
    for (GroundPiece& piece : pieces) {
      if (piece.form == Form::face) {
        faces.push_back(std::move(piece));
      } else {
        add_solid(std::move(piece), shape, speed);
      }
    }
    if (!faces.empty()) {
      GroundOutline chain;
      chain.form = Form::face;
      chain.shape = shape;
      chain.is_of_solid = all[shape].is_one_solid;
      chain.surface_speed = speed;
      add_chains(faces, chain);
    }
    Index feature = 0;
    for (Index i = first; i < outlines_.size(); ++i) {
      outlines_[i].key = shapes.key(shape);
      outlines_[i].key.feature = feature;
      feature += outlines_[i].vertices.size() + 1;
    }
  }
}

void GroundPieces::add_solid(GroundPiece piece, Index shape, double surface_speed) {
  GroundOutline outline;
  outline.form = piece.form;
  outline.shape = shape;
  outline.radius = piece.radius;
  outline.surface_speed = surface_speed;
  outline.is_closed = true;
  outline.vertices.begin = static_cast<Index>(vertices_.size());
  vertices_.insert(vertices_.end(), piece.points.begin(), piece.points.end());
  corners_.resize(vertices_.size(), ChainCorner::convex);
  depths_.resize(vertices_.size(), 0.0);
  pieces_.push_back({std::move(piece), {}, static_cast<Index>(outlines_.size()), 0});
  finish(outline);
}

/// Faces of one shape, in which some follow others. \param all what all chains have in common
void GroundPieces::add_chains(std::vector<GroundPiece>& faces, const GroundOutline& all) {
  const std::size_t n = faces.size();
  const auto is_joined = [&](std::size_t i) { return goes_on(faces[i], faces[(i + 1) % n]); };
  // A chain may go around the end of the list: it begins behind a corner that ends one.
  std::size_t start = 0;
  while (start < n && is_joined((start + n - 1) % n)) ++start;
  if (start < n) std::rotate(faces.begin(), faces.begin() + static_cast<std::ptrdiff_t>(start), faces.end());
  for (std::size_t first = 0; first < n;) {
    std::size_t count = 1;
    while (first + count < n && is_joined(first + count - 1)) ++count;
    add_chain(faces, first, count, all);
    first += count;
  }
}

void GroundPieces::add_chain(const std::vector<GroundPiece>& faces, std::size_t first, std::size_t count,
                             GroundOutline outline) {
  const GroundPiece &tail = faces[first], &head = faces[first + count - 1];
  outline.depth = tail.depth;
  outline.is_closed = goes_on(head, tail);
  outline.vertices.begin = static_cast<Index>(vertices_.size());
  for (std::size_t i = 0; i < count; ++i) {
    const GroundPiece& face = faces[first + i];
    vertices_.push_back(face.points[1]);
    depths_.push_back(face.depth);
    outline.depth = std::min(outline.depth, face.depth);
    const Vec<2> in = direction(face.points[0], face.points[1]),
                 out = direction(face.points[1], face.points[2]);
    const bool is_flat = !face.tail_is_free && corner_turn(in, out) == CornerTurn::flat;
    corners_.push_back(is_flat ? ChainCorner::flat : ChainCorner::convex);
    pieces_.push_back({face, face_of(face), static_cast<Index>(outlines_.size()), static_cast<Index>(i)});
  }
  if (!outline.is_closed) {
    corners_[outline.vertices.begin] =
        end_corner(tail.tail_is_free, tail.points[0], tail.points[1], tail.points[2]);
    vertices_.push_back(head.points[2]);
    corners_.push_back(end_corner(head.head_is_free, head.points[1], head.points[2], head.points[3]));
    depths_.push_back(0.0);  // no face begins there
  }
  finish(outline);
}

/// Takes an outline whose vertices are the last ones.
void GroundPieces::finish(GroundOutline outline) {
  outline.vertices.end = static_cast<Index>(vertices_.size());
  outline_of_.resize(vertices_.size(), static_cast<Index>(outlines_.size()));
  const std::span<const Vec<2>> own = vertices().subspan(outline.vertices.begin, outline.vertices.size());
  outline.box = box_around(own, outline.radius);
  for (const Vec<2>& vertex : own) outline.reach = std::max(outline.reach, vertex.norm() + outline.radius);
  const Index first = outline.vertices.begin, last = outline.vertices.end - 1;
  for (Index i = first; i <= last; ++i) {
    const Index before = i > first ? i - 1 : outline.is_closed ? last : i;
    const Index behind = i < last ? i + 1 : outline.is_closed ? first : i;
    around_.push_back({vertices_[i], vertices_[behind], vertices_[before]});
  }
  outlines_.push_back(outline);
}

bool GroundPieces::is_bounded(Index piece) const {
  const GroundPiece& of = pieces_[piece].at;
  return of.form == Form::solid || (of.form == Form::face && std::isfinite(of.depth));
}

Box<2> GroundPieces::box(Index piece) const {
  const GroundPiece& of = pieces_[piece].at;
  if (of.form != Form::face) return box_around(of.points, of.radius);
  const Vec<2>&tail = of.points[1], &head = of.points[2];
  const Vec<2> along = direction(tail, head), inwards(-along[1], along[0]);
  const std::array<Vec<2>, 4> corners{tail, head, tail + of.depth * inwards, head + of.depth * inwards};
  return box_around(corners, of.radius);
}

PlacedOutline GroundPieces::Piece::placed() const {
  if (at.form == Form::face) return PlacedOutline(face);
  const ConvexOutline set{at.points, at.radius};
  return at.form == Form::hollow ? PlacedOutline::outside_of(set) : PlacedOutline(set);
}

int GroundPieces::find(Index piece, const ConvexOutline& a, double margin,
                       std::array<GapPoint, 2>& out) const {
  const Piece& of = pieces_[piece];
  const int count = find_gaps(PlacedOutline(a), of.placed(), margin, out);
  if (of.at.form != Form::face) return count;
  const Index n = outlines_[of.outline].vertices.size();
  int kept = 0;
  for (int i = 0; i < count; ++i) {
    GapPoint& found = out[static_cast<std::size_t>(kept)] = out[static_cast<std::size_t>(i)];
    Index& feature = found.feature_b;  // tail, head, face
    feature = feature == 2 ? n + of.edge : feature == 0 ? of.edge : (of.edge + 1) % n;
    if (!is_through(of, a, found)) ++kept;
  }
  return kept;
}

/// True of a contact of a vertex so far behind a face that it is out of the ground again: a side at the end
/// of a line reaches far under it, and what stands on the line is behind the side, too.
bool GroundPieces::is_through(const Piece& piece, const ConvexOutline& a, const GapPoint& at) const {
  constexpr double thick =
      0.5;  // of its neighbours: behind a face no others are nearer, but in slender peaks
  const double height = at.gap + a.radius;
  if (at.kind != GapKind::edge_of_b || height >= 0.0) return false;
  const Vec<2>& vertex = a.vertices[at.feature_a];
  if (outlines_[piece.outline].is_of_solid) {
    if (height >= -lengths_.sunk()) return false;
    // Of the sides of its own chain, neighbours have been looked at.
    if (std::abs(chain(piece.outline).nearest(vertex).distance) < -thick * height) return true;
    return is_out_elsewhere(piece.outline, height, vertex);
  }
  const std::vector<Vec<2>>& points = piece.at.points;
  double least = std::numeric_limits<double>::infinity();
  if (!piece.at.tail_is_free) least = (points[1] - points[0]).squaredNorm();
  if (!piece.at.head_is_free) least = std::min(least, (points[3] - points[2]).squaredNorm());
  if (height * height <= thick * thick * least) return false;
  return is_out_elsewhere(piece.outline, height, vertex);
}

bool GroundPieces::is_out_behind(Index outline, Index feature, double height, const Vec<2>& point) const {
  const GroundOutline& of = outlines_[outline];
  const Index n = of.vertices.size();
  const bool is_face = feature >= n && feature < 2 * n;
  const double depth = is_face ? depths_[of.vertices.begin + feature - n] : of.depth;
  // A point that touches is hardly deeper, and need not be looked at further.
  return height < -lengths_.sunk() && (height < -depth || is_out_elsewhere(outline, height, point));
}

/// True of a point behind a chain that is in front of what is nearest to it of the faces of the shape. What
/// is in a convex solid is out through its nearest side first: there it is enough that this is of another
/// chain. \param height of the point over the chain, < 0
bool GroundPieces::is_out_elsewhere(Index outline, double height, const Vec<2>& point) const {
  const auto [shape, is_of_solid] = std::pair(outlines_[outline].shape, outlines_[outline].is_of_solid);
  double least = std::numeric_limits<double>::infinity();
  bool free = false;
  for (Index i = 0; i < outlines_.size(); ++i) {
    if (outlines_[i].shape != shape || !outlines_[i].is_chain()) continue;
    const FaceChain faces = chain(i);
    const FaceChain::Nearest nearest = faces.nearest(point);
    if (!(std::abs(nearest.distance) < least)) continue;
    least = std::abs(nearest.distance);
    if (is_of_solid && i != outline && least < -height) return true;
    const Index n = faces.outline.size();
    free = nearest.feature >= n ? OutlineEdge(faces.outline, nearest.feature - n).height(point) > 0.0
                                : faces.corners[nearest.feature] == ChainCorner::convex;
  }
  return free;
}

Index GroundPieces::outline_of(const FeatureKey& feature) const {
  const auto found = std::find_if(outlines_.begin(), outlines_.end(),
                                  [&](const GroundOutline& outline) { return outline.has(feature); });
  return found == outlines_.end() ? none : static_cast<Index>(found - outlines_.begin());
}

bool GroundPieces::is_corner(Index vertex) const {
  return corners_[vertex] == ChainCorner::convex || corners_[vertex] == ChainCorner::free;
}

ConvexOutline GroundPieces::view(Index outline) const {
  const GroundOutline& of = outlines_[outline];
  return {vertices().subspan(of.vertices.begin, of.vertices.size()), of.radius};
}

FaceChain GroundPieces::chain(Index outline) const {
  const GroundOutline& of = outlines_[outline];
  const std::span<const ChainCorner> corners(corners_);
  const std::span<const double> depths(depths_);
  const Index first = of.vertices.begin, n = of.vertices.size();
  return {view(outline), corners.subspan(first, n), of.is_closed, depths.subspan(first, n), lengths_};
}

PairSide GroundPieces::side(Index outline, const GroundMotion* motion) const {
  const GroundOutline& of = outlines_[outline];
  const double radius = of.is_hollow() ? -of.radius : of.radius;
  PairSide ground = motion == nullptr ? PairSide::at_rest(radius) : PairSide::of_motion(*motion, radius);
  ground.surface_speed = of.surface_speed;
  return ground;
}

}  // namespace carom
