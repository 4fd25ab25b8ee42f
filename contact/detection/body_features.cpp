#include <carom/contact/detection/body_features.h>

#include <algorithm>

namespace carom {

BodyFeatures::BodyFeatures(const Assembly& assembly) {
  collect_centres(assembly);
  collect_points(assembly);
  of_component_.reserve(assembly.components().size());
  Index centre = 0, point = 0;
  for (const Component& component : assembly.components()) {
    OfComponent own{{centre, centre}, {point, point}};
    while (centre < centres_.size() && centres_[centre].bodies.end <= component.bodies.end) ++centre;
    while (point < points_.size() && points_[point].body < component.bodies.end) ++point;
    own.centres.end = centre;
    own.points.end = point;
    of_component_.push_back(own);
  }
}

Index BodyFeatures::number_of(MaterialId material) {
  const auto found = std::find(materials_.begin(), materials_.end(), material);
  const auto number = static_cast<Index>(found - materials_.begin());
  if (found == materials_.end()) materials_.push_back(material);
  return number;
}

void BodyFeatures::collect_centres(const Assembly& assembly) {
  const Layout& layout = *assembly.layout();
  const auto& registry = assembly.system().body_kinds();
  for (const Component& component : assembly.components()) {
    Index last_kind = none;
    for (Index body = component.bodies.begin; body < component.bodies.end; ++body) {
      const BodySlot slot = layout.bodies()[body];
      const auto place = registry.place(slot.serial);
      const BodyKind& kind = *registry.entries()[place.entry].kind;
      if (!kind.has_contact_point(place.slot)) continue;
      const Index material = number_of(kind.material(place.slot));
      if (slot.kind == last_kind && centres_.back().bodies.end == body &&
          centres_.back().material == material) {
        ++centres_.back().bodies.end;
      } else {
        centres_.push_back({{body, body + 1}, material});
      }
      last_kind = slot.kind;
    }
  }
}

void BodyFeatures::collect_points(const Assembly& assembly) {
  const Layout& layout = *assembly.layout();
  const auto& registry = assembly.system().shape_kinds();
  std::vector<RoundedPoint> points;
  for (const Index serial : registry.serials()) {
    const auto place = registry.place(serial);
    const ShapeKind& kind = *registry.entries()[place.entry].kind;
    const Index body = layout.index(kind.body(place.slot));
    points.clear();
    kind.rounded_points(place.slot, points);
    for (Index i = 0; i < points.size(); ++i) {
      points_.push_back({body,
                         number_of(kind.material(place.slot)),
                         {FeatureKey::Owner::shape, serial, i},
                         points[i].centre,
                         points[i].radius});
    }
  }
  std::stable_sort(points_.begin(), points_.end(),
                   [](const BodyFeature& a, const BodyFeature& b) { return a.body < b.body; });
}

FeatureKey BodyFeatures::first_of(Index material, const Layout& layout) const {
  const auto has_it = [material](const auto& candidate) { return candidate.material == material; };
  const auto centre = std::find_if(centres_.begin(), centres_.end(), has_it);
  const auto point = std::find_if(points_.begin(), points_.end(), has_it);
  const bool is_centre =
      centre != centres_.end() && (point == points_.end() || centre->bodies.begin <= point->body);
  return is_centre ? FeatureKey{FeatureKey::Owner::body, layout.id(centre->bodies.begin).serial, 0}
                   : point->key;
}

bool BodyFeatures::any_off_centre() const {
  return std::any_of(points_.begin(), points_.end(), [](const BodyFeature& point) {
    return point.centre[0] != 0.0 || point.centre[1] != 0.0 || point.centre[2] != 0.0;
  });
}

}  // namespace carom
