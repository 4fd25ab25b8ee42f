// Problem: end a step before something is so deep in a thin thing that it would leave it on the far side.

#include <carom/contact/detection/convex_outline.h>
#include <carom/integrators/time_stepping/gap_rounding.h>
#include <carom/integrators/time_stepping/passage_search.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace carom {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
// Share of the radii of the circles in both that a pair may come deep.
constexpr double deep = 1.0 / 8.0;

/// Radius of a circle in a convex set: a third of its width (W. Blaschke, Kreis und Kugel, 1916), and what
/// widens it.
double circle_in(const ConvexOutline& of) {
  constexpr Index polygon = 3;
  double width = of.size() < polygon ? 0.0 : infinite;
  for (Index i = 0; i < of.size() && of.size() >= polygon; ++i) {
    const OutlineEdge edge(of, i);
    double height = 0.0;
    for (const Vec<2>& vertex : of.vertices) height = std::max(height, -edge.height(vertex));
    width = std::min(width, height);
  }
  return of.radius + width / 3.0;
}

/// Nothing leaves ground without a far side (the outside of a box or of a circle), but it may end a step far
/// outside. Where all passages are looked for it adds no thickness: how deep a body may come in it depends on
/// the body alone. Else it is left out; a hill of any depth is as thick as what its corners hold.
double circle_in(const GroundPieces& pieces, Index outline, Passages which) {
  const GroundOutline& of = pieces.outlines()[outline];
  const double of_no_far_side = which == Passages::all ? 0.0 : infinite;
  if (of.is_hollow()) return of_no_far_side;
  if (!of.is_chain()) return circle_in(pieces.view(outline));
  if (std::isfinite(of.depth)) return 0.5 * of.depth;
  if (which == Passages::all) return 0.0;
  const double hill = circle_in(pieces.view(outline));
  return hill > 0.0 ? hill : infinite;
}

}  // namespace

PassageSearch::PassageSearch(const Assembly& assembly, const Detector& detector, const TimeStepping& options,
                             Passages which)
    : look_(assembly, detector),
      which_(which),
      least_depth_(1e3 * gap_rounding(assembly, options)),
      at_(assembly.initial_state()) {
  reach_.assign(assembly.layout()->bodies().size(), 0.0);
  displacement_.resize(at_.v.size());
  const BodyOutlines& bodies = detector.outlines().of_bodies();
  for (const BodyOutline& outline : bodies.list()) {
    add(outline.key, {circle_in(bodies.described(outline)), false});
    // Only the vertices turn: the radius around them is the same on all sides.
    reach_[outline.body] = std::max(reach_[outline.body], outline.reach - outline.radius);
  }
  const GroundPieces& pieces = detector.outlines().on_ground();
  for (Index i = 0; detector.outlines().ground_touches() && i < pieces.outlines().size(); ++i) {
    const GroundOutline& of = pieces.outlines()[i];
    add(of.key, {circle_in(pieces, i, which), of.is_hollow()});
  }
  set_thinnest();
}

void PassageSearch::add(const FeatureKey& key, const Thickness& thickness) {
  thickness_.emplace(key, thickness);
}

/// Less than any pair may come deep: twice the thinnest of bodies that touch each other, or that and the
/// thinnest ground.
void PassageSearch::set_thinnest() {
  double body = infinite, any = infinite;
  for (const auto& [key, thickness] : thickness_) {
    const bool is_ground = key.owner == FeatureKey::Owner::obstacle;
    if (is_ground || look_.detector().bodies_touch()) any = std::min(any, thickness.circle);
    if (!is_ground) body = std::min(body, thickness.circle);
  }
  thinnest_ = std::max(least_depth_, deep * (body + any));
}

/// The outline that a feature is of; the end where it is one without pieces (half-planes).
PassageSearch::Thicknesses::const_iterator PassageSearch::outline(const FeatureKey& key) const {
  const auto behind = thickness_.upper_bound(key);
  if (behind == thickness_.begin()) return thickness_.end();
  const auto found = std::prev(behind);
  const bool same = found->first.owner == key.owner && found->first.serial == key.serial;
  return same ? found : thickness_.end();
}

