// Problem: no depth on a path is missed, whatever its sides do between two looks.

#include <carom/contact/detection/narrow_phase.h>
#include <carom/contact/detection/outline_depth.h>
#include <carom/contact/detection/pair_sides.h>
#include <carom/core/numerics/never.h>

#include <algorithm>
#include <cmath>

namespace carom {

namespace {

/// Rate at which the vertices of an outline of a body come nearer to anything by turning, at most [m/s].
double turning(const BodyOutline& outline, const BodySlot& slot, const PathSample& at) {
  // The radius around the vertices is the same on all sides.
  return slot.v_size > 2 ? (outline.reach - outline.radius) * std::abs(at.state.v[slot.v + 2]) : 0.0;
}

Vec<2> velocity_of(const BodySlot& slot, const PathSample& at) {
  return {at.state.v[slot.v], at.state.v[slot.v + 1]};
}

}  // namespace

/// Where two outlines are nearest to each other; of a piece that moves, in its frame.
std::optional<GapPoint> OutlineDepth::look(const NearOutlines& of, const PathSample& at) {
  const Outlines& outlines = detector_->outlines();
  const BodyOutlines& bodies = outlines.of_bodies();
  constexpr double any = never;
  std::array<GapPoint, 2> found;
  const auto place = [&](Index outline, std::vector<Vec<2>>& out) -> ConvexOutline {
    const BodyOutline& body = bodies.list()[outline];
    out.resize(body.vertices.size());
    bodies.place(body, outlines.slots()[body.body], at.state, at.evaluation, out.data());
    return {out, body.radius};
  };
  const ConvexOutline a = place(of.a, placed_[0]);
  if (of.piece == none) {
    const ConvexOutline b = place(of.b, placed_[1]);
    if (find_gaps(a, b, any, found) == 0) return {};
    return found[0];
  }
  const GroundPieces& pieces = outlines.on_ground();
  const GroundMotion* const motion = outlines.shapes().motion(pieces.shape(of.piece), at.places);
  if (motion == nullptr) {
    if (pieces.find(of.piece, a, any, found) == 0) return {};
    return found[0];
  }
  const PlaneFrame frame(motion);
  for (Vec<2>& vertex : placed_[0]) vertex = frame.inside(vertex);
  if (pieces.find(of.piece, a, any, found) == 0) return {};
  return in_space(frame, found[0]);
}

/// Rate at which two outlines come nearer to each other along a normal, at most [m/s].
double OutlineDepth::approach(const StatePath& path, const NearOutlines& of, const Vec<2>& normal) const {
  const Outlines& outlines = detector_->outlines();
  const BodyOutline& a = outlines.of_bodies().list()[of.a];
  const BodySlot body = outlines.slots()[a.body];
  double most = 0.0;
  Vec<2> first = Vec<2>::Zero(), last = Vec<2>::Zero();  // velocities of ground
  double change = 0.0;
  for (const bool at_begin : {true, false}) {
    const PathSample at = at_begin ? path.begin() : path.end();
    Vec<2> apart = velocity_of(body, at);
    double rate = turning(a, body, at);
    bool is_hollow = false;
    if (of.piece == none) {
      const BodyOutline& b = outlines.of_bodies().list()[of.b];
      const BodySlot other = outlines.slots()[b.body];
      apart -= velocity_of(other, at);
      rate += turning(b, other, at);
    } else {
      const GroundPieces& pieces = outlines.on_ground();
      const GroundOutline& b = pieces.outlines()[pieces.outline(of.piece)];
      is_hollow = b.is_hollow();
      if (const GroundMotion* const motion = outlines.shapes().motion(b.shape, at.places);
          motion != nullptr) {
        const Vec<2> velocity(motion->velocity[0], motion->velocity[1]);
        apart -= velocity;
        rate += b.reach * std::abs(motion->spin);
        (at_begin ? first : last) = velocity;
        change += (at_begin ? -1.0 : 1.0) * b.reach * motion->spin;
      }
    }
    rate += is_hollow ? apart.norm() : std::max(0.0, -normal.dot(apart));
    most = std::max(most, rate);
  }
  // In between ground may go faster than at the ends, by as much as these differ.
  return most + (last - first).norm() + std::abs(change);
}

double OutlineDepth::gap_at_begin(const StatePath& path, const NearOutlines& of) {
  const std::optional<GapPoint> found = look(of, path.begin());
  return found ? found->gap : never;
}

double OutlineDepth::gap_at_end(const StatePath& path, const NearOutlines& of) {
  const std::optional<GapPoint> found = look(of, path.end());
  return found ? found->gap : never;
}

ConstraintKey OutlineDepth::key_at_begin(const StatePath& path, const NearOutlines& of) {
  const Outlines& outlines = detector_->outlines();
  const GapPoint found = look(of, path.begin()).value();
  if (of.piece != none)
    return outlines.key_of(of.a, outlines.of_ground(outlines.on_ground().outline(of.piece)), found);
  const std::vector<BodyOutline>& list = outlines.of_bodies().list();
  return list[of.b].key < list[of.a].key ? outlines.key_of(of.b, of.a, found.swapped())
                                         : outlines.key_of(of.a, of.b, found);
}

double OutlineDepth::first(StatePath& path, const NearOutlines& of, double level, double fine, double until) {
  const double begin = path.begin().state.time, end = path.end().state.time;
  const std::vector<BodyOutline>& list = detector_->outlines().of_bodies().list();
  const std::array<Index, 2> bodies{list[of.a].body, of.piece == none ? list[of.b].body : none};
  path.watch({bodies.data(), of.piece == none ? bodies.size() : 1});
  for (double time = begin;;) {
    const std::optional<GapPoint> at =
        look(of, time == begin ? path.begin() : path.sample(time, PathLook::exact));
    if (!at) return never;
    if (at->gap <= level) return time;
    const double nearer = approach(path, of, at->normal);
    if (!(nearer > 0.0)) return never;
    // At a gap of nearly the level the next look may be that much deeper.
    time += std::max(at->gap - level, fine) / nearer;
    if (!(time < std::min(until, end))) return never;
  }
}

}  // namespace carom
