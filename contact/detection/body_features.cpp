#include <carom/contact/detection/body_features.h>
#include <carom/core/described_sets.h>

#include <algorithm>

namespace carom {

namespace {

bool is_centred(const BodyFeature& point) {
  return point.centre[0] == 0.0 && point.centre[1] == 0.0 && point.centre[2] == 0.0;
}

/// Appends a run of one body to another of the same kind, if it goes on with it.
bool join(CentreRun& run, const CentreRun& next) {
  if (run.bodies.end != next.bodies.begin || run.material != next.material) return false;
  if (run.filter != next.filter) return false;
  if ((run.points == none) != (next.points == none)) return false;
  if (run.points != none && run.points + run.bodies.size() != next.points) return false;
  run.radius = std::max(run.radius, next.radius);
  ++run.bodies.end;
  return true;
}

}  // namespace

BodyFeatures::BodyFeatures(const Assembly& assembly) {
  collect_points(assembly);
  collect_centres(assembly);
  of_component_.reserve(assembly.components().size());
  OfComponents own{};
  for (const Component& component : assembly.components()) {
    while (own.centres.begin < centres_.size() &&
           centres_[own.centres.begin].bodies.end <= component.bodies.begin) {
      ++own.centres.begin;
    }
    own.centres.end = std::max(own.centres.end, own.centres.begin);
    while (own.centres.end < centres_.size() &&
           centres_[own.centres.end].bodies.begin < component.bodies.end) {
      ++own.centres.end;
    }
    own.points.begin = own.points.end;
    while (own.points.end < points_.size() && points_[own.points.end].body < component.bodies.end) {
      ++own.points.end;
    }
    of_component_.push_back(own);
  }
}

Index BodyFeatures::number_of(const FeatureMaterial& material) {
  const auto found = std::find(materials_.begin(), materials_.end(), material);
  const auto number = static_cast<Index>(found - materials_.begin());
  if (found == materials_.end()) materials_.push_back(material);
  return number;
}

/// Runs end where the kind, the material, the filter or the step between the features changes, and with the
/// batch.
void BodyFeatures::collect_centres(const Assembly& assembly) {
  const Layout& layout = *assembly.layout();
  const auto& registry = assembly.system().body_kinds();
  Index point = 0;
  for (const Range batch : assembly.batches()) {
    const Range bodies = assembly.bodies_of(batch);
    Index last_kind = none;
    for (Index body = bodies.begin; body < bodies.end; ++body) {
      const BodySlot slot = layout.bodies()[body];
      const Index first = point;
      while (point < points_.size() && points_[point].body == body) ++point;
      const auto place = registry.place(slot.serial);
      const BodyKind& kind = *registry.entries()[place.entry].kind;
      CentreRun run{{body, body + 1}, none, none, 0.0, {}};
      if (kind.has_contact_point(place.slot)) {
        run.filter = kind.filter(place.slot);
        run.material = number_of({kind.material(place.slot), run.filter});
      } else if (point == first + 1 && is_centred(points_[first])) {
        run.points = first;
        run.radius = points_[first].radius;
        run.filter = materials_[points_[first].material].filter;
      } else {
        continue;
      }
      if (slot.kind != last_kind || !join(centres_.back(), run)) centres_.push_back(run);
      last_kind = slot.kind;
    }
  }
}

void BodyFeatures::collect_points(const Assembly& assembly) {
  const Layout& layout = *assembly.layout();
  const System& system = assembly.system();
  const auto& registry = system.shape_kinds();
  std::vector<RoundedPoint> points;
  for (const Index serial : registry.serials()) {
    const auto place = registry.place(serial);
    const ShapeKind& kind = *registry.entries()[place.entry].kind;
    const Index body = layout.index(kind.body(place.slot));
    points.clear();
    kind.rounded_points(place.slot, points);
    check_rounded_points({system.name(ShapeId{serial, system.token()}), system}, points);
    const FeatureMaterial material{kind.material(place.slot), kind.filter(place.slot)};
    for (Index i = 0; i < points.size(); ++i) {
      points_.push_back({body,
                         number_of(material),
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
  const auto centre = std::find_if(centres_.begin(), centres_.end(), has_it);  // without extent
  const auto point = std::find_if(points_.begin(), points_.end(), has_it);
  const bool is_centre =
      centre != centres_.end() && (point == points_.end() || centre->bodies.begin <= point->body);
  return is_centre ? FeatureKey{FeatureKey::Owner::body, layout.id(centre->bodies.begin).serial, 0}
                   : point->key;
}

bool BodyFeatures::is_beside_centres(const BodyFeature& point) const {
  const auto before = [](const CentreRun& run, Index body) { return run.bodies.end <= body; };
  const auto run = std::lower_bound(centres_.begin(), centres_.end(), point.body, before);
  return run == centres_.end() || point.body < run->bodies.begin || run->points == none;
}

bool BodyFeatures::any_off_centre() const { return !std::all_of(points_.begin(), points_.end(), is_centred); }

}  // namespace carom
