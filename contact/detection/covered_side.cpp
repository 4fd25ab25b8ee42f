#include <carom/contact/detection/covered_side.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom {

namespace {

/// A direction of an edge away from a corner; zero of an edge without length.
Vec<2> away(const Vec<2>& corner, const Vec<2>& other_end) {
  const Vec<2> along = other_end - corner;
  const double length = along.norm();
  return length > 0.0 ? Vec<2>(along / length) : Vec<2>(Vec<2>::Zero());
}

/// Largest height of a point over the edges of an outline: negative inside [m].
double height_over(const ConvexOutline& outline, const Vec<2>& point) {
  double most = -std::numeric_limits<double>::infinity();
  for (Index i = 0; i < outline.size(); ++i) most = std::max(most, OutlineEdge(outline, i).height(point));
  return most;
}

/// True if the edge of a corner that points along `open` goes on in a face of the neighbour, and the side
/// that points along `side` is in it.
bool goes_on_in(const ConvexOutline& neighbour, const Vec<2>& corner, const Vec<2>& open, const Vec<2>& side,
                const FeatureLengths& lengths) {
  constexpr double in_line = 1e-6;  // directions that say the same, as of corners that meet [rad]
  const Vec<2> across(-open[1], open[0]);
  const Vec<2> outwards = across.dot(side) < 0.0 ? across : Vec<2>(-across);
  bool is_in_line = false;
  for (Index i = 0; i < neighbour.size() && !is_in_line; ++i) {
    const OutlineEdge face(neighbour, i);
    const Vec<2> normal = face.normal();
    is_in_line = std::abs(face.height(corner)) <= lengths.corner && normal.dot(outwards) > 0.0 &&
                 std::abs(normal.dot(open)) <= in_line;
  }
  // A body that sinks deeper does not touch a top.
  const double deep = lengths.sunk();
  return is_in_line && height_over(neighbour, corner - deep * open) <= lengths.corner &&
         height_over(neighbour, corner + deep * side) <= lengths.corner;
}

}  // namespace

HiddenSide side_covered_by(const ConvexOutline& neighbour, const SharpCorner& corner,
                           const FeatureLengths& lengths) {
  if (neighbour.size() < 3 || neighbour.radius > 0.0) return HiddenSide::neither;
  if (height_over(neighbour, corner.at) > lengths.corner) return HiddenSide::neither;
  const Vec<2> before = away(corner.at, corner.before), behind = away(corner.at, corner.behind);
  if (goes_on_in(neighbour, corner.at, behind, before, lengths)) return HiddenSide::before;
  if (goes_on_in(neighbour, corner.at, before, behind, lengths)) return HiddenSide::behind;
  return HiddenSide::neither;
}

}  // namespace carom