PassageSearch::Pair PassageSearch::pair_of(const Constraint& contact) const {
  return {outline(contact.key.a)->first, outline(contact.key.b)->first};
}

/// How deep the pair of a contact may come; infinite of what cannot be passed [m].
double PassageSearch::allowed(const Constraint& contact) const {
  if (contact.type != ConstraintType::contact) return infinite;
  const auto a = outline(contact.key.a), b = outline(contact.key.b);
  if (a == thickness_.end() || b == thickness_.end()) return infinite;
  return std::max(least_depth_, deep * (a->second.circle + b->second.circle));
}

/// How much nearer the pair of a contact may come along a row over a whole step, but for turning [m].
double PassageSearch::approach_along(const Constraint& contact, int i) const {
  constexpr double caution = 2.0;  // in between ground may go faster than it does now and at the end
  const auto at = static_cast<std::size_t>(i);
  const double speed = contact.surface_velocity[at], change = contact.surface_velocity_after[at] - speed;
  double sum = (speed + caution * std::abs(change)) * step_;
  const double* row = contact.row(i);
  for (int b = 0; b < contact.bodies; ++b) {
    const Constraint::Block& block = contact.blocks[static_cast<std::size_t>(b)];
    sum -= row[0] * displacement_[block.v] + row[1] * displacement_[block.v + 1];
    row += block.columns;
  }
  return sum;
}

/// How much nearer the pair of a contact may come over a whole step [m]: convex things along their normal;
/// what is inside a circle comes nearer to it by going along it, too.
double PassageSearch::approach(const Constraint& contact) const {
  double sum = approach_along(contact, 0);
  if (outline(contact.key.b)->second.is_hollow) sum = std::hypot(sum, approach_along(contact, 1));
  return sum + turning(contact);
}

/// How much nearer it may come by turning [m].
double PassageSearch::turning(const Constraint& contact) const {
  double sum = 0.0;
  for (int b = 0; b < contact.bodies; ++b) {
    const Constraint::Block& block = contact.blocks[static_cast<std::size_t>(b)];
    constexpr int turning = 3;
    if (block.columns == turning) sum += reach_[block.body] * std::abs(displacement_[block.v + 2]);
  }
  return sum;
}

/// Takes the displacements of a step. Returns how much nearer any two things may come in it [m].
double PassageSearch::most_approach(const State& start, const State& end) {
  double most = 0.0;
  Index body = 0;
  for (const BodySlot& slot : look_.assembly().layout()->bodies()) {
    // Coordinates and velocities of the plane correspond one to one.
    for (Index i = 0; i < slot.v_size; ++i) {
      displacement_[slot.v + i] = end.q[slot.q + i] - start.q[slot.q + i];
    }
    double moved = std::hypot(displacement_[slot.v], displacement_[slot.v + 1]);
    if (slot.v_size > 2) moved += reach_[body] * std::abs(displacement_[slot.v + 2]);
    most = std::max(most, moved);
    ++body;
  }
  most *= 2.0;
  if (!look_.detector().has_moving_ground()) return most;
  // Of ground twice what its speed at either end makes of it.
  double fastest = 0.0;
  const GroundPieces& pieces = look_.detector().outlines().on_ground();
  for (const GroundOutline& outline : pieces.outlines()) {
    if (!look_.detector().outlines().shapes().moves(outline.shape)) continue;
    for (const double time : {start.time, end.time}) {
      const GroundMotion motion = look_.detector().outlines().shapes().motion(outline.shape, time);
      fastest = std::max(fastest, std::hypot(motion.velocity[0], motion.velocity[1]) +
                                      outline.reach * std::abs(motion.spin));
    }
  }
  return most + 2.0 * step_ * fastest;
}

