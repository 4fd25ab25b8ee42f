// Problem: which of many pieces of the ground a body touches, and where.

#include <carom/contact/detection/contacts_of_two.h>
#include <carom/contact/detection/corner_meeting.h>
#include <carom/contact/detection/ground_touches.h>
#include <carom/contact/detection/short_list.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace carom {

struct GroundTouches::Search {
  const Outlines& outlines;
  const ContactQuery& query;
  Index outline;         // of the body
  double margin;         // of gaps, those of lasting contacts included
  std::size_t first;     // contact of the outline
  ConvexOutline placed;  // in the frame of the family
  const GroundMotion* motion = nullptr;
  PlaneFrame frame;  // of the family
  PlaneFrame of_body;

  [[nodiscard]] const BodyOutline& of_body_outline() const { return outlines.of_bodies().list()[outline]; }
};

/// Pieces at rest are one family, however many shapes they are of.
GroundTouches::GroundTouches(const Outlines& outlines) {
  if (!outlines.ground_touches()) return;
  const GroundPieces& pieces = outlines.on_ground();
  const GroundShapes& shapes = outlines.shapes();
  const std::vector<BodyOutline>& list = outlines.of_bodies().list();
  const auto bodies = static_cast<Index>(outlines.slots().size());
  for (Index body = 0, next = 0; body <= bodies; ++body) {
    while (next < list.size() && list[next].body < body) ++next;
    begin_.push_back(next);
  }
  std::vector<std::vector<OwnedBox<2>>> boxes;
  std::vector<Index> family_of(shapes.size(), none);
  Index at_rest = none;
  for (Index piece = 0; piece < pieces.size(); ++piece) {
    const Index shape = pieces.shape(piece);
    Index& family = shapes.moves(shape) ? family_of[shape] : at_rest;
    if (family == none) {
      family = static_cast<Index>(families_.size());
      families_.emplace_back().shape = shapes.moves(shape) ? shape : none;
      boxes.emplace_back();
    }
    if (!pieces.is_bounded(piece)) {
      families_[family].unbounded.push_back(piece);
      continue;
    }
    const Box<2> box = pieces.box(piece);
    boxes[family].push_back({box, piece, none});
    const double reach = box.min.cwiseAbs().cwiseMax(box.max.cwiseAbs()).norm();
    families_[family].reach = std::max(families_[family].reach, reach);
  }
  for (std::size_t i = 0; i < families_.size(); ++i) families_[i].grid.build(boxes[i]);
}

void GroundTouches::find(const Outlines& outlines, Index body, const ContactQuery& query,
                         ConstraintSet& out) const {
  for (Index i = begin_[body]; i < begin_[body + 1]; ++i) {
    for (const Family& family : families_) {
      Search search{outlines, query, i, query.margin, out.size(), {}, nullptr, {}, {}};
      find_in(family, search, out);
    }
  }
}

