#include <carom/contact/detection/drawn_outline.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace carom {

namespace {

/// How far a face goes on under the neighbour's, as a part of that one.
constexpr double drawn_part = 0.25;
/// The part of that on which it is no lower: whoever begins at the seam, or stands there, is on both faces.
constexpr double level_part = 0.01;
/// How much lower it gets on the way from there: less than can be felt as a slope, and more than what stands
/// on the neighbour sinks into it.
constexpr double drawn_slope = 2.5e-7;
/// Faces that turn by less go on in one line [rad].
constexpr double in_line = 1e-9;
/// How much of a face is cut off at a corner, as a part of the shorter one of the two: the side begins deeper
/// than surfaces may be apart that touch, of all faces longer than some centimetres.
constexpr double cut_part = 0.25;
/// The slope of the cut: steeper than that of the neighbour's face which goes on below it.
constexpr double cut_slope = 2.0 * drawn_slope;

}  // namespace

/// True where the face of a neighbour follows a side.
bool DrawnOutline::goes_on_at(Index side, std::size_t end) const {
  return !sides_[side].is_hidden && goes_on(followers_[side][end]);
}

std::vector<Vec<2>> DrawnOutline::points(std::span<const Vec<2>> described) const {
  std::vector<Vec<2>> out;
  for (Index i = 0; i < described.size(); ++i) add_corner(of_->first_side + i, described[i], out);
  return out;
}

/// The corner at the tail of a side, which is the head of the one before it.
void DrawnOutline::add_corner(Index side, const Vec<2>& described, std::vector<Vec<2>>& out) const {
  const Index before = sides_[side].next[0];
  if (goes_on_at(before, 1)) {
    add_end(before, 1, side, out);
  } else if (goes_on_at(side, 0)) {
    add_end(side, 0, before, out);
  } else {
    out.push_back(described);
  }
}

/// The corner between a face that goes on in a neighbour, at its `end`, and the side there.
void DrawnOutline::add_end(Index top, std::size_t end, Index side, std::vector<Vec<2>>& out) const {
  const Vec<2>& corner = sides_[top].ends[end];
  if (sides_[side].is_hidden) {
    if (const auto at = drawn(top, end, sides_[side])) {
      // Where the neighbour's face turns away the corner is one of the floor.
      const bool is_bent = followers_[top][end].turn > std::numbers::pi + in_line;
      const Vec<2>& near = is_bent ? corner : at->near;
      out.insert(out.end(), {end == 0 ? at->far : near, end == 0 ? near : at->far});
      return;
    }
  } else if (sides_[side].is_cut[1 - end]) {
    return cut_corner(top, end, side, corner, out);
  }
  out.push_back(corner);
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

/// The corners in place of one where a face goes on beside a hidden side, if all between is in one neighbour.
std::optional<DrawnOutline::Drawn> DrawnOutline::drawn(Index top, std::size_t end,
                                                       const PieceSide& hidden) const {
  if (!followers_[top][end].ends_here) return {};
  const PieceSide& next = sides_[followers_[top][end].side];
  const double far = drawn_part * next.length(), sense = end == 0 ? -1.0 : 1.0;
  const Vec<2>& corner = sides_[top].ends[end];
  const Vec<2> along = sense * next.along;
  const Drawn at{corner + level_part * far * along, corner + far * along - drawn_slope * far * next.normal()};
  const auto own = std::find_if(solids_.begin(), solids_.end(),
                                [&](const SolidPiece& solid) { return solid.piece == next.piece; });
  const double near = near_places(next.length(), at.far);
  const double highest = std::max(own->height(hidden.beyond[0]), own->height(hidden.beyond[1]));
  return own->height(at.far) < 0.0 && highest <= near ? std::optional<Drawn>(at) : std::nullopt;
}

}  // namespace carom