/// Finds what is near at a share of the step.
void PassageSearch::look(const State& start, double share) {
  at_.time = start.time + share * step_;
  for (const BodySlot& slot : look_.assembly().layout()->bodies()) {
    for (Index i = 0; i < slot.v_size; ++i) {
      at_.q[slot.q + i] = start.q[slot.q + i] + share * displacement_[slot.v + i];
    }
  }
  look_.find(at_.view(), margin_, contacts_, &places_at_end_);
  contacts_.remove_if([&](const Constraint& contact) { return allowed(contact) == infinite; });
}

/// Keeps the depths of pairs that overlap at the start, each with its deepest contact first.
void PassageSearch::keep_depths() {
  at_start_.clear();
  for (const Constraint& contact : contacts_) {
    if (contact.gap < 0.0) at_start_.emplace_back(pair_of(contact), -contact.gap);
  }
  std::sort(at_start_.begin(), at_start_.end(), [](const auto& a, const auto& b) {
    return a.first < b.first || (a.first == b.first && a.second > b.second);
  });
}

double PassageSearch::depth_at_start(const Constraint& contact) const {
  const Pair pair = pair_of(contact);
  const auto before = [](const auto& known, const Pair& of) { return known.first < of; };
  const auto known = std::lower_bound(at_start_.begin(), at_start_.end(), pair, before);
  return known != at_start_.end() && known->first == pair ? known->second : 0.0;
}

/// How far a pair may go before it is looked at again although it is near [m].
double PassageSearch::stride(const Constraint& contact, double most_deep) const {
  if (which_ == Passages::all) return 0.5 * most_deep;
  // What passes through another thing is in it for at least the radii of the circles in both. What does not
  // turn comes to it by the way that is known.
  constexpr double parts = 64.0;
  const double turns = turning(contact);
  if (turns == 0.0) return 0.5 * most_deep;
  const double circles = outline(contact.key.a)->second.circle + outline(contact.key.b)->second.circle;
  return std::max(circles, turns / parts);
}

PassageSearch::Passage PassageSearch::first(const State& start, const State& end, StepFlights& flights) {
  if (!finds_any()) return {};
  knows_depths_ = false;
  if (flights.empty()) return first_on_chord(start, end, start);
  const std::size_t corners = flights.write_way(start, end, way_);
  for (std::size_t i = 1; i < corners; ++i) {
    const Passage found = first_on_chord(way_[i - 1], way_[i], start);
    if (!std::isinf(found.time)) return found;
  }
  return {};
}

/// First passage on a part of the way on which all positions change evenly. \param begin of the whole way
PassageSearch::Passage PassageSearch::first_on_chord(const State& start, const State& end,
                                                     const State& begin) {
  step_ = end.time - start.time;
  const double most = most_approach(start, end);
  if (!(most > thinnest_)) return {};
  at_.v = start.v;
  look_.detector().place(end.time, places_at_end_);
  margin_ = most;
  if (!knows_depths_) {
    look(begin, 0.0);
    keep_depths();
  }
  if (knows_depths_ || &begin != &start) look(start, 0.0);
  knows_depths_ = true;
  // Where looks may be far apart one as deep as it may come is not to be missed by rounding.
  const double enough = which_ == Passages::all ? 0.0 : 0.5;
  for (double share = 0.0;;) {
    double next = 2.0;
    for (const Constraint& contact : contacts_) {
      const double most_deep = allowed(contact);
      const double left = contact.gap + most_deep + depth_at_start(contact);
      if (!(left > enough * most_deep))
        return {share < 1.0 ? start.time + share * step_ : end.time, contact.key};
      const double nearer = approach(contact);
      if (!(nearer > 0.0)) continue;
      next = std::min(next, share + std::max(left, stride(contact, most_deep)) / nearer);
    }
    if (!(next < 1.0)) return {};
    share = next;
    margin_ = most * (1.0 - share);
    look(start, share);
  }
}

}  // namespace carom
