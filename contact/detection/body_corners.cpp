// Problem: where sharp corners of two bodies meet, and which sides of these corners other bodies cover.

#include <carom/contact/detection/body_contacts.h>
#include <carom/contact/detection/corner_meeting.h>
#include <carom/contact/detection/covered_side.h>
#include <carom/contact/detection/short_list.h>

#include <array>

namespace carom {

namespace {

/// Velocity of a point of a body. \param velocities of all bodies
Vec<2> velocity_at(const RowSide& side, const double* velocities, const Vec<2>& point) {
  Vec<2> out(velocities[side.v], velocities[side.v + 1]);
  if (side.columns > 2) out += Space<2>::lever_velocity(velocities + side.v + 2, Vec<2>(point - side.centre));
  return out;
}

/// True of an outline that has sides: a polygon that is not rounded.
bool has_sides(const BodyOutline& outline) { return outline.radius == 0.0 && outline.vertices.size() > 2; }

}  // namespace

/// The corners nearest to where two sharp outlines touch.
CornerMeeting BodyContacts::meeting_near(const BodyTouch& touch, const ContactQuery& query,
                                         BodyContactSearch& memory) const {
  const BodyOutline &a = outlines_.list()[touch.a], &b = outlines_.list()[touch.b];
  const ConvexOutline of_a = placed_outline(a, memory), of_b = placed_outline(b, memory);
  const auto [i, j] = nearest_corners(of_a, of_b, touch.gap);
  CornerMeeting meeting{SharpCorner::of(of_a, i), SharpCorner::of(of_b, j), lengths_.corner};
  meeting.a.hidden = hidden_side(meeting.a, touch.a, touch.b, memory);
  meeting.b.hidden = hidden_side(meeting.b, touch.b, touch.a, memory);
  meeting.lasts = query.lasting != nullptr && query.lasting->contains({a.vertex(i), b.surface()}) &&
                  query.lasting->contains({a.surface(), b.vertex(j)});
  meeting.velocity = velocity_at(memory.sides[touch.a], query.state.v, meeting.a.at) -
                     velocity_at(memory.sides[touch.b], query.state.v, meeting.b.at);
  return meeting;
}

/// The side of a corner of one outline that others cover, which another outline touches too.
HiddenSide BodyContacts::hidden_side(const SharpCorner& corner, Index of, Index from,
                                     BodyContactSearch& memory) const {
  const std::vector<BodyOutline>& list = outlines_.list();
  HiddenSide hidden = HiddenSide::neither;
  if (!has_sides(list[of])) return hidden;
  memory.broad.query(memory.boxes, box_around({&corner.at, 1}, lengths_.corner), 0.0, memory.near);
  for (const Index i : memory.near) {
    if (i == of || i == from || !has_sides(list[i]) || !may_touch(list[i], list[from])) continue;
    hidden = hidden_by_both(hidden, side_covered_by(placed_outline(list[i], memory), corner, lengths_));
  }
  return hidden;
}

OutlinePair BodyContacts::outline_pair(const ContactPair& pair, const StateView& state,
                                       const Evaluation& evaluation) const {
  const BodySlots& bodies = assembly_->layout()->bodies();
  const Index around = outlines_.outline_of(pair.feature);
  OutlinePair out;
  out.vertex_frame = {bodies[pair.body], state, evaluation};
  out.outline_frame = {bodies[pair.other], state, evaluation};
  out.vertex = outlines_.vertices()[pair.feature];
  out.around = outlines_.described(outlines_.list()[around]);
  out.outline = outlines_.described(outlines_.list()[pair.outline]);
  out.lengths = lengths_;
  if (const auto corners = corners_that_meet(out))
    find_hidden_sides(out, *corners, {around, pair.outline}, state, evaluation);
  return out;
}

/// Finds which sides of two corners that meet other outlines cover. \param of the outlines of the vertex, and
/// of the other corner
void BodyContacts::find_hidden_sides(OutlinePair& at, const MeetingCorners& corners,
                                     const std::array<Index, 2>& of, const StateView& state,
                                     const Evaluation& evaluation) const {
  const std::vector<BodyOutline>& list = outlines_.list();
  ShortList<Vec<2>, 32> vertices;
  const Vec<2> place = at.vertex_frame.outside(at.vertex);
  // Of bodies that are apart in the event-driven mode some stand where they were at another time.
  const auto is_placed = [&](Index body) {
    return evaluation.placed_at.empty() || evaluation.placed_at[assembly_->component_of(body)] == state.time;
  };
  for (Index i = 0; i < list.size(); ++i) {
    if (i == of[0] || i == of[1] || !has_sides(list[i]) || !is_placed(list[i].body)) continue;
    const BodySlot& slot = assembly_->layout()->bodies()[list[i].body];
    const Vec<2> apart = place - Vec<2>(state.q[slot.q], state.q[slot.q + 1]);
    const double reach = list[i].reach + at.lengths.sunk() + at.lengths.corner;
    if (apart.squaredNorm() > reach * reach) continue;
    vertices.reset(list[i].vertices.size());
    outlines_.place(list[i], slot, state, evaluation, vertices.all().data());
    const ConvexOutline neighbour{vertices.all(), 0.0};
    const auto add = [&](HiddenSide& hidden, const SharpCorner& corner) {
      hidden = hidden_by_both(hidden, side_covered_by(neighbour, corner, lengths_));
    };
    if (may_touch(list[i], list[of[1]])) add(at.hidden_of_vertex, corners.of_vertex);
    if (may_touch(list[i], list[of[0]])) add(at.hidden, corners.of_outline);
  }
}

}  // namespace carom
