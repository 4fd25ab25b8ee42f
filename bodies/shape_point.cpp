#include <carom/bodies/shape_features.h>
#include <carom/bodies/shape_point.h>

namespace carom::planar {

PartType<ShapeKind> Point::part_type() {
  return PartType<ShapeKind>::of<generic::FeatureShapeKind<Point>, Point>();
}

void Point::check(const PartCheck& check) const { check.finite({position.data(), 2}, "position", "m"); }

void Point::features(std::vector<RoundedPoint>& out) const {
  out.push_back({{position[0], position[1], 0.0}, 0.0});
}

Outline Point::outline(const PartCheck& /*check*/) const { return {{position}, 0.0}; }

}  // namespace carom::planar
