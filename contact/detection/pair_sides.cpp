// Problem: the contact of a vertex and an outline, whosever they are.

#include <carom/contact/detection/feature_margin.h>
#include <carom/contact/detection/narrow_phase.h>
#include <carom/contact/detection/pair_sides.h>

namespace carom {

namespace {

/// The gap at the nearest feature, in the frame of the outline.
GapPoint gap_at_nearest(const PairSides& sides, const ConvexOutline& point) {
  const OutlinePair& at = sides.at;
  GapPoint gap;
  Index feature = none;
  if (!at.chain || !at.is_sharp()) {
    gap = nearest_gap(PlacedOutline(point), at.touched());
    feature = gap.feature_b;
  }
  const auto may_be_another = [&] {
    return at.chain || gap.gap <= at.lengths.corner_follows() || FeatureRegions::is_flat(at.outline);
  };
  if (at.is_sharp() && may_be_another()) {
    const FeatureRegions regions(at);
    feature = regions.nearest();
    gap = regions.gap(point, feature);
  }
  if (sides.pieces == nullptr) return gap;
  const double height = gap.gap + point.radius;
  if (sides.pieces->is_out_behind(sides.chain, feature, height, point.vertices[0])) {
    gap.gap = -height - point.radius;  // it is on the other side
    gap.normal = -gap.normal;
  }
  return gap;
}

void fill(const PairSides& sides, const GapPoint& gap, Constraint& out) {
  sides.vertex_is_first ? fill_pair_rows(sides.of_vertex, sides.of_outline, gap, out)
                        : fill_pair_rows(sides.of_outline, sides.of_vertex, gap.swapped(), out);
}

}  // namespace

GapPoint gap_of(const PairSides& sides, Index feature) {
  const OutlinePair& at = sides.at;
  const Vec<2> vertex = at.vertex_at_outline();
  const ConvexOutline point{{&vertex, 1}, at.around.radius};
  const bool is_any = feature == none || at.is_hollow;  // of which there is but one feature
  const GapPoint gap = is_any ? gap_at_nearest(sides, point) : FeatureRegions(at).gap(point, feature);
  return in_space(at.outline_frame, gap);
}

void write_contact(const PairSides& sides, const StateView& state, Constraint& out) {
  out.start_contact();
  out.key = sides.vertex_is_first ? ConstraintKey{sides.vertex, sides.surface}
                                  : ConstraintKey{sides.surface, sides.vertex};
  out.law = *sides.law;
  out.friction = out.law.friction;
  fill(sides, gap_of(sides, none), out);
  if (out.law.has_static_friction()) out.friction = out.law.friction_at(out.sliding_speed(state.v));
}

void follow(const PairSides& sides, Index feature, Constraint& contact) {
  fill(sides, gap_of(sides, feature), contact);
}

}  // namespace carom
