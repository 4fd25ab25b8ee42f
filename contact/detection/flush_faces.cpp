// Problem: which sides of many pieces together are sides of what they make, and which face follows another.

#include <carom/contact/detection/box.h>
#include <carom/contact/detection/box_grid.h>
#include <carom/contact/detection/convex_outline.h>
#include <carom/contact/detection/drawn_outline.h>
#include <carom/contact/detection/flush_faces.h>
#include <carom/contact/detection/flush_sides.h>
#include <carom/contact/detection/gap_face.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <utility>

namespace carom {

namespace {

class FlushFaces {
public:
  /// \param may_cover as of draw_covered_corners(); empty: shapes of one filter do
  explicit FlushFaces(std::span<RestingShape> shapes, std::function<bool(Index, Index)> may_cover = {})
      : shapes_(shapes), may_cover_(std::move(may_cover)) {
    for (Index shape = 0; shape < shapes_.size(); ++shape) add(shape);
  }

  void join() {
    const std::vector<bool> joined = find();
    for (Index shape = 0; shape < joined.size(); ++shape) {
      if (joined[shape]) write(shape);
    }
  }
  void draw() {
    const std::vector<bool> joined = find();
    for (const SolidPiece& solid : solids_) {
      if (joined.empty() || !joined[solid.shape]) continue;
      std::vector<Vec<2>>& points = shapes_[solid.shape].pieces.front().points;
      points = DrawnOutline(sides_, followers_, solids_, solid).points(points);
    }
  }

private:
  using Form = GroundPiece::Form;

  // Sides that others cover, and neighbours that follow. \returns by shape, whether a face of it goes on in
  // another piece; nothing if none does
  std::vector<bool> find() {
    if (sides_.empty() || pieces_ < 2) return {};
    build_grids();
    for (PieceSide& side : sides_) uncover(side);
    followers_.resize(sides_.size());
    std::vector<bool> joined(shapes_.size(), false);
    bool any = false;
    for (Index i = 0; i < sides_.size(); ++i) {
      for (const std::size_t end : {0U, 1U}) {
        if (sides_[i].is_hidden) continue;
        followers_[i][end] = follower(i, end);
        if (!goes_on(followers_[i][end])) continue;
        joined[sides_[i].shape] = any = true;
      }
    }
    if (!any) return {};
    move_together();
    return joined;
  }
  [[nodiscard]] bool covers(Index shape, Index other) const {
    if (!(shapes_[shape].filter == shapes_[other].filter)) return false;
    return !may_cover_ || shape == other || may_cover_(shape, other);
  }

  void add(Index shape) {
    RestingShape& of = shapes_[shape];
    if (of.line) {
      const Box<2> everywhere{Vec<2>(-without_bound, -without_bound), Vec<2>(without_bound, without_bound)};
      lines_.emplace_back(shape, *of.line);
      solids_.push_back({shape, pieces_++, {*of.line}, everywhere});
      return;
    }
    for (const GroundPiece& piece : of.pieces) {
      if (piece.form == Form::solid && piece.radius == 0.0 && piece.points.size() > 2)
        add_solid(shape, piece);
    }
    const auto first_face = static_cast<Index>(sides_.size());
    for (const GroundPiece& piece : of.pieces) {
      if (piece.form == Form::face) add_face(shape, piece);
    }
    if (sides_.size() > first_face) ++pieces_;
    connect(first_face);
  }

  PieceSide side_of(Index shape, const Vec<2>& tail, const Vec<2>& head) const {
    PieceSide side;
    side.shape = shape;
    side.piece = pieces_;
    side.ends = side.beyond = {tail, head};
    side.along = OutlineEdge({side.ends, 0.0}, 0).along;
    return side;
  }

  void add_solid(Index shape, const GroundPiece& piece) {
    const auto first = static_cast<Index>(sides_.size()), n = static_cast<Index>(piece.points.size());
    SolidPiece solid{shape, pieces_, {}, box_around(piece.points, 0.0)};
    solid.first_side = first;
    for (Index i = 0; i < n; ++i) {
      PieceSide side = side_of(shape, piece.points[i], piece.points[(i + 1) % n]);
      side.next = {first + (i + n - 1) % n, first + (i + 1) % n};
      // A point that is deeper than the middle is nearer to another side.
      side.depth = 0.0;
      for (const Vec<2>& point : piece.points) side.depth = std::max(side.depth, -0.5 * side.height(point));
      solid.lines.push_back({side.ends[0], side.along});
      sides_.push_back(side);
    }
    solids_.push_back(std::move(solid));
    ++pieces_;
  }