/// Looks up the pieces of a family near an outline.
void GroundTouches::find_in(const Family& family, Search& search, ConstraintSet& out) {
  const ContactQuery& query = search.query;
  const BodyOutline& outline = search.of_body_outline();
  const BodySlot body = search.outlines.slots()[outline.body];
  if (family.shape != none) search.motion = search.outlines.shapes().motion(family.shape, query.places);
  search.frame = PlaneFrame(search.motion);
  const PlaneFrame of_body = search.of_body = PlaneFrame(body, query.state, query.evaluation);
  if (query.lasting != nullptr && !query.lasting->empty()) {
    // No contact of the step before has opened faster than the sides move.
    constexpr double faster = 2.0;
    double speed = of_body.velocity.norm() + std::abs(of_body.spin) * outline.reach;
    if (search.motion != nullptr) {
      const Vec<2> arm = of_body.centre - search.frame.centre;
      speed += search.frame.velocity_at(arm).norm() + std::abs(search.frame.spin) * outline.reach;
    }
    search.margin += faster * query.lasting->step() * speed + query.lasting->slack();
  }
  const Vec<2> apart = of_body.centre - search.frame.centre;
  const double near = family.reach + outline.reach + search.margin;
  const bool is_near = family.shape == none || apart.squaredNorm() <= near * near;
  if (!is_near && family.unbounded.empty()) return;

  ShortList<Vec<2>, 32> vertices;
  vertices.reset(outline.vertices.size());
  search.outlines.of_bodies().place(outline, body, query.state, query.evaluation, vertices.all().data());
  if (search.motion != nullptr) {
    for (Vec<2>& vertex : vertices.all()) vertex = search.frame.inside(vertex);
  }
  search.placed = {vertices.all(), outline.radius};
  ShortList<Index, 64> near_by;
  if (is_near) {
    const Box<2> box = box_around(vertices.all(), outline.radius + search.margin);
    family.grid.for_overlapping(box, [&](const OwnedBox<2>& piece) { near_by.push_back(piece.number); });
    std::sort(near_by.all().begin(), near_by.all().end());
  }
  for (const Index piece : near_by.all()) find_piece(piece, search, out);
  for (const Index piece : family.unbounded) find_piece(piece, search, out);
}

void GroundTouches::find_piece(Index piece, const Search& search, ConstraintSet& out) {
  const Outlines& outlines = search.outlines;
  const GroundPieces& pieces = outlines.on_ground();
  const Index on_ground = pieces.outline(piece), number = outlines.of_ground(on_ground);
  if (!outlines.may_touch(search.of_body_outline(), pieces.outlines()[on_ground])) return;
  std::array<GapPoint, 2> found;
  const int count = pieces.find(piece, search.placed, search.margin, found);
  if (count == 0) return;
  const auto corners_near = [&](const GapPoint& gap) { return meeting_near(search, on_ground, gap); };
  const auto have_one_name = [&](const GapPoint& one, const GapPoint& other) {
    return outlines.key_of(search.outline, number, one) == outlines.key_of(search.outline, number, other);
  };
  const auto add_one = [&](const GapPoint& gap, bool of_corners, TwoOutlines::Adds adds) {
    const bool anyway = adds == TwoOutlines::Adds::anyway;
    const double most = anyway ? std::numeric_limits<double>::infinity() : search.query.margin;
    return add(search, on_ground, gap, most, of_corners, out);
  };
  list_contacts({found.data(), static_cast<std::size_t>(count)},
                {corners_near, have_one_name, add_one, pieces.lengths().corner});
}

/// The corners nearest to where a sharp outline of a body touches one of the ground; nothing where no two are
/// near.
std::optional<CornerMeeting> GroundTouches::meeting_near(const Search& search, Index on_ground,
                                                         const GapPoint& first) {
  const GroundPieces& pieces = search.outlines.on_ground();
  const GroundOutline& b = pieces.outlines()[on_ground];
  const ConvexOutline &of_a = search.placed, of_b = pieces.view(on_ground);
  const double same_place = pieces.lengths().corner;
  if (b.is_hollow() || of_a.radius + b.radius > 0.0 || !is_near_corner(first, same_place)) return {};
  const auto [i, j] = nearest_corners(of_a, of_b, first);
  if (!pieces.is_corner(b.vertices.begin + j)) return {};
  CornerMeeting meeting{SharpCorner::of(of_a, i), corner_of(pieces, on_ground, j), same_place};
  const BodyOutline& a = search.of_body_outline();
  const LastingContacts* const lasting = search.query.lasting;
  meeting.lasts = lasting != nullptr && lasting->contains({a.vertex(i), b.surface()}) &&
                  lasting->contains({a.surface(), b.vertex(j)});
  const PlaneFrame &body = search.of_body, &frame = search.frame;
  const Vec<2> at_a = frame.outside(meeting.a.at), at_b = frame.outside(meeting.b.at);
  meeting.velocity = frame.turned_back(
      Vec<2>(body.velocity_at(Vec<2>(at_a - body.centre)) - frame.velocity_at(Vec<2>(at_b - frame.centre))));
  SharpCorner in_space = meeting.b;
  for (Vec<2>* point : {&in_space.before, &in_space.at, &in_space.behind}) *point = frame.outside(*point);
  meeting.b.hidden = search.outlines.covered_side(in_space, b.shape, a.filter, search.query.places);
  return meeting;
}

