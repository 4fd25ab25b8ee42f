#include <carom/bodies/shape_polygon.h>

#include <algorithm>
#include <limits>

namespace carom::planar {

void Polygon::check_area(const PartCheck& check) const {
  // Vertices are rounded where they were computed; what is left of a line is some times this wide.
  constexpr double rounding = 16.0 * std::numeric_limits<double>::epsilon();
  Vec<2> along = Vec<2>::Zero();
  double magnitude = 0.0;
  for (const Vec<2>& vertex : vertices) {
    const Vec<2> arm = vertex - vertices.front();
    if (arm.stableNorm() > along.stableNorm()) along = arm;
    magnitude = std::max(magnitude, vertex.cwiseAbs().maxCoeff());
  }
  const double length = along.stableNorm();
  if (length <= rounding * magnitude) {
    check.refuse("vertices", "one point, repeated", "at least three that do not lie on one line");
  }
  const Vec<2> across = Vec<2>(-along[1], along[0]) / length;
  double width = 0.0;
  for (const Vec<2>& vertex : vertices) {
    width = std::max(width, std::abs(across.dot(vertex - vertices.front())));
  }
  if (width <= rounding * magnitude) {
    check.refuse("vertices", "on one line", "at least three that do not lie on one line (or a Segment)");
  }
}

}  // namespace carom::planar