  // A face is solid in a strip behind it.
  void add_face(Index shape, const GroundPiece& piece) {
    PieceSide side = side_of(shape, piece.points[1], piece.points[2]);
    side.depth = piece.depth;
    if (!piece.tail_is_free) side.beyond[0] = piece.points[0];
    if (!piece.head_is_free) side.beyond[1] = piece.points[3];
    const Vec<2> inwards = -side.normal();
    SolidPiece solid{
        shape, pieces_, {{side.ends[0], side.along}, {side.ends[1], inwards}, {side.ends[0], -inwards}}, {}};
    if (std::isfinite(side.depth)) {
      solid.lines.push_back({side.ends[0] + side.depth * inwards, -side.along});
      const std::array<Vec<2>, 4> corners{side.ends[0], side.ends[1], side.ends[0] + side.depth * inwards,
                                          side.ends[1] + side.depth * inwards};
      solid.box = box_around(corners, 0.0);
    } else {
      solid.box = {Vec<2>(-without_bound, -without_bound), Vec<2>(without_bound, without_bound)};
    }
    solids_.push_back(std::move(solid));
    sides_.push_back(side);
  }

  // Finds which faces of a polyline follow each other.
  void connect(Index first) {
    const auto end = static_cast<Index>(sides_.size());
    for (Index i = first; i < end; ++i) {
      // Mostly the next one of the list.
      for (Index k = 1; k <= end - first; ++k) {
        const Index j = first + (i - first + k) % (end - first);
        if (sides_[i].ends[1] != sides_[j].ends[0]) continue;
        sides_[i].next[1] = j;
        sides_[j].next[0] = i;
        break;
      }
    }
  }

  void build_grids() {
    std::vector<OwnedBox<2>> sides, solids;
    for (Index i = 0; i < sides_.size(); ++i) sides.push_back({around(sides_[i]), i, none});
    for (Index i = 0; i < solids_.size(); ++i) {
      if (solids_[i].is_bounded()) {
        solids.push_back({solids_[i].box, i, none});
      } else {
        unbounded_.push_back(i);
      }
    }
    side_grid_.build(sides);
    if (!solids.empty()) solid_grid_.build(solids);
    has_bounded_ = !solids.empty();
  }

  static Box<2> around(const PieceSide& side) {
    return box_around(side.ends,
                      near_places(side.length(), side.ends[0]) + near_places(side.length(), side.ends[1]));
  }

  template <class F>
  void for_solids(const PieceSide& side, F&& f) const {
    const auto look = [&](Index i) {
      const SolidPiece& solid = solids_[i];
      if (solid.piece != side.piece && covers(solid.shape, side.shape)) f(solid);
    };
    for (const Index i : unbounded_) look(i);
    if (!has_bounded_) return;
    solid_grid_.for_overlapping(around(side), [&](const OwnedBox<2>& box) { look(box.number); });
  }

  // Leaves out what other pieces cover at the ends of a side.
  void uncover(PieceSide& side) {
    std::vector<std::pair<double, double>> parts;
    const double length = side.length(), near = near_places(length, side.ends[0]), least = 4.0 * near;
    for_solids(side, [&](const SolidPiece& solid) {
      const std::pair<double, double> part = covered_part(side, solid, near);
      if (part.second - part.first > least) parts.push_back(part);
    });
    double from = 0.0, to = length;
    for (bool grows = true; grows;) {
      grows = false;
      for (const auto& [begin, end] : parts) {
        if (begin <= from + least && end > from) from = end, grows = true;
        if (end >= to - least && begin < to) to = begin, grows = true;
      }
    }
    side.is_cut = {from > 0.0, to < length};
    side.is_hidden = to - from <= least;
    const Vec<2> tail = side.ends[0];
    if (side.is_cut[0]) side.ends[0] = tail + from * side.along;
    if (side.is_cut[1]) side.ends[1] = tail + to * side.along;
  }

  // Angle of the free space between two sides at a common corner. \param back from it along the one whose
  // head it is \param on from it along the one whose tail it is
  static double free_angle(const Vec<2>& back, const Vec<2>& on) {
    constexpr double closed = 1e-7;  // back to back [rad]
    const double angle = std::atan2(cross_of_sides(back, on), back.dot(on));
    return angle < closed ? angle + 2.0 * std::numbers::pi : angle;
  }
  static double free_angle(const PieceSide& side, std::size_t end, const Vec<2>& along_other) {
    return end == 0 ? free_angle(Vec<2>(-along_other), side.along)
                    : free_angle(Vec<2>(-side.along), along_other);
  }