/// Appends a contact that is closed, or was and may still be. \param local its gap, in the frame of the
/// family \param most largest gap of what is closed [m] \param of_corners whether it is one of the two of
/// corners that meet
bool GroundTouches::add(const Search& search, Index on_ground, const GapPoint& local, double most,
                        bool of_corners, ConstraintSet& out) {
  const Outlines& outlines = search.outlines;
  Touch touch{search.outline, outlines.of_ground(on_ground), local, 0.0, of_corners};
  if (search.motion != nullptr) touch.gap = in_space(search.frame, local);
  const bool touches = touch.gap.gap <= most;
  const ConstraintKey key = outlines.key_of(touch.a, touch.b, touch.gap);
  if (!touches && (search.query.lasting == nullptr || !search.query.lasting->contains(key))) return false;
  // Deep in the solid a vertex may be before two faces of a chain: it is out of the nearer one first.
  const auto same = std::find_if(out.begin() + search.first, out.end(),
                                 [&](const Constraint& other) { return other.key == key; });
  if (same != out.end() && same->gap <= touch.gap.gap) return true;
  if (!touches) {
    SingleConstraint memory;
    if (!outlines.lasts(touch, search.query, memory)) return false;
  }
  Constraint& contact = same != out.end() ? *same : out.add_contact();
  contact.start_contact();
  outlines.write(touch, search.query, contact);
  return true;
}

void GroundTouches::append_pairs(const Outlines& outlines, Range bodies,
                                 std::vector<ContactPair>& out) const {
  const auto on_ground = static_cast<Index>(outlines.on_ground().outlines().size());
  for (Index i = begin_[bodies.begin]; i < begin_[bodies.end]; ++i) {
    for (Index j = 0; j < on_ground; ++j) carom::append_pairs(outlines, i, j, out);
  }
}

void GroundTouches::list_near(FunctionRef<Box<2>(Index shape)> box_in, std::vector<Index>& out) const {
  out.clear();
  for (const Family& family : families_) {
    family.grid.for_overlapping(box_in(family.shape),
                                [&](const OwnedBox<2>& piece) { out.push_back(piece.number); });
    out.insert(out.end(), family.unbounded.begin(), family.unbounded.end());
  }
  std::sort(out.begin(), out.end());
}

void append_pairs(const Outlines& outlines, Index outline, Index on_ground, std::vector<ContactPair>& out) {
  const GroundPieces& pieces = outlines.on_ground();
  const BodyOutline& a = outlines.of_bodies().list()[outline];
  const GroundOutline& b = pieces.outlines()[on_ground];
  if (!outlines.may_touch(a, b)) return;
  const Index number = outlines.of_ground(on_ground);
  const ContactPair pair{
      .body = a.body, .law = outlines.number_of_law(outline, number), .ground_shape = b.shape};
  // Of two round ends one is enough.
  const bool is_peg = b.form == GroundPiece::Form::solid && b.vertices.size() == 1;
  for (Index vertex = a.vertices.begin; vertex < a.vertices.end; ++vertex) {
    if (is_peg && a.vertices.size() > 1) break;
    out.push_back(pair);
    out.back().feature = vertex;
    out.back().outline = number;
  }
  const bool point_at_corners = a.is_point() && b.radius == 0.0 && !is_peg;
  if ((a.vertices.size() == 1 && !point_at_corners) || b.is_hollow()) return;
  for (Index vertex = b.vertices.begin; vertex < b.vertices.end; ++vertex) {
    if (!pieces.is_corner(vertex)) continue;
    out.push_back(pair);
    out.back().outline = outline;
    out.back().feature = outlines.of_ground_vertex(vertex);
  }
}

}  // namespace carom
