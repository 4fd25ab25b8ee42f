#include <carom/contact/detection/contact_rows.h>

#include <carom/contact/detection/pair_rows.h>
#include <array>
#include <cmath>

namespace carom {

namespace {

/// Velocity of the feature's centre relative to the reference point of a shape on ground.
Vec<2> relative_velocity(const PlacedFeature<2>& at, const StateView& state, const GroundMotion& motion) {
  Vec<2> relative = Eigen::Map<const Vec<2>>(state.v + at.body.v) - planar_part(motion.velocity);
  if (at.body.rotation != none) relative += Space<2>::lever_velocity(state.v + at.body.v + 2, at.arm);
  return relative;
}

/// Share of a moving shape in the bound: of the drift in docs/method.md, section 1, without the acceleration
/// of the place that is touched, which its velocity at the end of the step has in it already.
double ground_turning(const PlacedFeature<2>& at, const StateView& state, const GroundMotion& motion,
                      double above) {
  const double w = std::abs(motion.spin);
  return 2.0 * w * (relative_velocity(at, state, motion).lpNorm<1>() + w * std::abs(above));
}

}  // namespace

template <int D>
void fill_rows(const PlacedFeature<D>& at, const Gap& gap, const StateView& state, Constraint& out) {
  const BodySlot& body = at.body;
  out.clear_bodies();
  out.add_body(at.feature.body, body.v, static_cast<int>(body.v_size));
  out.start_rows(D);
  out.gap = gap.distance - at.feature.radius;
  const Vec<D> normal = Eigen::Map<const Vec<D>>(gap.normal.data());
  const auto tangents = Space<D>::tangent_frame(normal);
  for (int row = 0; row < D; ++row) {
    const Vec<D> direction = row == 0 ? normal : tangents[static_cast<std::size_t>(row - 1)];
    Eigen::Map<Vec<D>>(out.row(row)) = direction;
    if constexpr (Space<D>::has_orientation) {
      if (body.rotation != none) {
        const Vec<D> lever = at.arm - at.feature.radius * normal;
        Space<D>::spin_row(direction, lever, out.row(row) + D);
        out.drift[static_cast<std::size_t>(row)] =
            direction.dot(Space<D>::centripetal(state.v + body.v + D, at.arm));
      }
    }
  }
}

void add_ground_motion(const PlacedFeature<2>& at, const StateView& state, const GroundMotion& motion,
                       const GroundAtEnd& step_end, Constraint& out) {
  // docs/method.md, section 1: C the centre of the feature, o the shape's point, w its spin, r = C - o.
  const Vec<2> n = Eigen::Map<const Vec<2>>(out.row(0)), t = Eigen::Map<const Vec<2>>(out.row(1));
  const Vec<2> r = at.centre - planar_part(motion.point), velocity = planar_part(motion.velocity);
  const double radius = at.feature.radius;
  const double w = motion.spin, along = t.dot(r), above = n.dot(r);
  out.surface_velocity = {n.dot(velocity) + w * along, t.dot(velocity) - w * (above - radius), 0.0};
  out.surface_velocity_after = out.surface_velocity;

  const Vec<2> relative = relative_velocity(at, state, motion);
  const Vec<2> acceleration = planar_part(motion.acceleration);
  out.drift[0] -=
      n.dot(acceleration) + 2.0 * w * t.dot(relative) + motion.angular_acceleration * along + w * w * above;
  out.drift[1] += -t.dot(acceleration) + 2.0 * w * n.dot(relative) +
                  motion.angular_acceleration * (above - radius) - w * w * along;
  const GroundMotion* const after = step_end.motion;
  if (after == nullptr) return;

  // The place that is touched goes with the shape, its arm turns from the one angle to the other; where the
  // feature slides it is another place then, and the normal, which turns too, has a part of the sliding of
  // the feature's centre.
  const double step = step_end.step, slide = step * (t.dot(relative) + w * above);
  const std::array<double, 2> turn{after->cosine * motion.cosine + after->sine * motion.sine,
                                   after->sine * motion.cosine - after->cosine * motion.sine};
  const Vec<2> arm = r - radius * n + slide * t;
  const Vec<2> end = planar_part(after->velocity) +
                     Space<2>::lever_velocity(&after->spin, Space<2>::rotate(turn.data(), arm));
  out.surface_velocity_after = {n.dot(end) + w * (slide - step * w * radius), t.dot(end), 0.0};
}

std::array<double, 2> curvature_drift(const PlacedFeature<2>& at, const StateView& state,
                                      const GroundShapes& shapes, Index shape, const GroundMotion* motion) {
  Vec<2> velocity = relative_velocity(at, state, motion == nullptr ? GroundMotion{} : *motion);
  if (motion != nullptr) {
    velocity -= Space<2>::lever_velocity(&motion->spin, Vec<2>(at.centre - planar_part(motion->point)));
  }
  const double speed = velocity.norm();
  if (speed == 0.0) return {};
  const auto turn_over = [&](double step) -> Vec<2> {
    const Vec<2> along = step / speed * velocity;
    const Vec<2> ahead = at.centre + along, behind = at.centre - along;
    return planar_part(shapes.gap(shape, motion, ahead.data()).normal) -
           planar_part(shapes.gap(shape, motion, behind.data()).normal);
  };
  // Rounding of the normals and the third derivative of the boundary share the error: they are small where
  // the normal turns by some 1e-5 rad. Steps are shorter where it turns by too much; a normal that jumps does
  // so over any step.
  constexpr double longest = 1e-5;               // [m]
  constexpr double good = 1e-5, too_far = 1e-3;  // [rad]
  double step = longest;
  Vec<2> turned = turn_over(step);
  for (double angle = turned.norm(); angle > too_far; angle = turned.norm()) {
    const double shorter = step * good / angle;
    const Vec<2> next = turn_over(shorter);
    if (!(next.norm() < 0.5 * angle)) break;
    step = shorter;
    turned = next;
  }
  const Vec<2> turn = turned * (0.5 * speed / step);
  return {turn.dot(velocity), Space<2>::tangent_frame(turn)[0].dot(velocity)};
}

template <int D>
double turning_bound(const PlacedFeature<D>& at, const StateView& state, const GroundMotion* motion,
                     double above) {
  double rate = 0.0;
  if constexpr (Space<D>::has_orientation) {
    if (at.body.rotation != none) {
      rate = Space<D>::centripetal(state.v + at.body.v + D, at.arm).template lpNorm<1>();
    }
  }
  if constexpr (D == 2) {
    if (motion != nullptr) rate += ground_turning(at, state, *motion, above);
  }
  return rate;
}

template void fill_rows<2>(const PlacedFeature<2>&, const Gap&, const StateView&, Constraint&);
template void fill_rows<3>(const PlacedFeature<3>&, const Gap&, const StateView&, Constraint&);
template double turning_bound<2>(const PlacedFeature<2>&, const StateView&, const GroundMotion*, double);
template double turning_bound<3>(const PlacedFeature<3>&, const StateView&, const GroundMotion*, double);

}  // namespace carom
