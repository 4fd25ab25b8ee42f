#include <carom/bodies/shape_features.h>

namespace carom::generic {

void add_features(Fingerprint& print, const ShapeKind& shapes) {
  std::vector<RoundedPoint> points;
  for (Index slot = 0; slot < shapes.size(); ++slot) {
    print.add(std::uint64_t{shapes.body(slot).serial});
    print.add(std::uint64_t{shapes.material(slot).serial});
    points.clear();
    shapes.rounded_points(slot, points);
    print.add(std::uint64_t{points.size()});
    for (const RoundedPoint& point : points) {
      print.add(point.centre);
      print.add(point.radius);
    }
  }
}

}  // namespace carom::generic
