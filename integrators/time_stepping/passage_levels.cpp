// Problem: what is deep in a thin thing?

#include <carom/contact/detection/convex_outline.h>
#include <carom/core/numerics/never.h>
#include <carom/integrators/time_stepping/passage_levels.h>

#include <algorithm>
#include <cmath>

namespace carom {

namespace {

// Share of the radii of the circles in both that a pair may come deep.
constexpr double deep = 1.0 / 8.0;

/// Radius of a circle in a convex set: a third of its width (W. Blaschke, Kreis und Kugel, 1916), and what
/// widens it.
double circle_in(const ConvexOutline& of) {
  constexpr Index polygon = 3;
  double width = of.size() < polygon ? 0.0 : never;
  for (Index i = 0; i < of.size() && of.size() >= polygon; ++i) {
    const OutlineEdge edge(of, i);
    double height = 0.0;
    for (const Vec<2>& vertex : of.vertices) height = std::max(height, -edge.height(vertex));
    width = std::min(width, height);
  }
  return of.radius + width / 3.0;
}

/// That of an outline on ground; infinite of one that is not looked for. A hill of any depth is as thick as
/// what its corners hold, where passages of far sides are looked for.
double circle_in(const GroundPieces& pieces, Index outline, Passages which) {
  const GroundOutline& of = pieces.outlines()[outline];
  const double of_no_far_side = which == Passages::all ? 0.0 : never;
  if (of.is_hollow()) return of_no_far_side;
  if (!of.is_chain()) return circle_in(pieces.view(outline));
  if (std::isfinite(of.depth)) return 0.5 * of.depth;
  if (which == Passages::all) return 0.0;
  const double hill = circle_in(pieces.view(outline));
  return hill > 0.0 ? hill : never;
}

}  // namespace

PassageLevels::PassageLevels(const Detector& detector, double least_depth, Passages which)
    : detector_(&detector), least_depth_(least_depth) {
  const Outlines& outlines = detector.outlines();
  reach_.assign(outlines.slots().size(), 0.0);
  double of_bodies = never, thinnest = never;
  for (const BodyOutline& outline : outlines.of_bodies().list()) {
    circle_.push_back(circle_in(outlines.of_bodies().described(outline)));
    of_bodies = std::min(of_bodies, circle_.back());
    // Only the vertices turn: the radius around them is the same on all sides.
    reach_[outline.body] = std::max(reach_[outline.body], outline.reach - outline.radius);
  }
  if (outlines.bodies_touch()) thinnest = of_bodies;
  const auto on_ground = static_cast<Index>(outlines.on_ground().outlines().size());
  for (Index i = 0; outlines.ground_touches() && i < on_ground; ++i) {
    of_ground_.push_back(circle_in(outlines.on_ground(), i, which));
    thinnest = std::min(thinnest, of_ground_.back());
  }
  thinnest_ = std::max(least_depth, deep * (of_bodies + thinnest));
}

double PassageLevels::allowed(const NearOutlines& of) const {
  const Index ground = of.piece == none ? none : detector_->outlines().on_ground().outline(of.piece);
  const double other = ground == none ? circle_[of.b] : of_ground_[ground];
  return std::max(least_depth_, deep * (circle_[of.a] + other));
}

}  // namespace carom
