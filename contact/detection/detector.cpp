#include <carom/contact/detection/contact_name.h>
#include <carom/contact/detection/detector.h>
#include <carom/core/space.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <type_traits>

namespace carom {

Detector::Detector(const Assembly& assembly) : assembly_(&assembly) {
  collect_obstacles();
  if (!obstacles_.empty()) collect_features();
  make_law_table();

  of_component_.reserve(assembly.components().size());
  Index centre = 0, feature = 0;
  for (const Component& component : assembly.components()) {
    Touching touching{{centre, centre}, {feature, feature}, {}, {}};
    while (centre < centres_.size() && centres_[centre].bodies.end <= component.bodies.end) ++centre;
    while (feature < features_.size() && features_[feature].body < component.bodies.end) ++feature;
    touching.centres.end = centre;
    touching.features.end = feature;
    of_component_.push_back(touching);
  }
  collect_stops();
  collect_rubbing();
}

void Detector::collect_obstacles() {
  const auto& registry = assembly_->system().ground_shape_kinds();
  for (const Index serial : registry.serials()) {
    const auto place = registry.place(serial);
    const GroundShapeKind& kind = *registry.entries()[place.entry].kind;
    const Index moving = kind.moves(place.slot) ? moving_++ : none;
    obstacles_.push_back({&kind, place.slot, serial, moving});
  }
}

Index Detector::row_of(MaterialId material) {
  const auto found = std::find(materials_.begin(), materials_.end(), material);
  const auto row = static_cast<Index>(found - materials_.begin());
  if (found == materials_.end()) materials_.push_back(material);
  return row;
}

void Detector::collect_centres() {
  const Layout& layout = *assembly_->layout();
  const auto& registry = assembly_->system().body_kinds();
  for (const Component& component : assembly_->components()) {
    Index last_kind = none;
    for (Index body = component.bodies.begin; body < component.bodies.end; ++body) {
      const BodySlot slot = layout.bodies()[body];
      const auto place = registry.place(slot.serial);
      const BodyKind& kind = *registry.entries()[place.entry].kind;
      if (!kind.has_contact_point(place.slot)) continue;
      const Index material = row_of(kind.material(place.slot));
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

void Detector::collect_features() {
  collect_centres();
  const Layout& layout = *assembly_->layout();
  const auto& registry = assembly_->system().shape_kinds();
  std::vector<RoundedPoint> points;
  for (const Index serial : registry.serials()) {
    const auto place = registry.place(serial);
    const ShapeKind& kind = *registry.entries()[place.entry].kind;
    const Index body = layout.index(kind.body(place.slot));
    points.clear();
    kind.rounded_points(place.slot, points);
    for (Index i = 0; i < points.size(); ++i) {
      features_.push_back({body,
                           row_of(kind.material(place.slot)),
                           {FeatureKey::Owner::shape, serial, i},
                           points[i].centre,
                           points[i].radius});
    }
  }
  std::stable_sort(features_.begin(), features_.end(),
                   [](const Feature& a, const Feature& b) { return a.body < b.body; });
}

void Detector::make_law_table() {
  const System& system = assembly_->system();
  for (Index material = 0; material < materials_.size(); ++material) {
    for (const Obstacle& obstacle : obstacles_) {
      const auto law = system.law(materials_[material], {obstacle.serial, system.token()});
      if (law) {
        laws_.push_back(*law);
        has_static_friction_ = has_static_friction_ || law->has_static_friction();
        continue;
      }
      const auto uses = [material](const auto& candidate) { return candidate.material == material; };
      const auto centre = std::find_if(centres_.begin(), centres_.end(), uses);
      const auto feature = std::find_if(features_.begin(), features_.end(), uses);
      const bool is_centre =
          centre != centres_.end() && (feature == features_.end() || centre->bodies.begin <= feature->body);
      const FeatureKey of = is_centre ? FeatureKey{FeatureKey::Owner::body,
                                                   assembly_->layout()->id(centre->bodies.begin).serial, 0}
                                      : feature->key;
      const ConstraintKey key{of, {FeatureKey::Owner::obstacle, obstacle.serial, 0}};
      throw ModelError("contact of " + name(key) +
                       ": law is not given; allowed: a Surface on the obstacle, between the two materials or "
                       "as default law");
    }
  }
}

bool Detector::needs_rotations() const {
  if (!stops_.empty()) return true;
  return std::any_of(features_.begin(), features_.end(), [](const Feature& feature) {
    return feature.centre[0] != 0.0 || feature.centre[1] != 0.0 || feature.centre[2] != 0.0;
  });
}

std::string Detector::name(const ConstraintKey& key) const { return contact_name(assembly_->system(), key); }

void Detector::find(Index component, const StateView& state, const Evaluation& evaluation, double margin,
                    std::vector<Constraint>& out) const {
  ObstaclePlaces places;
  place(state.time, places);
  find(component, {state, evaluation, &places, nullptr, margin, nullptr}, out);
}

void Detector::find(Index component, const StateView& state, const Evaluation& evaluation,
                    const ObstaclePlaces& places, const ObstaclePlaces* after, double margin,
                    std::vector<Constraint>& out, const LastingContacts* lasting) const {
  assert(moving_ == 0 || places.time_ == state.time);
  if (lasting != nullptr && lasting->empty()) lasting = nullptr;
  find(component, {state, evaluation, &places, after, margin, lasting}, out);
}

void Detector::find(Index component, const Query& query, std::vector<Constraint>& out) const {
  if (assembly_->layout()->dimension() == 2) {
    find_in<2>(component, query, out);
  } else {
    find_in<3>(component, query, out);
  }
  const Range stops = of_component_[component].stops;
  for (Index stop = stops.begin; stop < stops.end; ++stop) {
    Constraint contact;
    make_stop(stop, query.state, query.evaluation, contact);
    if (!(contact.gap <= query.margin)) {
      if (query.lasting == nullptr || !lasts(query, contact.key, contact.gap, std::abs(contact.drift[0]))) {
        continue;
      }
      contact.allowed_approach = contact.gap / query.lasting->step();
    }
    out.push_back(contact);
  }
}

Detector::Feature Detector::centre_of(const BodySlot& body, Index place, Index material) const {
  return {place, material, {FeatureKey::Owner::body, body.serial, 0}, {}, 0.0};
}

template <int D>
Vec<D> Detector::arm(const BodySlot& body, const Feature& feature, const Evaluation& evaluation) {
  if constexpr (Space<D>::has_orientation) {
    if (body.rotation != none) {
      return Space<D>::rotate(evaluation.rotation.data() + body.rotation,
                              Vec<D>(Eigen::Map<const Vec<D>>(feature.centre.data())));
    }
  }
  return Vec<D>::Zero();
}

template <int D>
void Detector::fill(const BodySlot& body, const Feature& feature, Index obstacle, const Gap& gap,
                    const Vec<D>& arm, const StateView& state, Constraint& contact) const {
  contact.key = {feature.key, {FeatureKey::Owner::obstacle, obstacles_[obstacle].serial, 0}};
  contact.bodies = 0;
  contact.add_body(feature.body, body.v, static_cast<int>(body.v_size));
  contact.rows = D;
  contact.gap = gap.distance - feature.radius;
  contact.law = laws_[feature.material * obstacles_.size() + obstacle];
  contact.friction = contact.law.friction;
  const Vec<D> normal = Eigen::Map<const Vec<D>>(gap.normal.data());
  const auto tangents = Space<D>::tangent_frame(normal);
  for (int row = 0; row < D; ++row) {
    const Vec<D> direction = row == 0 ? normal : tangents[static_cast<std::size_t>(row - 1)];
    Eigen::Map<Vec<D>>(contact.row(row)) = direction;
    if constexpr (Space<D>::has_orientation) {
      if (body.rotation != none) {
        const Vec<D> lever = arm - feature.radius * normal;
        Eigen::Map<Vec<Space<D>::spin_size>>(contact.row(row) + D) = Space<D>::spin_row(direction, lever);
        contact.drift[static_cast<std::size_t>(row)] =
            direction.dot(Space<D>::centripetal(state.v + body.v + D, arm));
      }
    }
  }
}

void Detector::set_friction(const StateView& state, Constraint& contact) {
  if (!contact.law.has_static_friction()) return;
  contact.friction = contact.law.friction_at(contact.sliding_speed(state.v));
}

template <int D>
void Detector::add(const BodySlot& body, const Feature& feature, const Query& query,
                   std::vector<Constraint>& out) const {
  const Vec<D> off = arm<D>(body, feature, query.evaluation);
  const Vec<D> centre = Eigen::Map<const Vec<D>>(query.state.q + body.q) + off;
  for (Index o = 0; o < obstacles_.size(); ++o) {
    const Obstacle& obstacle = obstacles_[o];
    const GroundMotion* const motion =
        obstacle.moving == none ? nullptr : &query.places->motions_[obstacle.moving];
    const Gap gap = motion == nullptr ? obstacle.kind->gap(obstacle.slot, centre.data())
                                      : obstacle.kind->moved_gap(obstacle.slot, *motion, centre.data());
    const double distance = gap.distance - feature.radius;
    const bool touches = distance <= query.margin;
    if (!touches) {
      if (query.lasting == nullptr) continue;
      double rate = 0.0;  // first a bound on the centripetal acceleration
      if constexpr (Space<D>::has_orientation) {
        if (body.rotation != none) {
          rate = Space<D>::centripetal(query.state.v + body.v + D, off).template lpNorm<1>();
        }
      }
      if constexpr (D == 2) {
        if (motion != nullptr) rate += turning_of(body, off, query.state, *motion, gap.distance);
      }
      const ConstraintKey key{feature.key, {FeatureKey::Owner::obstacle, obstacle.serial, 0}};
      if (!lasts(query, key, distance, rate)) continue;
    }
    Constraint& contact = out.emplace_back();
    fill<D>(body, feature, o, gap, off, query.state, contact);
    if (!touches) contact.allowed_approach = distance / query.lasting->step();
    if constexpr (D == 2) {
      if (motion != nullptr) {
        const GroundMotion* const after =
            query.after == nullptr ? nullptr : &query.after->motions_[obstacle.moving];
        fill_motion(body, feature.radius, off, query.state, *motion, after, contact);
      }
    }
    if (has_static_friction_) set_friction(query.state, contact);
  }
}

void Detector::contact(const ContactPair& pair, const StateView& state, const Evaluation& evaluation,
                       Constraint& out) const {
  if (pair.stop != none) return make_stop(pair.stop, state, evaluation, out);
  const Obstacle& obstacle = obstacles_[pair.obstacle];
  if (obstacle.moving == none) return make_contact(pair, state, evaluation, nullptr, out);
  const GroundMotion now = motion(obstacle, state.time);
  make_contact(pair, state, evaluation, &now, out);
}

void Detector::contact(const ContactPair& pair, const StateView& state, const Evaluation& evaluation,
                       const ObstaclePlaces& places, Constraint& out) const {
  assert(moving_ == 0 || places.time_ == state.time);
  if (pair.stop != none) return make_stop(pair.stop, state, evaluation, out);
  const Index moving = obstacles_[pair.obstacle].moving;
  make_contact(pair, state, evaluation, moving == none ? nullptr : &places.motions_[moving], out);
}

void Detector::make_contact(const ContactPair& pair, const StateView& state, const Evaluation& evaluation,
                            const GroundMotion* motion, Constraint& out) const {
  const BodySlot body = assembly_->layout()->bodies()[pair.body];
  const Feature feature =
      pair.feature == none ? centre_of(body, pair.body, pair.material) : features_[pair.feature];
  const Obstacle& obstacle = obstacles_[pair.obstacle];
  out = {};  // it may have held a contact of another body
  const auto with_dimension = [&]<int D>(std::integral_constant<int, D>) {
    const Vec<D> off = arm<D>(body, feature, evaluation);
    const Vec<D> centre = Eigen::Map<const Vec<D>>(state.q + body.q) + off;
    const Gap gap = motion == nullptr ? obstacle.kind->gap(obstacle.slot, centre.data())
                                      : obstacle.kind->moved_gap(obstacle.slot, *motion, centre.data());
    fill<D>(body, feature, pair.obstacle, gap, off, state, out);
    if constexpr (D == 2) {
      if (motion != nullptr) fill_motion(body, feature.radius, off, state, *motion, nullptr, out);
    }
    if (has_static_friction_) set_friction(state, out);
  };
  if (assembly_->layout()->dimension() == 2) {
    with_dimension(std::integral_constant<int, 2>{});
  } else {
    with_dimension(std::integral_constant<int, 3>{});
  }
}

std::vector<ContactPair> Detector::pairs(Index component) const {
  std::vector<ContactPair> out;
  const Touching& touching = of_component_[component];
  const auto append = [&](Index body, Index feature, Index material) {
    for (Index obstacle = 0; obstacle < obstacles_.size(); ++obstacle) {
      out.push_back({body, feature, material, obstacle, none});
    }
  };
  Index next = touching.features.begin;
  const auto append_features_before = [&](Index body) {
    for (; next < touching.features.end && features_[next].body < body; ++next) {
      append(features_[next].body, next, features_[next].material);
    }
  };
  for (Index i = touching.centres.begin; i < touching.centres.end; ++i) {
    for (Index body = centres_[i].bodies.begin; body < centres_[i].bodies.end; ++body) {
      append_features_before(body);
      append(body, none, centres_[i].material);
    }
  }
  append_features_before(none);
  for (Index stop = touching.stops.begin; stop < touching.stops.end; ++stop) {
    out.push_back({stops_[stop].bodies.front(), none, none, none, stop});
  }
  return out;
}

template <int D>
void Detector::find_in(Index component, const Query& query, std::vector<Constraint>& out) const {
  // Centres are looked at so many at a time; fewer, and one by one, only where any of them touches.
  constexpr Index many = 64, few = 8;
  const auto& bodies = assembly_->layout()->bodies();
  const Touching& touching = of_component_[component];
  Index next = touching.features.begin;
  const auto add_features_before = [&](Index body) {
    for (; next < touching.features.end && features_[next].body < body; ++next) {
      add<D>(bodies[features_[next].body], features_[next], query, out);
    }
  };
  const auto any_touches = [&](Range some) {
    if (query.lasting != nullptr && query.lasting->any_centre(some)) return true;
    const BodySlot slot = bodies[some.begin];
    const double* const points = query.state.q + slot.q;
    return std::any_of(obstacles_.begin(), obstacles_.end(), [&](const Obstacle& obstacle) {
      if (obstacle.moving == none) {
        return obstacle.kind->any_within(obstacle.slot, points, slot.q_size, some.size(), query.margin);
      }
      return obstacle.kind->any_within_moved(obstacle.slot, query.places->motions_[obstacle.moving], points,
                                             slot.q_size, some.size(), query.margin);
    });
  };
  const auto in_parts = [](Range all, Index size, auto&& f) {
    for (Index first = all.begin; first < all.end; first += size) {
      f(Range{first, std::min(first + size, all.end)});
    }
  };
  for (Index i = touching.centres.begin; i < touching.centres.end; ++i) {
    const Centres& centres = centres_[i];
    in_parts(centres.bodies, many, [&](Range part) {
      if (!any_touches(part)) return;
      in_parts(part, few, [&](Range near) {
        if (!any_touches(near)) return;
        for (Index body = near.begin; body < near.end; ++body) {
          add_features_before(body);
          const BodySlot& at = bodies[body];
          add<D>(at, centre_of(at, body, centres.material), query, out);
        }
      });
    });
  }
  add_features_before(none);
}

}  // namespace carom
