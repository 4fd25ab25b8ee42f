#include <carom/contact/detection/pair_rows.h>

#include <array>

namespace carom {

namespace {

/// How the normal and the common point move at constant velocities of the bodies.
struct ContactMotion {
  double turning;     // of the normal [rad/s]
  Vec<2> point_rate;  // of the common point [m/s]
};

/// \param approach rate of the gap
ContactMotion motion_of(const PairSide& a, const PairSide& b, const GapPoint& at, double approach) {
  const Vec<2>& n = at.normal;
  const Vec<2> t = Space<2>::tangent_frame(n)[0];
  const Vec<2> vertex_a = at.point_a + a.radius * n, vertex_b = at.point_b - b.radius * n;  // or on the edge
  double turning = 0.0;
  switch (at.kind) {
    case GapKind::edge_of_a:
      turning = a.spin;
      break;
    case GapKind::edge_of_b:
      turning = b.spin;
      break;
    case GapKind::vertices: {
      const double distance = at.gap + (a.radius + b.radius);
      // Of two centres in one place the direction is a choice, which does not move.
      if (distance != 0.0) turning = -t.dot(a.velocity_at(vertex_a) - b.velocity_at(vertex_b)) / distance;
    }
  }
  // From the vertex that is fixed to its body, along the normal to the middle of the gap.
  const Vec<2> normal_rate = -turning * t;
  const double half_gap = 0.5 * at.gap, half_rate = 0.5 * approach;
  if (at.kind == GapKind::edge_of_a) {
    return {turning, b.velocity_at(vertex_b) + (b.radius + half_gap) * normal_rate + half_rate * n};
  }
  return {turning, a.velocity_at(vertex_a) - (a.radius + half_gap) * normal_rate - half_rate * n};
}

/// Writes a row between two bodies that turn, the usual case in a pile.
void write_row_of_two(const RowSide& a, const RowSide& b, const Vec<2>& direction, const Vec<2>& point,
                      double* row) {
  row[0] = direction[0];
  row[1] = direction[1];
  Space<2>::spin_row(direction, Vec<2>(point - a.centre), row + 2);
  row[3] = -direction[0];
  row[4] = -direction[1];
  Space<2>::spin_row(direction, Vec<2>(b.centre - point), row + 5);
}

/// Writes a side's columns of a row; returns where the next ones begin.
double* write_columns(const RowSide& side, double sign, const Vec<2>& direction, const Vec<2>& point,
                      double* row) {
  if (side.columns == 0) return row;
  row[0] = sign * direction[0];
  row[1] = sign * direction[1];
  if (side.columns > 2) Space<2>::spin_row(direction, Vec<2>(sign * (point - side.centre)), row + 2);
  return row + side.columns;
}

}  // namespace

PairSide PairSide::of_body(const BodySlot& slot, Index place, double radius, const StateView& state) {
  PairSide side;
  side.body = place;
  side.v = slot.v;
  side.columns = static_cast<int>(slot.v_size);
  side.radius = radius;
  side.centre = {state.q[slot.q], state.q[slot.q + 1]};
  side.velocity = {state.v[slot.v], state.v[slot.v + 1]};
  if (slot.v_size > 2) side.spin = state.v[slot.v + 2];
  return side;
}

PairSide PairSide::at_rest(double radius) {
  PairSide side;
  side.radius = radius;
  return side;
}

PairSide PairSide::of_motion(const GroundMotion& motion, double radius) {
  PairSide side;
  side.radius = radius;
  side.centre = planar_part(motion.point);
  side.velocity = planar_part(motion.velocity);
  side.spin = motion.spin;
  side.acceleration = planar_part(motion.acceleration);
  side.angular_acceleration = motion.angular_acceleration;
  return side;
}

void fill_rows(const RowSide& a, const RowSide& b, const GapPoint& at, Constraint& out) {
  const Vec<2>& n = at.normal;
  const Vec<2> t = Space<2>::tangent_frame(n)[0], point = meeting_point(at);
  out.clear_bodies();
  out.add_body(a.body, a.v, a.columns);
  if (b.columns > 0) out.add_body(b.body, b.v, b.columns);
  out.start_rows(2);
  out.gap = at.gap;
  double* row = out.row(0);
  if (a.columns == 3 && b.columns == 3) {
    write_row_of_two(a, b, n, point, row);
    write_row_of_two(a, b, t, point, row + 6);
    return;
  }
  for (const Vec<2>* const direction : {&n, &t}) {
    row = write_columns(b, -1.0, *direction, point, write_columns(a, 1.0, *direction, point, row));
  }
}

void fill_pair_rows(const PairSide& a, const PairSide& b, const GapPoint& at, Constraint& out) {
  fill_rows(a, b, at, out);
  const Vec<2>& n = at.normal;
  const Vec<2> t = Space<2>::tangent_frame(n)[0], point = meeting_point(at);
  const Vec<2> velocity_b = b.velocity_at(point), relative = a.velocity_at(point) - velocity_b;
  if (b.columns == 0) {
    out.surface_velocity = {n.dot(velocity_b), t.dot(velocity_b) + b.surface_speed, 0.0};
    out.surface_velocity_after = out.surface_velocity;
  }

  // n' = -turning t, t' = turning n.
  const double normal = n.dot(relative), tangential = t.dot(relative);
  const ContactMotion motion = motion_of(a, b, at, normal);
  const Vec<2> rate =
      a.velocity_rate_at(point, motion.point_rate) - b.velocity_rate_at(point, motion.point_rate);
  out.drift = {n.dot(rate) - motion.turning * tangential, t.dot(rate) + motion.turning * normal, 0.0};
}

void add_motion_after(const PairSide& a, const PairSide& b, const GapPoint& at, const GroundMotion& now,
                      const GroundMotion& after, double step, Constraint& out) {
  const Vec<2> t = Space<2>::tangent_frame(at.normal)[0], point = meeting_point(at);
  const double approach = at.normal.dot(a.velocity_at(point) - b.velocity_at(point));
  // A shape that turns under a body, which does not go with it, is touched elsewhere then: a peg that spins
  // is as high as it was, though each place of it goes down.
  const ContactMotion motion = motion_of(a, b, at, approach);
  const Vec<2> ground = b.velocity_at(point);
  const double slide = t.dot(motion.point_rate - ground);
  const std::array<double, 2> turn{after.cosine * now.cosine + after.sine * now.sine,
                                   after.sine * now.cosine - after.cosine * now.sine};
  const Vec<2> arm = point - planar_part(now.point) + step * slide * t;
  const Vec<2> end =
      planar_part(after.velocity) + Space<2>::lever_velocity(&after.spin, Space<2>::rotate(turn.data(), arm));
  // The normal turns too, with a face of the shape or with the line between two corners, and has a part of
  // the sliding then. That an edge of the body turns is left to the body, as over ground at rest.
  double along = 0.0;
  if (at.kind != GapKind::edge_of_a) along = t.dot(a.velocity_at(at.point_a + a.radius * at.normal) - ground);
  out.surface_velocity_after = {at.normal.dot(end) + step * motion.turning * along,
                                t.dot(end) + b.surface_speed, 0.0};
}

}  // namespace carom
