#include <carom/bodies/shape_features.h>
#include <carom/bodies/shape_segment.h>

namespace carom::planar {

PartType<ShapeKind> Segment::part_type() {
  return PartType<ShapeKind>::of<generic::FeatureShapeKind<Segment>, Segment>();
}

void Segment::check(const PartCheck& check) const {
  check.finite({from.data(), 2}, "from", "m");
  check.finite({to.data(), 2}, "to", "m");
  check.non_negative(radius, "radius", "m");
  if (from == to) check.refuse("to", "the same point as from", "another point");
}

void Segment::features(std::vector<RoundedPoint>& out) const {
  out.push_back({{from[0], from[1], 0.0}, radius});
  out.push_back({{to[0], to[1], 0.0}, radius});
}

Outline Segment::outline(const PartCheck& /*check*/) const { return {{from, to}, radius}; }

}  // namespace carom::planar
