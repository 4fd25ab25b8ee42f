// Problem: which of many pieces of the ground a body touches, where, and by which law.

#include <carom/contact/detection/contacts_of_two.h>
#include <carom/contact/detection/corner_meeting.h>
#include <carom/contact/detection/feature_margin.h>
#include <carom/contact/detection/gap_convex.h>
#include <carom/contact/detection/pair_rows.h>
#include <carom/contact/detection/piece_contacts.h>
#include <carom/contact/detection/short_list.h>
#include <carom/core/system.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace carom {

struct PieceContacts::Search {
  const ContactQuery& query;
  const BodyOutline& outline;
  ConvexOutline placed;  // in the frame of the family
  const GroundMotion* motion;
  PlaneFrame frame;  // of the family
  PlaneFrame of_body;
  double margin;      // of gaps, those of lasting contacts included
  std::size_t first;  // contact of the outline
};

PieceContacts::PieceContacts(const Assembly& assembly, const FeatureLengths& lengths)
    : assembly_(&assembly), shapes_(assembly.system()), pieces_(assembly.system(), shapes_, lengths) {
  if (pieces_.size() == 0 || assembly.layout()->dimension() != 2) return;
  outlines_ = BodyOutlines(assembly);
  const auto bodies = static_cast<Index>(assembly.layout()->bodies().size());
  for (Index body = 0, next = 0; body <= bodies; ++body) {
    while (next < outlines_.list().size() && outlines_.list()[next].body < body) ++next;
    begin_.push_back(next);
  }
  find_laws();
  fill_families();
  covering_ = CoveringGround(shapes_, pieces_);
}

void PieceContacts::find_laws() {
  const System& system = assembly_->system();
  laws_.resize(outlines_.materials().size() * shapes_.size());
  for (const BodyOutline& outline : outlines_.list()) {
    for (Index shape = 0; shape < shapes_.size(); ++shape) {
      if (!shapes_.has_pieces(shape) || !carom::may_touch(outline.filter, shapes_.filter(shape))) continue;
      const auto law = system.law(outlines_.materials()[outline.material], shapes_.id(shape));
      if (law) laws_[outline.material * shapes_.size() + shape] = *law;
    }
  }
}

/// Pieces at rest are one family, however many shapes they are of.
void PieceContacts::fill_families() {
  std::vector<std::vector<OwnedBox<2>>> boxes;
  std::vector<Index> family_of(shapes_.size(), none);
  Index at_rest = none;
  for (Index piece = 0; piece < pieces_.size(); ++piece) {
    const Index shape = pieces_.shape(piece);
    Index& family = shapes_.moves(shape) ? family_of[shape] : at_rest;
    if (family == none) {
      family = static_cast<Index>(families_.size());
      families_.emplace_back().shape = shapes_.moves(shape) ? shape : none;
      boxes.emplace_back();
    }
    if (!pieces_.is_bounded(piece)) {
      families_[family].unbounded.push_back(piece);
      continue;
    }
    const Box<2> box = pieces_.box(piece);
    boxes[family].push_back({box, piece, none});
    const double reach = box.min.cwiseAbs().cwiseMax(box.max.cwiseAbs()).norm();
    families_[family].reach = std::max(families_[family].reach, reach);
  }
  for (std::size_t i = 0; i < families_.size(); ++i) families_[i].grid.build(boxes[i]);
}

bool PieceContacts::may_touch(const BodyOutline& a, const GroundOutline& b) const {
  return carom::may_touch(a.filter, shapes_.filter(b.shape));
}

ConstraintKey PieceContacts::key_of(const BodyOutline& a, const GroundOutline& b, const GapPoint& gap) {
  return b.is_hollow() ? ConstraintKey{a.vertex(gap.feature_a), b.surface()} : carom::key_of(a, b, gap);
}

void PieceContacts::find(Index component, const ContactQuery& query, ConstraintSet& out) const {
  const Range bodies = assembly_->bodies_of({component, component + 1});
  for (Index body = bodies.begin; body < bodies.end; ++body) find_of(body, query, out);
}

void PieceContacts::find_of(Index body, const ContactQuery& query, ConstraintSet& out) const {
  const Range own = outlines_of(body);
  for (Index i = own.begin; i < own.end; ++i) {
    for (const Family& family : families_) find_in(family, outlines_.list()[i], query, out);
  }
}

