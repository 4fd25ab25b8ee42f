// Problem: a contact that lasts, between the events at which its features change.

#include <carom/contact/detection/gap_convex.h>
#include <carom/contact/detection/pair_rows.h>
#include <carom/contact/detection/tracked_contact.h>

#include <vector>

namespace carom {

void follow_feature(const Assembly& assembly, const BodyOutlines& outlines, const ContactPair& pair,
                    Index feature, const StateView& state, const Evaluation& evaluation,
                    Constraint& contact) {
  const BodySlots& bodies = assembly.layout()->bodies();
  const BodyOutline &a = outlines.list()[outlines.outline_of(pair.feature)],
                    &b = outlines.list()[pair.outline];
  const auto turn = [&](const BodySlot& body, const Vec<2>& at, double sign) -> Vec<2> {
    if (body.rotation == none) return at;
    const double c = evaluation.rotation[body.rotation], s = sign * evaluation.rotation[body.rotation + 1];
    return {c * at[0] - s * at[1], s * at[0] + c * at[1]};
  };
  const BodySlot of_a = bodies[pair.body], of_b = bodies[pair.other];
  const Vec<2> centre_a(state.q[of_a.q], state.q[of_a.q + 1]), centre_b(state.q[of_b.q], state.q[of_b.q + 1]);
  // In the frame of the second body its vertices are at hand as described.
  const Vec<2> apart = centre_a + turn(of_a, outlines.vertices()[pair.feature], 1.0) - centre_b;
  const Vec<2> vertex = turn(of_b, apart, -1.0);
  GapPoint gap = tracked_gap({{&vertex, 1}, a.radius}, 0, outlines.described(b), feature);
  gap.normal = turn(of_b, gap.normal, 1.0);
  gap.point_a = centre_b + turn(of_b, gap.point_a, 1.0);
  gap.point_b = centre_b + turn(of_b, gap.point_b, 1.0);
  const PairSide side_a = PairSide::of_body(of_a, pair.body, a.radius, state);
  const PairSide side_b = PairSide::of_body(of_b, pair.other, b.radius, state);
  if (contact.body() == pair.body) {
    fill_pair_rows(side_a, side_b, gap, contact);
  } else {
    fill_pair_rows(side_b, side_a, gap.swapped(), contact);
  }
}

}  // namespace carom
