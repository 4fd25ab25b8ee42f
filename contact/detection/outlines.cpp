// Problem: what the contact of two outlines is, of two bodies or of a body and ground.

#include <carom/contact/detection/outlines.h>

#include <cmath>

namespace carom {

Outlines::Outlines(const Assembly& assembly, const FeatureLengths& lengths)
    : Outlines(assembly, lengths,
               assembly.layout()->dimension() == 2 && has_law_between_bodies(assembly.system())) {}

Outlines::Outlines(const Assembly& assembly, const FeatureLengths& lengths, bool between_bodies)
    : OutlineList(assembly, lengths, between_bodies), laws_(assembly, of_bodies(), shapes(), between_bodies) {
  if (!laws_.bodies_touch() && on_ground().size() == 0) forget_bodies();
  if (ground_touches()) covering_ = CoveringGround(shapes(), on_ground());
}

Index Outlines::number_of_law(Index a, Index b) const {
  const std::vector<BodyOutline>& list = of_bodies().list();
  if (!is_on_ground(b)) return laws_.between(list[a].material, list[b].material);
  return laws_.with_ground(list[a].material, on_ground().outlines()[on_ground(b)].shape);
}

ConstraintKey Outlines::key_of(Index a, Index b, const GapPoint& gap) const {
  const BodyOutline& of_body = of_bodies().list()[a];
  if (!is_on_ground(b)) return carom::key_of(of_body, of_bodies().list()[b], gap);
  const GroundOutline& touched = on_ground().outlines()[on_ground(b)];
  if (touched.is_hollow()) return {of_body.vertex(gap.feature_a), touched.surface()};
  return carom::key_of(of_body, touched, gap);
}

std::optional<ContactPair> Outlines::pair_of(const ConstraintKey& key) const {
  const bool with_ground = key.b.owner == FeatureKey::Owner::obstacle;
  if (of_bodies().empty() || !(with_ground || key.b.owner == FeatureKey::Owner::shape)) return {};
  const Index a = of_bodies().find(key.a), ground = with_ground ? on_ground().outline_of(key.b) : none;
  if (a == none || (with_ground && ground == none)) return {};
  const Index b = with_ground ? of_ground(ground) : of_bodies().find(key.b);
  if (b == none) return {};
  const bool of_a = key.b == features(b).surface();
  const Index of_vertex = of_a ? a : b, whole = of_a ? b : a;
  ContactPair pair{.body = of_bodies().list()[a].body, .outline = whole};
  pair.feature = features(of_vertex).place(of_a ? key.a : key.b);
  pair.law = number_of_law(a, b);
  if (with_ground) {
    pair.ground_shape = on_ground().outlines()[ground].shape;
    if (!of_a) pair.feature = of_ground_vertex(pair.feature);
  } else {
    pair.body = of_bodies().list()[of_vertex].body;
    pair.other = of_bodies().list()[whole].body;
  }
  return pair;
}

void Outlines::write(const Touch& touch, const ContactQuery& query, Constraint& out) const {
  out.key = key_of(touch.a, touch.b, touch.gap);
  out.law = law(touch.a, touch.b);
  out.friction = out.law.friction;
  out.allowed_approach = touch.allowed_approach;
  const PairSide a = side(touch.a, query.state, query.places), b = side(touch.b, query.state, query.places);
  fill_pair_rows(a, b, touch.gap, out);
  if (is_on_ground(touch.b)) {
    const Index shape = on_ground().outlines()[on_ground(touch.b)].shape;
    const GroundMotion* const motion = shapes().motion(shape, query.places);
    const GroundAtEnd end = motion == nullptr ? GroundAtEnd{} : query.end_of(shapes(), shape);
    if (end.motion != nullptr) add_motion_after(a, b, touch.gap, *motion, *end.motion, end.step, out);
  }
  if (out.law.has_static_friction()) out.friction = out.law.friction_at(out.sliding_speed(query.state.v));
}

bool Outlines::lasts(Touch& touch, const ContactQuery& query, SingleConstraint& memory) const {
  if (query.lasting == nullptr || !query.lasting->contains(key_of(touch.a, touch.b, touch.gap))) return false;
  touch.allowed_approach = touch.gap.gap / query.lasting->step();
  memory.start_contact();
  write(touch, query, memory);
  return query.lasting->lasts(memory.key, touch.gap.gap, std::abs(memory.drift[0]), touch.of_corners);
}

}  // namespace carom