  // The first side that is met on going around an end of a side through free space.
  [[nodiscard]] SideFollower follower(Index which, std::size_t end) const {
    const PieceSide& side = sides_[which];
    const Vec<2>& place = side.ends[end];
    SideFollower best;
    best.turn = without_bound;
    const auto take = [&](const SideFollower& at) {
      if (at.turn < best.turn) best = at;
    };
    if (const Index own = side.next[end]; own != none && !side.is_cut[end]) {
      const PieceSide& next = sides_[own];
      if (!next.is_hidden && !next.is_cut[1 - end])
        take({own, false, true, free_angle(side, end, next.along), next.along});
    }
    const auto is_other = [&](Index shape, Index piece) {
      return piece != side.piece && covers(shape, side.shape);
    };
    side_grid_.for_overlapping(around(side), [&](const OwnedBox<2>& box) {
      const PieceSide& other = sides_[box.number];
      if (other.is_hidden || !is_other(other.shape, other.piece)) return;
      const double near = near_places(std::min(side.length(), other.length()), place);
      const bool ends_here = (other.ends[1 - end] - place).cwiseAbs().maxCoeff() <= 2.0 * near;
      const double at = other.along.dot(place - other.ends[0]);
      const bool passes = at > near && at < other.length() - near && std::abs(other.height(place)) <= near;
      if (ends_here || passes)
        take({box.number, true, ends_here, free_angle(side, end, other.along), other.along});
    });
    for (const auto& [shape, line] : lines_) {
      if (!covers(shape, side.shape)) continue;
      const double height = -cross_of_sides(line.along, Vec<2>(place - line.origin));
      if (std::abs(height) <= near_places(side.length(), place))
        take({none, true, false, free_angle(side, end, line.along), line.along});
    }
    return best;
  }

  // Moves ends that follow each other, of two pieces, into one place: that of the first.
  void move_together() {
    for (Index i = 0; i < sides_.size(); ++i) {
      for (const std::size_t end : {0U, 1U}) {
        const SideFollower& at = followers_[i][end];
        if (sides_[i].is_hidden || !goes_on(at) || !at.ends_here || at.side < i) continue;
        if (followers_[at.side][1 - end].side == i) sides_[at.side].ends[1 - end] = sides_[i].ends[end];
      }
    }
  }

  // The sides of a shape as faces of polylines, in place of its sharp pieces.
  void write(Index shape) {
    std::vector<GroundPiece>& pieces = shapes_[shape].pieces;
    shapes_[shape].is_one_solid = pieces.size() == 1 && pieces.front().form == Form::solid;
    std::erase_if(pieces, [](const GroundPiece& piece) {
      return piece.form == Form::face ||
             (piece.form == Form::solid && piece.radius == 0.0 && piece.points.size() > 2);
    });
    for (Index i = 0; i < sides_.size(); ++i) {
      const PieceSide& side = sides_[i];
      if (side.shape != shape || side.is_hidden) continue;
      GroundPiece face{.form = Form::face, .depth = std::min(depth_of(i, 0), depth_of(i, 1))};
      const std::array<Vec<2>, 2> beyond{beyond_of(i, 0), beyond_of(i, 1)};
      face.points = {beyond[0], side.ends[0], side.ends[1], beyond[1]};
      face.tail_is_free = beyond[0] == side.ends[0];
      face.head_is_free = beyond[1] == side.ends[1];
      pieces.push_back(std::move(face));
    }
  }

  // How deep a side is touched. What is beyond an inner corner touches it too, as far as it is in both
  // pieces.
  [[nodiscard]] double depth_of(Index which, std::size_t end) const {
    const SideFollower& at = followers_[which][end];
    const double own = sides_[which].depth;
    const bool is_inner = at.is_foreign && at.side != none && !goes_on(at);
    return is_inner ? std::min(own, sides_[at.side].depth) : own;
  }

  // The other end of what follows at an end of a side; that end itself if nothing does.
  [[nodiscard]] Vec<2> beyond_of(Index which, std::size_t end) const {
    const PieceSide& side = sides_[which];
    const SideFollower& at = followers_[which][end];
    if (!(at.turn < without_bound)) return side.is_cut[end] ? side.ends[end] : side.beyond[end];
    if (at.ends_here) return sides_[at.side].ends[end];
    return side.ends[end] + (end == 0 ? -side.length() : side.length()) * at.along;
  }

  std::span<RestingShape> shapes_;
  std::function<bool(Index, Index)> may_cover_;
  Index pieces_ = 0;
  std::vector<PieceSide> sides_;
  std::vector<std::pair<Index, GroundLine>> lines_;  // with their shapes
  std::vector<SolidPiece> solids_;
  std::vector<Index> unbounded_;  // solids
  bool has_bounded_ = false;
  BoxGrid<2> side_grid_, solid_grid_;
  std::vector<SideFollowers> followers_;  // by side, at its tail and head
};

}  // namespace

void join_flush_faces(std::span<RestingShape> shapes) { FlushFaces(shapes).join(); }

void draw_covered_corners(std::span<RestingShape> shapes,
                          const std::function<bool(Index, Index)>& may_cover) {
  FlushFaces(shapes, may_cover).draw();
}

}  // namespace carom
