#include <carom/contact/detection/drawn_outline.h>

#include <algorithm>
#include <cmath>

namespace carom {

namespace {

/// How far a face goes on under the neighbour's, as a part of that one.
constexpr double drawn_part = 0.25;
/// How much lower it gets on the way: less than can be felt as a slope, and more than what stands on the
/// neighbour sinks into it.
constexpr double drawn_slope = 1e-6;
/// How much of a face is cut off at a corner, as a part of the shorter one of the two: the side begins deeper
/// than surfaces may be apart that touch, of all faces longer than some centimetres.
constexpr double cut_part = 0.05;
/// The slope of the cut: steeper than that of the neighbour's face which goes on below it.
constexpr double cut_slope = 2.0 * drawn_slope;

}  // namespace

/// True where the face of a neighbour follows a side.
bool DrawnOutline::goes_on_at(Index side, std::size_t end) const {
  return !sides_[side].is_hidden && goes_on(followers_[side][end]);
}

std::vector<Vec<2>> DrawnOutline::points(std::span<const Vec<2>> described) const {
  const auto n = static_cast<Index>(described.size());
  std::vector<Vec<2>> out;
  for (Index i = 0; i < n; ++i) {
    const Index at = of_->first_side + i;
    add_corner(at, described[i], out);
    if (!sides_[at].is_hidden) continue;
    const Vec<2>&tail = described[i], &head = described[(i + 1) % n];
    if (const auto corner = drawn(sides_[at].next[0], 1, tail, head)) out.push_back(*corner);
    if (const auto corner = drawn(sides_[at].next[1], 0, tail, head)) out.push_back(*corner);
  }
  return out;
}

/// The corner at the tail of a side, which is the head of the one before it.
void DrawnOutline::add_corner(Index side, const Vec<2>& described, std::vector<Vec<2>>& out) const {
  const Index before = sides_[side].next[0];
  if (goes_on_at(before, 1)) {
    const Vec<2>& moved = sides_[before].ends[1];
    if (!sides_[side].is_hidden && sides_[side].is_cut[0]) return cut_corner(before, 1, side, moved, out);
    out.push_back(moved);
  } else if (goes_on_at(side, 0)) {
    const Vec<2>& moved = sides_[side].ends[0];
    if (!sides_[before].is_hidden && sides_[before].is_cut[1]) return cut_corner(side, 0, before, moved, out);
    out.push_back(moved);
  } else {
    out.push_back(described);
  }
}

/// A corner of which a neighbour covers the side, but not all of that. \param top the face that goes on
/// there, at its `end`
void DrawnOutline::cut_corner(Index top, std::size_t end, Index side, const Vec<2>& corner,
                              std::vector<Vec<2>>& out) const {
  const SideFollower& next = followers_[top][end];
  const double own = sides_[top].length();
  const double far = cut_part * (next.ends_here ? std::min(own, sides_[next.side].length()) : own);
  const double sense = end == 0 ? 1.0 : -1.0;
  const Vec<2> down = -sense * sides_[side].along;  // along the side, away from the corner
  const double steep = -sides_[top].normal().dot(down);
  const Vec<2> on_top = corner + sense * far * sides_[top].along;
  if (!(steep > cut_part)) return out.push_back(corner);  // a needle
  const Vec<2> on_side = corner + cut_slope * far / steep * down;
  out.push_back(end == 0 ? on_side : on_top);
  out.push_back(end == 0 ? on_top : on_side);
}

/// The corner that is added where a face goes on beside a hidden side, if all between is in one neighbour.
/// \param tail,head of the hidden side
std::optional<Vec<2>> DrawnOutline::drawn(Index top, std::size_t end, const Vec<2>& tail,
                                          const Vec<2>& head) const {
  if (!goes_on_at(top, end) || !followers_[top][end].ends_here) return {};
  const PieceSide& next = sides_[followers_[top][end].side];
  const double far = drawn_part * next.length(), sense = end == 0 ? -1.0 : 1.0;
  const Vec<2> at = sides_[top].ends[end] + far * (sense * next.along - drawn_slope * next.normal());
  const auto own = std::find_if(solids_.begin(), solids_.end(),
                                [&](const SolidPiece& solid) { return solid.piece == next.piece; });
  const double near = near_places(next.length(), at);
  const bool inside = own->height(at) < 0.0 && std::max(own->height(tail), own->height(head)) <= near;
  return inside ? std::optional<Vec<2>>(at) : std::nullopt;
}

}  // namespace carom
