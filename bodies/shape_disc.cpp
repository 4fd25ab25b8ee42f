#include <carom/bodies/shape_disc.h>
#include <carom/bodies/shape_features.h>

namespace carom::planar {

PartType<ShapeKind> Disc::part_type() {
  return PartType<ShapeKind>::of<generic::FeatureShapeKind<Disc>, Disc>();
}

void Disc::check(const PartCheck& check) const {
  check.positive(radius, "radius", "m");
  check.finite({centre.data(), 2}, "centre", "m");
}

void Disc::features(std::vector<RoundedPoint>& out) const {
  out.push_back({{centre[0], centre[1], 0.0}, radius});
}

Outline Disc::outline(const PartCheck& /*check*/) const { return {{centre}, radius}; }

}  // namespace carom::planar
