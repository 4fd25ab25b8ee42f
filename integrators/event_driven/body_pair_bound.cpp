// Problem: many pairs of bodies, most of which are far from each other.

#include <carom/integrators/event_driven/body_pair_bound.h>

#include <algorithm>
#include <cmath>

namespace carom {

BodyPairBound bound_of(const Assembly& assembly, const Detector& detector, const ContactPair& pair) {
  const BodyOutlines& outlines = detector.bodies().outlines();
  const BodyOutline& of_vertex = outlines.list()[outlines.outline_of(pair.feature)];
  const BodyOutline& outline = outlines.list()[pair.outline];
  BodyPairBound bound;
  bound.a = assembly.layout()->bodies()[pair.body];
  bound.b = assembly.layout()->bodies()[pair.other];
  bound.lever = outlines.vertices()[pair.feature].norm();
  bound.radius = of_vertex.radius;
  bound.rounding = of_vertex.radius + outline.radius;
  double farthest = 0.0;
  for (const Vec<2>& vertex : outlines.described(outline).vertices) {
    farthest = std::max(farthest, vertex.norm());
  }
  bound.reach = farthest + outline.radius;
  bound.round = outline.vertices.size() == 1;
  bound.central = bound.round && bound.lever == 0.0 && farthest == 0.0;
  return bound;
}

double BodyPairBound::least_gap(const StateView& state) const {
  const double x = state.q[a.q] - state.q[b.q], y = state.q[a.q + 1] - state.q[b.q + 1];
  return std::sqrt(x * x + y * y) - (lever + radius + reach);
}

double BodyPairBound::most_speed(const double* velocities) const {
  const double x = velocities[a.v] - velocities[b.v], y = velocities[a.v + 1] - velocities[b.v + 1];
  double speed = std::sqrt(x * x + y * y);
  if (a.v_size > 2) speed += std::abs(velocities[a.v + 2]) * lever;
  if (b.v_size > 2) speed += std::abs(velocities[b.v + 2]) * reach;
  return speed;
}

}  // namespace carom
