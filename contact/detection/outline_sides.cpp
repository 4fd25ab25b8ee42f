// Problem: how the two sides of a pair of a vertex and an outline stand, whosever they are.

#include <carom/contact/detection/covered_side.h>
#include <carom/contact/detection/outlines.h>
#include <carom/contact/detection/short_list.h>

#include <array>

namespace carom {

OutlinePair Outlines::outline_pair(const ContactPair& pair, const StateView& state,
                                   const Evaluation& evaluation, const GroundPlaces& places) const {
  const auto frame_of = [&](Index outline) {
    if (!is_on_ground(outline))
      return PlaneFrame(slots()[of_bodies().list()[outline].body], state, evaluation);
    return PlaneFrame(shapes().motion(pair.ground_shape, places));
  };
  const Index of_vertex = outline_of(pair.feature), on_ground_vertex = ground_vertex(pair.feature);
  OutlinePair out;
  out.lengths = on_ground().lengths();
  out.vertex_frame = frame_of(of_vertex);
  out.outline_frame = frame_of(pair.outline);
  if (on_ground_vertex == none) {
    out.vertex = of_bodies().vertices()[pair.feature];
    out.around = of_bodies().described(of_bodies().list()[of_vertex]);
  } else {
    out.vertex = on_ground().vertices()[on_ground_vertex];
    out.around = {on_ground().around(on_ground_vertex), on_ground().outlines()[on_ground(of_vertex)].radius};
  }
  if (is_on_ground(pair.outline)) {
    const Index touched = on_ground(pair.outline);
    out.outline = on_ground().view(touched);
    out.is_hollow = on_ground().outlines()[touched].is_hollow();
    if (on_ground().outlines()[touched].is_chain()) out.chain = on_ground().chain(touched);
  } else {
    out.outline = of_bodies().described(of_bodies().list()[pair.outline]);
  }
  if (const auto corners = corners_that_meet(out))
    cover(out, *corners, {of_vertex, pair.outline}, state, evaluation, places);
  return out;
}

/// Finds which sides of two corners that meet others cover: of a corner on ground other shapes on ground, of
/// those of two bodies other bodies. \param of the outlines of the vertex, and of the other corner
void Outlines::cover(OutlinePair& at, const MeetingCorners& corners, const std::array<Index, 2>& of,
                     const StateView& state, const Evaluation& evaluation, const GroundPlaces& places) const {
  const bool vertex_is_on_ground = is_on_ground(of[0]);
  if (!vertex_is_on_ground && !is_on_ground(of[1]))
    return cover_by_bodies(at, corners, of, state, evaluation);
  const BodyOutline& body = of_bodies().list()[vertex_is_on_ground ? of[1] : of[0]];
  const Index shape = on_ground().outlines()[on_ground(vertex_is_on_ground ? of[0] : of[1])].shape;
  const SharpCorner& corner = vertex_is_on_ground ? corners.of_vertex : corners.of_outline;
  (vertex_is_on_ground ? at.hidden_of_vertex : at.hidden) = covered_side(corner, shape, body.filter, places);
}

void Outlines::cover_by_bodies(OutlinePair& at, const MeetingCorners& corners, const std::array<Index, 2>& of,
                               const StateView& state, const Evaluation& evaluation) const {
  const std::vector<BodyOutline>& list = of_bodies().list();
  ShortList<Vec<2>, 32> vertices;
  const Vec<2> place = at.vertex_frame.outside(at.vertex);
  // Of bodies that are apart in the event-driven mode some stand where they were at another time.
  const auto is_placed = [&](Index body) {
    return evaluation.placed_at.empty() || evaluation.placed_at[assembly().component_of(body)] == state.time;
  };
  for (Index i = 0; i < list.size(); ++i) {
    if (i == of[0] || i == of[1] || !list[i].has_sides() || !is_placed(list[i].body)) continue;
    const BodySlot& slot = slots()[list[i].body];
    const Vec<2> apart = place - Vec<2>(state.q[slot.q], state.q[slot.q + 1]);
    const double reach = list[i].reach + at.lengths.sunk() + at.lengths.corner;
    if (apart.squaredNorm() > reach * reach) continue;
    vertices.reset(list[i].vertices.size());
    of_bodies().place(list[i], slot, state, evaluation, vertices.all().data());
    const ConvexOutline neighbour{vertices.all(), 0.0};
    const auto add = [&](HiddenSide& hidden, const SharpCorner& corner) {
      hidden = hidden_by_both(hidden, side_covered_by(neighbour, corner, at.lengths));
    };
    if (laws_.may_touch(list[i], list[of[1]])) add(at.hidden_of_vertex, corners.of_vertex);
    if (laws_.may_touch(list[i], list[of[0]])) add(at.hidden, corners.of_outline);
  }
}

PairSides Outlines::sides(const ContactPair& pair, const StateView& state, const Evaluation& evaluation,
                          const GroundPlaces& places) const {
  const Index of_vertex = outline_of(pair.feature);
  const OutlineFeatures &with_vertex = features(of_vertex), &whole = features(pair.outline);
  const Index on_ground_vertex = ground_vertex(pair.feature);
  const Index vertex =
      (on_ground_vertex == none ? pair.feature : on_ground_vertex) - with_vertex.vertices.begin;
  PairSides out{.at = outline_pair(pair, state, evaluation, places),
                .of_vertex = side(of_vertex, state, places),
                .of_outline = side(pair.outline, state, places),
                .vertex = with_vertex.vertex(vertex),
                .surface = whole.surface(),
                .law = &laws_[pair.law],
                .vertex_is_first = !(whole.key < with_vertex.key)};
  if (out.at.chain) {
    out.pieces = &on_ground();
    out.chain = on_ground(pair.outline);
  }
  return out;
}

}  // namespace carom
