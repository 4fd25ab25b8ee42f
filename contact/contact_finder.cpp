#include <carom/contact/contact_finder.h>
#include <carom/core/space.h>

#include <algorithm>

namespace carom {

ContactFinder::ContactFinder(const Assembly& assembly) : assembly_(&assembly) {
  collect_obstacles();
  if (!obstacles_.empty()) collect_features();
  make_law_table();

  of_island_.reserve(assembly.islands().size());
  Index next = 0;
  for (const Island& island : assembly.islands()) {
    const Index first = next;
    while (next < features_.size() && features_[next].body < island.bodies.end) ++next;
    of_island_.push_back({first, next});
  }
}

void ContactFinder::collect_obstacles() {
  const auto& registry = assembly_->system().obstacle_kinds();
  for (const Index serial : registry.serials()) {
    const auto place = registry.place(serial);
    obstacles_.push_back({registry.entries()[place.entry].kind.get(), place.slot, serial});
  }
}

void ContactFinder::add_feature(Index body, const FeatureKey& key, const RoundedPoint& point,
                                MaterialId material) {
  const auto found = std::find(materials_.begin(), materials_.end(), material);
  const auto row = static_cast<Index>(found - materials_.begin());
  if (found == materials_.end()) materials_.push_back(material);
  features_.push_back({body, row, key, point.centre, point.radius});
}

void ContactFinder::collect_features() {
  const Layout& layout = *assembly_->layout();
  for (Index body = 0; body < layout.bodies().size(); ++body) {
    const BodySlot& slot = layout.bodies()[body];
    const BodyKind& kind = *assembly_->body_kinds()[slot.kind];
    if (!kind.has_contact_point(slot.slot)) continue;
    add_feature(body, {FeatureKey::Owner::body, slot.serial, 0}, {}, kind.material(slot.slot));
  }
  const auto& registry = assembly_->system().shape_kinds();
  std::vector<RoundedPoint> points;
  for (const Index serial : registry.serials()) {
    const auto place = registry.place(serial);
    const ShapeKind& kind = *registry.entries()[place.entry].kind;
    const Index body = layout.index(kind.body(place.slot));
    points.clear();
    kind.rounded_points(place.slot, points);
    for (Index i = 0; i < points.size(); ++i) {
      add_feature(body, {FeatureKey::Owner::shape, serial, i}, points[i], kind.material(place.slot));
    }
  }
  std::stable_sort(features_.begin(), features_.end(),
                   [](const Feature& a, const Feature& b) { return a.body < b.body; });
}

void ContactFinder::make_law_table() {
  const System& system = assembly_->system();
  for (Index material = 0; material < materials_.size(); ++material) {
    for (const Obstacle& obstacle : obstacles_) {
      const auto law = system.law(materials_[material], {obstacle.serial, system.token()});
      if (law) {
        laws_.push_back(*law);
        continue;
      }
      const auto feature = std::find_if(features_.begin(), features_.end(), [&](const Feature& candidate) {
        return candidate.material == material;
      });
      const ContactKey key{feature->key, {FeatureKey::Owner::obstacle, obstacle.serial, 0}};
      throw ModelError("contact of " + name(key) +
                       ": law is not given; allowed: a Surface on the obstacle or between the two materials");
    }
  }
}

std::string ContactFinder::name(const ContactKey& key) const {
  const System& system = assembly_->system();
  const Index token = system.token();
  std::string text =
      key.of.owner == FeatureKey::Owner::body
          ? system.name(BodyId{key.of.serial, token})
          : system.name(ShapeId{key.of.serial, token}) + " (feature " + std::to_string(key.of.feature) + ")";
  if (key.of.owner == FeatureKey::Owner::shape) {
    const auto place = system.shape_kinds().place(key.of.serial);
    text += " of " + system.name(system.shape_kinds().entries()[place.entry].kind->body(place.slot));
  }
  return text + " on " + system.name(ObstacleId{key.against.serial, token});
}

void ContactFinder::find(Index island, const StateView& state, const Evaluation& evaluation, double margin,
                         std::vector<Contact>& out) const {
  if (assembly_->layout()->dimension() == 2) {
    find_in<2>(island, state, evaluation, margin, out);
  } else {
    find_in<3>(island, state, evaluation, margin, out);
  }
}

template <int D>
void ContactFinder::find_in(Index island, const StateView& state, const Evaluation& evaluation, double margin,
                            std::vector<Contact>& out) const {
  using Map = Eigen::Map<Vec<D>>;
  using ConstMap = Eigen::Map<const Vec<D>>;
  const auto& bodies = assembly_->layout()->bodies();
  for (Index i = of_island_[island].begin; i < of_island_[island].end; ++i) {
    const Feature& feature = features_[i];
    const BodySlot& body = bodies[feature.body];
    Vec<D> arm = Vec<D>::Zero();
    if constexpr (Space<D>::has_orientation) {
      if (body.rotation != none) {
        arm = Space<D>::rotate(evaluation.rotation.data() + body.rotation,
                               Vec<D>(ConstMap(feature.centre.data())));
      }
    }
    const Vec<D> centre = ConstMap(state.q + body.q) + arm;
    for (std::size_t o = 0; o < obstacles_.size(); ++o) {
      const Obstacle& obstacle = obstacles_[o];
      const Gap gap = obstacle.kind->gap(obstacle.slot, centre.data());
      if (!(gap.distance - feature.radius <= margin)) continue;

      Contact& contact = out.emplace_back();
      contact.key = {feature.key, {FeatureKey::Owner::obstacle, obstacle.serial, 0}};
      contact.body = feature.body;
      contact.v = body.v;
      contact.columns = static_cast<int>(body.v_size);
      contact.rows = D;
      contact.gap = gap.distance - feature.radius;
      contact.law = laws_[feature.material * obstacles_.size() + o];
      const Vec<D> normal = ConstMap(gap.normal.data());
      const auto tangents = Space<D>::tangent_frame(normal);
      for (int row = 0; row < D; ++row) {
        const Vec<D> direction = row == 0 ? normal : tangents[static_cast<std::size_t>(row - 1)];
        Map(contact.row(row)) = direction;
        if constexpr (Space<D>::has_orientation) {
          if (body.rotation != none) {
            const Vec<D> lever = arm - feature.radius * normal;
            Eigen::Map<Vec<Space<D>::spin_size>>(contact.row(row) + D) = Space<D>::spin_row(direction, lever);
          }
        }
      }
    }
  }
}

}  // namespace carom
