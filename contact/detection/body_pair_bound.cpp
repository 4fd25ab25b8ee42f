// Problem: many pairs of bodies, most of which are far from each other.

#include <carom/contact/detection/body_pair_bound.h>

#include <algorithm>
#include <cmath>

namespace carom {

namespace {

double farthest_of(const ConvexOutline& outline) {
  double farthest = 0.0;
  for (const Vec<2>& vertex : outline.vertices) farthest = std::max(farthest, vertex.norm());
  return farthest;
}

BodyPairBound bound_of_bodies(const Outlines& outlines, const ContactPair& pair) {
  const BodyOutlines& of_bodies = outlines.of_bodies();
  const BodyOutline& of_vertex = of_bodies.list()[outlines.outline_of(pair.feature)];
  const BodyOutline& outline = of_bodies.list()[pair.outline];
  BodyPairBound bound;
  bound.a = outlines.slots()[pair.body];
  bound.b = outlines.slots()[pair.other];
  bound.lever = of_bodies.vertices()[pair.feature].norm();
  bound.radius = of_vertex.radius;
  bound.rounding = of_vertex.radius + outline.radius;
  const double farthest = farthest_of(of_bodies.described(outline));
  bound.reach = farthest + outline.radius;
  bound.round = outline.vertices.size() == 1;
  bound.central = bound.round && bound.lever == 0.0 && farthest == 0.0;
  return bound;
}

BodyPairBound bound_on_ground(const Outlines& outlines, const ContactPair& pair) {
  const BodyOutlines& of_bodies = outlines.of_bodies();
  const GroundPieces& pieces = outlines.on_ground();
  BodyPairBound bound;
  bound.a = outlines.slots()[pair.body];
  bound.on_ground = true;
  if (outlines.is_on_ground(pair.outline)) {
    const GroundOutline& touched = pieces.outlines()[outlines.on_ground(pair.outline)];
    bound.lever = of_bodies.vertices()[pair.feature].norm();
    bound.radius = of_bodies.list()[outlines.outline_of(pair.feature)].radius;
    bound.box = touched.box;
    bound.reach = touched.reach;
    bound.round = touched.vertices.size() == 1;
    if (touched.is_hollow()) {
      bound.hollow = touched.radius;
    } else {
      bound.rounding = bound.radius + touched.radius;
    }
    return bound;
  }
  const BodyOutline& outline = of_bodies.list()[pair.outline];
  const Index on_ground = outlines.ground_vertex(pair.feature);
  const Vec<2>& vertex = pieces.vertices()[on_ground];
  const double radius = pieces.outlines()[pieces.outline_of(on_ground)].radius;
  bound.lever = farthest_of(of_bodies.described(outline));
  bound.radius = outline.radius;
  bound.rounding = outline.radius + radius;
  bound.round = outline.vertices.size() == 1;
  bound.box = {vertex.array() - radius, vertex.array() + radius};
  bound.reach = vertex.norm() + radius;
  return bound;
}

}  // namespace

BodyPairBound bound_of_pair(const Outlines& outlines, const ContactPair& pair) {
  return pair.is_of_pieces() ? bound_on_ground(outlines, pair) : bound_of_bodies(outlines, pair);
}

double BodyPairBound::least_gap(const StateView& state, const GroundMotion* motion) const {
  if (!on_ground) {
    const double x = state.q[a.q] - state.q[b.q], y = state.q[a.q + 1] - state.q[b.q + 1];
    return std::sqrt(x * x + y * y) - (lever + radius + reach);
  }
  const Vec<2> at = PlaneFrame(motion).inside(Vec<2>(state.q[a.q], state.q[a.q + 1]));
  if (hollow > 0.0) {
    const Vec<2> centre = 0.5 * (box.min + box.max);
    return hollow - (at - centre).norm() - (lever + radius);
  }
  const Vec<2> outside = (box.min - at).cwiseMax(at - box.max).cwiseMax(0.0);
  return outside.norm() - (lever + radius);
}

double BodyPairBound::most_speed(const double* velocities, const GroundMotion* motion) const {
  if (on_ground) {
    const double x = velocities[a.v], y = velocities[a.v + 1];
    double speed = std::sqrt(x * x + y * y);
    if (a.v_size > 2) speed += std::abs(velocities[a.v + 2]) * lever;
    if (motion == nullptr) return speed;
    return speed + std::hypot(motion->velocity[0], motion->velocity[1]) + std::abs(motion->spin) * reach;
  }
  const double x = velocities[a.v] - velocities[b.v], y = velocities[a.v + 1] - velocities[b.v + 1];
  double speed = std::sqrt(x * x + y * y);
  if (a.v_size > 2) speed += std::abs(velocities[a.v + 2]) * lever;
  if (b.v_size > 2) speed += std::abs(velocities[b.v + 2]) * reach;
  return speed;
}

double BodyPairBound::most_acceleration(const double* accelerations, const GroundMotion* motion) const {
  const double of_bodies = most_speed(accelerations, nullptr);
  if (motion == nullptr) return of_bodies;
  return of_bodies + std::hypot(motion->acceleration[0], motion->acceleration[1]) +
         (std::abs(motion->angular_acceleration) + motion->spin * motion->spin) * reach;
}

}  // namespace carom
