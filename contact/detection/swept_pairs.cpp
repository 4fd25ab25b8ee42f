// Problem: of all pairs of a model, those few that may come to touch on the way between two states.

#include <carom/contact/detection/pair_sides.h>
#include <carom/contact/detection/swept_pairs.h>
#include <carom/core/errors.h>
#include <carom/core/numerics/never.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

namespace carom {

namespace {

/// Bound of how far a body turns on a path, to and fro [rad].
double turn_of(const StatePath& path, const BodySlot& slot) {
  if (slot.v_size < 3) return 0.0;
  return std::abs(path.displacement(slot.v + 2)) + 2.0 * path.bend(slot.v + 2);
}

/// How far points of a body are off the chords of their ways at most, by turning [m].
double sagitta(double arm, double turn) {
  constexpr double of_square = 1.0 / 8.0, farthest = 2.0;
  return arm * std::min(farthest, of_square * turn * turn);
}

/// The speed with which the motion of a shape on ground may change a gap more than at the ends of a path. In
/// between it may go faster: by as much as its velocities there differ.
double change_of_ground(const GroundMotion* from, const GroundMotion* to, double reach) {
  if (from == nullptr) return 0.0;
  return std::hypot(to->velocity[0] - from->velocity[0], to->velocity[1] - from->velocity[1]) +
         std::abs(to->spin - from->spin) * reach;
}

constexpr Index spin_place = 2;  // place of the spin among the velocities of a body that turns

/// The most speed of the points of a body at a distance from its centre of mass: where the path begins or
/// ends.
double most_speed(const StatePath& path, const BodySlot& slot, double arm) {
  const auto at_end = [&](const PathSample& at) {
    const double* const v = at.state.v + slot.v;
    return std::hypot(v[0], v[1]) + (slot.v_size > spin_place ? arm * std::abs(v[spin_place]) : 0.0);
  };
  return std::max(at_end(path.begin()), at_end(path.end()));
}

/// Demands that a body is at a finite place: comparisons may drop what is no number, and a search among cells
/// of places would not end there.
void demand_finite(const StateView& state, const BodySlot& slot, Index body) {
  for (Index i = 0; i < slot.q_size; ++i) {
    const double at = state.q[slot.q + i];
    if (std::isfinite(at)) continue;
    throw ModelError("broad phase of a path: coordinate " + std::to_string(i) + " of body " +
                     std::to_string(body) + " is " + std::to_string(at) + ", must be finite");
  }
}

}  // namespace

SweptPairs::SweptPairs(const Assembly& assembly, const Detector& detector, FlatPairs flat)
    : detector_(&detector), between_bodies_(detector.outlines()) {
  list_flat(assembly, flat);
  const BodyOutlines& bodies = detector.outlines().of_bodies();
  boxes_.resize(bodies.list().size());
  for (std::vector<Vec<2>>& vertices : ends_) vertices.resize(bodies.vertices().size());
  std::vector<Index> owners;
  owners.reserve(bodies.list().size());
  for (const BodyOutline& outline : bodies.list()) owners.push_back(outline.body);
  broad_.reset(owners);
}

void SweptPairs::list_flat(const Assembly& assembly, FlatPairs which) {
  const PointContacts& points = detector_->points();
  const auto components = static_cast<Index>(assembly.components().size());
  for (Index component = 0; component < components; ++component) {
    for (const ContactPair& pair : detector_->pairs(component)) {
      if (pair.has_outline() || pair.rolling) continue;
      const bool turns = pair.joint_row == none && points.arm(pair) > 0.0;
      if (turns || which == FlatPairs::all) flat_.push_back(pair);
    }
  }
  const auto name = [](const ContactPair& of) { return std::tuple(of.body, of.ground_shape, of.joint_row); };
  std::stable_sort(flat_.begin(), flat_.end(),
                   [&](const ContactPair& a, const ContactPair& b) { return name(a) < name(b); });
  for (Index i = 0; i < flat_.size(); ++i) {
    if (i == 0 || name(flat_[i - 1]) != name(flat_[i])) flat_groups_.push_back({{i, i}});
    FlatGroup& group = flat_groups_.back();
    group.pairs.end = i + 1;
    if (flat_[i].joint_row != none) continue;
    group.arm = std::max(group.arm, points.arm(flat_[i]));
    group.reach = std::max(group.reach, points.arm(flat_[i]) + points.radius(flat_[i]));
  }
}

/// False where the centre of mass is so far from a shape that none of its points comes to it on a path.
bool SweptPairs::may_close(const StatePath& path, const FlatGroup& group) const {
  const ContactPair& of = flat_[group.pairs.begin];
  if (of.joint_row != none || moves(*detector_, of)) return true;
  const BodySlot slot = detector_->outlines().slots()[of.body];
  const double* const centre = path.begin().state.q + slot.q;
  const Gap gap = detector_->outlines().shapes().gap(of.ground_shape, nullptr, centre);
  return !(gap.distance - group.reach > path.length() * most_speed(path, slot, group.arm));
}

/// Vertices of all outlines of bodies at both ends of a path.
void SweptPairs::place(const StatePath& path, const ChosenBodies& bodies) {
  const Outlines& outlines = detector_->outlines();
  for (const BodyOutline& outline : outlines.of_bodies().list()) {
    if (!bodies.has(outline.body)) continue;
    const BodySlot slot = outlines.slots()[outline.body];
    for (std::size_t end = 0; end < ends_.size(); ++end) {
      const PathSample at = end == 0 ? path.begin() : path.end();
      demand_finite(at.state, slot, outline.body);
      outlines.of_bodies().place(outline, slot, at.state, at.evaluation,
                                 ends_[end].data() + outline.vertices.begin);
    }
  }
}

/// Box around all that an outline of a body sweeps on a path.
Box<2> SweptPairs::box_of(const StatePath& path, Index outline) const {
  const BodyOutline& of = detector_->outlines().of_bodies().list()[outline];
  const BodySlot slot = detector_->outlines().slots()[of.body];
  const double wider =
      of.radius + sagitta(of.reach, turn_of(path, slot)) + std::max(path.bend(slot.v), path.bend(slot.v + 1));
  // Places of vertices are sums of that of the centre and an arm, whose ways have boxes of their own.
  Box<2> box;
  for (Index k = 0; k < 2; ++k) {
    const std::array<double, 2> centre{path.begin().state.q[slot.q + k], path.end().state.q[slot.q + k]};
    double least = never, most = -never;
    for (Index vertex = of.vertices.begin; vertex < of.vertices.end; ++vertex) {
      for (std::size_t end = 0; end < ends_.size(); ++end) {
        const double arm = ends_[end][vertex][k] - centre[end];
        least = std::min(least, arm);
        most = std::max(most, arm);
      }
    }
    box.min[k] = std::min(centre[0], centre[1]) + least - wider;
    box.max[k] = std::max(centre[0], centre[1]) + most + wider;
  }
  return box;
}

/// Box around all that an outline of a body sweeps in the frame of a shape on ground that moves: around both
/// ends, wider by half of the longest way between them.
Box<2> SweptPairs::box_in(const StatePath& path, Index outline, Index shape) const {
  if (shape == none) return boxes_[outline];
  const Outlines& outlines = detector_->outlines();
  const BodyOutline& of = outlines.of_bodies().list()[outline];
  const BodySlot slot = outlines.slots()[of.body];
  double fastest = 0.0;
  std::array<const GroundMotion*, 2> motions{};
  Box<2> box = Box<2>::none();
  double reach = 0.0;
  for (std::size_t end = 0; end < ends_.size(); ++end) {
    const PathSample at = end == 0 ? path.begin() : path.end();
    const GroundMotion& motion = *outlines.shapes().motion(shape, at.places);
    motions[end] = &motion;
    const PlaneFrame frame(&motion);
    for (Index vertex = of.vertices.begin; vertex < of.vertices.end; ++vertex) {
      const Vec<2> inside = frame.inside(ends_[end][vertex]);
      box.min = box.min.cwiseMin(inside);
      box.max = box.max.cwiseMax(inside);
    }
    reach = std::max(
        reach, Vec<2>(Vec<2>(at.state.q[slot.q], at.state.q[slot.q + 1]) - frame.centre).norm() + of.reach);
    double speed = std::hypot(at.state.v[slot.v], at.state.v[slot.v + 1]);
    if (slot.v_size > 2) speed += std::abs(at.state.v[slot.v + 2]) * of.reach;
    speed += std::hypot(motion.velocity[0], motion.velocity[1]) + std::abs(motion.spin) * reach;
    fastest = std::max(fastest, speed);
  }
  fastest += change_of_ground(motions[0], motions[1], reach);
  const double wider = of.radius + 0.5 * path.length() * fastest;
  box.min.array() -= wider;
  box.max.array() += wider;
  return box;
}

/// Bound of the rate of the gap of a pair with an outline on a path: velocities change evenly on it, so that
/// speeds are largest at its ends.
double SweptPairs::fastest(const StatePath& path, const SweptPair& of) const {
  const PathSample from = path.begin(), to = path.end();
  const GroundMotion* const first = motion_of(*detector_, of.pair, from.places);
  const GroundMotion* const last = motion_of(*detector_, of.pair, to.places);
  return std::max(of.bound.most_speed(from.state.v, first), of.bound.most_speed(to.state.v, last)) +
         change_of_ground(first, last, of.bound.reach);
}

/// Bounds of the gap of a point of a body and a shape on ground. Of a limit of a joint nothing is known.
void SweptPairs::bound_point(const StatePath& path, SweptPair& of) const {
  of.fastest = never;
  of.sixth = 0.0;
  if (of.pair.joint_row != none || moves(*detector_, of.pair)) return;
  const BodySlot slot = detector_->outlines().slots()[of.pair.body];
  const double arm = slot.v_size > spin_place ? detector_->points().arm(of.pair) : 0.0;
  of.fastest = most_speed(path, slot, arm);
  if (arm == 0.0) return;
  constexpr int order = 6;
  const double spin = std::max(std::abs(path.begin().state.v[slot.v + spin_place]),
                               std::abs(path.end().state.v[slot.v + spin_place]));
  of.sixth = arm * std::pow(spin, order);
}

/// Adds a pair unless a bound excludes that it closes on a path.
void SweptPairs::add(const StatePath& path, const ContactPair& pair, const NearOutlines& outlines) {
  const PathSample from = path.begin();
  SweptPair of;
  of.pair = pair;
  of.outlines = outlines;
  if (pair.has_outline()) {
    of.bound = bound_of_pair(detector_->outlines(), pair);
    if (!of.bound.closes_alone()) return;
    of.fastest = fastest(path, of);
    const double least = of.bound.least_gap(from.state, motion_of(*detector_, pair, from.places));
    if (least > path.length() * of.fastest) return;
  }
  detector_->contact(pair, from.state, from.evaluation, from.places, contact_);
  if (!pair.has_outline()) bound_point(path, of);
  of.gap = contact_.gap;
  if (of.gap > path.length() * of.fastest) return;
  of.key = contact_.key;
  for (int b = 0; b < contact_.bodies; ++b) {
    of.bodies[of.body_count++] = contact_.blocks[static_cast<std::size_t>(b)].body;
  }
  list_.push_back(of);
}

std::span<const Box<2>> SweptPairs::sweep(const StatePath& path, const ChosenBodies& bodies) {
  const std::vector<BodyOutline>& list = detector_->outlines().of_bodies().list();
  place(path, bodies);
  for (Index i = 0; i < boxes_.size(); ++i) {
    if (bodies.has(list[i].body)) boxes_[i] = box_of(path, i);
  }
  return boxes_;
}

std::span<const NearOutlines> SweptPairs::find_outlines(const StatePath& path, const ChosenBodies& bodies) {
  const Outlines& outlines = detector_->outlines();
  outlines_.clear();
  if (!outlines.bodies_touch() && !outlines.ground_touches()) return outlines_;
  static_cast<void>(sweep(path, bodies));
  const auto count = static_cast<Index>(boxes_.size());
  const std::vector<BodyOutline>& list = outlines.of_bodies().list();
  const GroundPieces& pieces = outlines.on_ground();
  for (Index i = 0; outlines.ground_touches() && i < count; ++i) {
    if (!bodies.has(list[i].body)) continue;
    const auto box = [&](Index shape) { return box_in(path, i, shape); };
    detector_->on_ground().list_near(box, near_);
    for (const Index piece : near_) {
      if (!outlines.may_touch(list[i], pieces.outlines()[pieces.outline(piece)])) continue;
      outlines_.push_back({.a = i, .piece = piece});
    }
  }
  if (!outlines.bodies_touch()) return outlines_;
  for (const BoxPair& near : broad_.update(boxes_)) {
    const BodyOutline &a = list[near.first], &b = list[near.second];
    if (bodies.has(a.body) && bodies.has(b.body) && outlines.laws().may_touch(a, b))
      outlines_.push_back({.a = near.first, .b = near.second});
  }
  return outlines_;
}

std::span<const SweptPair> SweptPairs::find_pairs(const StatePath& path,
                                                  FunctionRef<bool(const ContactPair&)> looks) {
  const Outlines& outlines = detector_->outlines();
  list_.clear();
  for (const FlatGroup& group : flat_groups_) {
    if (!may_close(path, group)) continue;
    for (Index i = group.pairs.begin; i < group.pairs.end; ++i) {
      if (looks(flat_[i])) add(path, flat_[i], {});
    }
  }
  const NearOutlines* last = nullptr;
  for (const NearOutlines& near : outlines_) {
    candidates_.clear();
    if (near.piece == none) {
      between_bodies_.append_between(near.a, near.b, candidates_);
    } else {
      // Pieces of one outline follow one another.
      const GroundPieces& pieces = outlines.on_ground();
      const Index on_ground = pieces.outline(near.piece);
      const bool again = last != nullptr && last->piece != none && last->a == near.a &&
                         pieces.outline(last->piece) == on_ground;
      last = &near;
      if (again) continue;
      append_pairs(outlines, near.a, on_ground, candidates_);
    }
    for (const ContactPair& pair : candidates_) {
      if (looks(pair)) add(path, pair, near);
    }
  }
  return list_;
}

}  // namespace carom
