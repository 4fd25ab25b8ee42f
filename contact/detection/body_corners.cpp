// Problem: where sharp corners of two bodies meet, and which sides of these corners other bodies cover.

#include <carom/contact/detection/body_touches.h>
#include <carom/contact/detection/corner_meeting.h>
#include <carom/contact/detection/covered_side.h>

namespace carom {

namespace {

/// Velocity of a point of a body. \param velocities of all bodies
Vec<2> velocity_at(const RowSide& side, const double* velocities, const Vec<2>& point) {
  Vec<2> out(velocities[side.v], velocities[side.v + 1]);
  if (side.columns > 2) out += Space<2>::lever_velocity(velocities + side.v + 2, Vec<2>(point - side.centre));
  return out;
}

/// The side of a corner of one outline that others cover, which another outline touches too.
HiddenSide hidden_side(const Outlines& outlines, const SharpCorner& corner, Index of, Index from,
                       BodyContactSearch& memory) {
  const std::vector<BodyOutline>& list = outlines.of_bodies().list();
  const FeatureLengths& lengths = outlines.on_ground().lengths();
  HiddenSide hidden = HiddenSide::neither;
  if (!list[of].has_sides()) return hidden;
  memory.broad.query(memory.boxes, box_around({&corner.at, 1}, lengths.corner), 0.0, memory.near);
  for (const Index i : memory.near) {
    if (i == of || i == from || !list[i].has_sides() || !outlines.laws().may_touch(list[i], list[from]))
      continue;
    hidden = hidden_by_both(hidden, side_covered_by(placed_outline(list[i], memory), corner, lengths));
  }
  return hidden;
}

}  // namespace

CornerMeeting meeting_of_bodies(const Outlines& outlines, const Touch& touch, const ContactQuery& query,
                                BodyContactSearch& memory) {
  const BodyOutline &a = outlines.of_bodies().list()[touch.a], &b = outlines.of_bodies().list()[touch.b];
  const ConvexOutline of_a = placed_outline(a, memory), of_b = placed_outline(b, memory);
  const auto [i, j] = nearest_corners(of_a, of_b, touch.gap);
  CornerMeeting meeting{SharpCorner::of(of_a, i), SharpCorner::of(of_b, j),
                        outlines.on_ground().lengths().corner};
  meeting.a.hidden = hidden_side(outlines, meeting.a, touch.a, touch.b, memory);
  meeting.b.hidden = hidden_side(outlines, meeting.b, touch.b, touch.a, memory);
  meeting.lasts = query.lasting != nullptr && query.lasting->contains({a.vertex(i), b.surface()}) &&
                  query.lasting->contains({a.surface(), b.vertex(j)});
  meeting.velocity = velocity_at(memory.sides[touch.a], query.state.v, meeting.a.at) -
                     velocity_at(memory.sides[touch.b], query.state.v, meeting.b.at);
  return meeting;
}

}  // namespace carom