/// Looks up the pieces of a family near an outline.
void PieceContacts::find_in(const Family& family, const BodyOutline& outline, const ContactQuery& query,
                            ConstraintSet& out) const {
  const BodySlot& body = assembly_->layout()->bodies()[outline.body];
  Search search{query, outline, {}, nullptr, {}, {}, query.margin, out.size()};
  if (family.shape != none) search.motion = shapes_.motion(family.shape, query.places);
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
  outlines_.place(outline, body, query.state, query.evaluation, vertices.all().data());
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

void PieceContacts::find_piece(Index piece, const Search& search, ConstraintSet& out) const {
  const Index on_ground = pieces_.outline(piece);
  const BodyOutline& a = search.outline;
  const GroundOutline& b = pieces_.outlines()[on_ground];
  if (!may_touch(a, b)) return;
  std::array<GapPoint, 2> found;
  const int count = pieces_.find(piece, search.placed, search.margin, found);
  if (count == 0) return;
  const auto corners_near = [&](const GapPoint& gap) { return meeting_near(search, on_ground, gap); };
  const auto have_one_name = [&](const GapPoint& one, const GapPoint& other) {
    return key_of(a, b, one) == key_of(a, b, other);
  };
  const auto add_one = [&](const GapPoint& gap, bool of_corners, TwoOutlines::Adds adds) {
    const bool anyway = adds == TwoOutlines::Adds::anyway;
    const double most = anyway ? std::numeric_limits<double>::infinity() : search.query.margin;
    return add(search, on_ground, gap, most, of_corners, out);
  };
  list_contacts({found.data(), static_cast<std::size_t>(count)},
                {corners_near, have_one_name, add_one, pieces_.lengths().corner});
}

/// The corners nearest to where a sharp outline of a body touches one of the ground; nothing where no two are
/// near.
std::optional<CornerMeeting> PieceContacts::meeting_near(const Search& search, Index on_ground,
                                                         const GapPoint& first) const {
  const GroundOutline& b = pieces_.outlines()[on_ground];
  const ConvexOutline &of_a = search.placed, of_b = pieces_.view(on_ground);
  const double same_place = pieces_.lengths().corner;
  if (b.is_hollow() || of_a.radius + b.radius > 0.0 || !is_near_corner(first, same_place)) return {};
  const auto [i, j] = nearest_corners(of_a, of_b, first);
  if (!pieces_.is_corner(b.vertices.begin + j)) return {};
  CornerMeeting meeting{SharpCorner::of(of_a, i), corner_of(pieces_, on_ground, j), same_place};
  const BodyOutline& a = search.outline;
  const LastingContacts* const lasting = search.query.lasting;
  meeting.lasts = lasting != nullptr && lasting->contains({a.vertex(i), b.surface()}) &&
                  lasting->contains({a.surface(), b.vertex(j)});
  const PlaneFrame &body = search.of_body, &frame = search.frame;
  const Vec<2> at_a = frame.outside(meeting.a.at), at_b = frame.outside(meeting.b.at);
  meeting.velocity = frame.turned_back(
      Vec<2>(body.velocity_at(Vec<2>(at_a - body.centre)) - frame.velocity_at(Vec<2>(at_b - frame.centre))));
  SharpCorner in_space = meeting.b;
  for (Vec<2>* point : {&in_space.before, &in_space.at, &in_space.behind}) *point = frame.outside(*point);
  meeting.b.hidden = covering_.side(in_space, b.shape, a.filter, search.query.places, shapes_, pieces_);
  return meeting;
}

/// Appends a contact that is closed, or was and may still be. \param local its gap, in the frame of the
/// family \param most largest gap of what is closed [m] \param of_corners whether it is one of the two of
/// corners that meet
bool PieceContacts::add(const Search& search, Index on_ground, const GapPoint& local, double most,
                        bool of_corners, ConstraintSet& out) const {
  const ContactQuery& query = search.query;
  const GapPoint gap = search.motion == nullptr ? local : in_space(search.frame, local);
  const bool touches = gap.gap <= most;
  const ConstraintKey key = key_of(search.outline, pieces_.outlines()[on_ground], gap);
  if (!touches && (query.lasting == nullptr || !query.lasting->contains(key))) return false;
  // Deep in the solid a vertex may be before two faces of a chain: it is out of the nearer one first.
  const auto same = std::find_if(out.begin() + search.first, out.end(),
                                 [&](const Constraint& other) { return other.key == key; });
  if (same != out.end() && same->gap <= gap.gap) return true;
  const Index shape = pieces_.outlines()[on_ground].shape;
  const GroundAtEnd end = search.motion == nullptr ? GroundAtEnd{} : query.end_of(shapes_, shape);
  SingleConstraint contact;
  fill(key, search.outline, on_ground, gap, query.state, search.motion, end, contact);
  if (!touches) {
    if (!query.lasting->lasts(key, gap.gap, std::abs(contact.drift[0]), of_corners)) return false;
    contact.allowed_approach = gap.gap / query.lasting->step();
  }
  (same != out.end() ? *same : out.add()).take(contact);
  return true;
}

void PieceContacts::fill(const ConstraintKey& key, const BodyOutline& a, Index on_ground, const GapPoint& gap,
                         const StateView& state, const GroundMotion* motion, const GroundAtEnd& end,
                         Constraint& out) const {
  const BodySlot& body = assembly_->layout()->bodies()[a.body];
  out.key = key;
  out.law = laws_[a.material * shapes_.size() + pieces_.outlines()[on_ground].shape];
  out.friction = out.law.friction;
  const PairSide side = PairSide::of_body(body, a.body, a.radius, state),
                 ground = pieces_.side(on_ground, motion);
  fill_pair_rows(side, ground, gap, out);
  if (motion != nullptr && end.motion != nullptr)
    add_motion_after(side, ground, gap, *motion, *end.motion, end.step, out);
  if (out.law.has_static_friction()) out.friction = out.law.friction_at(out.sliding_speed(state.v));
}

std::optional<ContactPair> PieceContacts::pair_of(const ConstraintKey& key) const {
  if (key.b.owner != FeatureKey::Owner::obstacle || empty()) return {};
  const Index a = outlines_.find(key.a), b = pieces_.outline_of(key.b);
  if (a == none || b == none) return {};
  const BodyOutline& of_body = outlines_.list()[a];
  const GroundOutline& on_ground = pieces_.outlines()[b];
  ContactPair pair{.body = of_body.body, .ground_shape = on_ground.shape};
  if (key.b == on_ground.surface()) {
    pair.feature = of_body.place(key.a);
    pair.ground_outline = b;
  } else {
    pair.outline = a;
    pair.ground_vertex = on_ground.place(key.b);
  }
  return pair;
}

/// The outline of the body of a pair, and that on ground.
PieceContacts::Sides PieceContacts::sides_of(const ContactPair& pair) const {
  if (pair.ground_outline == none)
    return {outlines_.list()[pair.outline], pieces_.outline_of(pair.ground_vertex)};
  return {outlines_.list()[outlines_.outline_of(pair.feature)], pair.ground_outline};
}

const Surface& PieceContacts::law(const ContactPair& pair) const {
  return laws_[sides_of(pair).body.material * shapes_.size() + pair.ground_shape];
}

PairSides PieceContacts::sides(const ContactPair& pair, const StateView& state, const Evaluation& evaluation,
                               const GroundPlaces& places) const {
  const auto [a, on_ground] = sides_of(pair);
  const GroundOutline& b = pieces_.outlines()[on_ground];
  const BodySlot& body = assembly_->layout()->bodies()[a.body];
  const PairSide of_body = PairSide::of_body(body, a.body, a.radius, state);
  const PairSide of_ground = pieces_.side(on_ground, shapes_.motion(pair.ground_shape, places));
  const bool is_of_body = pair.ground_outline != none;
  PairSides out{.at = outline_pair(pair, state, evaluation, places),
                .of_vertex = is_of_body ? of_body : of_ground,
                .of_outline = is_of_body ? of_ground : of_body,
                .vertex = is_of_body ? a.vertex(pair.feature - a.vertices.begin)
                                     : b.vertex(pair.ground_vertex - b.vertices.begin),
                .surface = is_of_body ? b.surface() : a.surface(),
                .law = &law(pair),
                .vertex_is_first = is_of_body};
  if (is_of_body && b.is_chain()) {
    out.pieces = &pieces_;
    out.chain = on_ground;
  }
  return out;
}

}  // namespace carom
