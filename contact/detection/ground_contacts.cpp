#include <carom/contact/detection/ground_contacts.h>

#include <algorithm>
#include <type_traits>

namespace carom {

namespace {

/// Walks over the points of one component in step with its bodies.
class PointsInOrder {
public:
  PointsInOrder(const std::vector<BodyFeature>& points, Range range) : points_(points), range_(range) {}

  /// Calls f(number of the point) for those of bodies before `body` that did not come yet.
  template <class F>
  void before(Index body, F&& f) {
    for (; range_.begin < range_.end && points_[range_.begin].body < body; ++range_.begin) f(range_.begin);
  }

private:
  const std::vector<BodyFeature>& points_;
  Range range_;  // still to come
};

template <class F>
void for_parts(Range all, Index size, F&& f) {
  for (Index first = all.begin; first < all.end; first += size) {
    f(Range{first, std::min(first + size, all.end)});
  }
}

}  // namespace

GroundContacts::GroundContacts(const Assembly& assembly)
    : assembly_(&assembly),
      shapes_(assembly.system()),
      features_(shapes_.empty() ? BodyFeatures() : BodyFeatures(assembly)),
      laws_(assembly, features_, shapes_) {}

void GroundContacts::find(Index component, const ContactQuery& query, std::vector<Constraint>& out) const {
  if (assembly_->layout()->dimension() == 2) {
    find_in<2>(component, query, out);
  } else {
    find_in<3>(component, query, out);
  }
}

bool GroundContacts::any_touches(Range bodies, const ContactQuery& query) const {
  if (query.lasting != nullptr && query.lasting->any_centre(bodies)) return true;
  const BodySlot slot = assembly_->layout()->bodies()[bodies.begin];
  const PointRow row{query.state.q + slot.q, slot.q_size, bodies.size()};
  for (Index shape = 0; shape < shapes_.size(); ++shape) {
    if (shapes_.any_within(shape, shapes_.motion(shape, query.places), row, query.margin)) return true;
  }
  return false;
}

template <int D>
void GroundContacts::find_in(Index component, const ContactQuery& query, std::vector<Constraint>& out) const {
  // Centres are looked at so many at a time; fewer, and one by one, only where any of them touches.
  constexpr Index many = 64, few = 8;
  const BodySlots& bodies = assembly_->layout()->bodies();
  const std::vector<BodyFeature>& points = features_.points();
  const BodyFeatures::OfComponent own = features_.of(component);
  PointsInOrder rest(points, own.points);
  const auto add_point = [&](Index i) { add<D>(bodies[points[i].body], points[i], query, out); };
  for (Index i = own.centres.begin; i < own.centres.end; ++i) {
    const CentreRun& centres = features_.centres()[i];
    for_parts(centres.bodies, many, [&](Range part) {
      if (!any_touches(part, query)) return;
      for_parts(part, few, [&](Range near) {
        if (near.size() < part.size() && !any_touches(near, query)) return;
        for (Index body = near.begin; body < near.end; ++body) {
          rest.before(body, add_point);
          const BodySlot at = bodies[body];
          add<D>(at, BodyFeature::at_centre(at, body, centres.material), query, out);
        }
      });
    });
  }
  rest.before(none, add_point);
}

template <int D>
void GroundContacts::add(const BodySlot& body, const BodyFeature& feature, const ContactQuery& query,
                         std::vector<Constraint>& out) const {
  const PlacedFeature<D> at = place_feature<D>(body, feature, query.state, query.evaluation);
  for (Index shape = 0; shape < shapes_.size(); ++shape) {
    const GroundMotion* const motion = shapes_.motion(shape, query.places);
    const Gap gap = shapes_.gap(shape, motion, at.centre.data());
    const double distance = gap.distance - feature.radius;
    const bool touches = distance <= query.margin;
    if (!touches) {
      if (query.lasting == nullptr) continue;
      const double turning = turning_bound(at, query.state, motion, gap.distance);
      if (!query.lasting->lasts({feature.key, shapes_.key(shape)}, distance, turning)) continue;
    }
    const GroundMotion* const after = query.after == nullptr ? nullptr : shapes_.motion(shape, *query.after);
    Constraint& contact = out.emplace_back();
    fill(at, shape, gap, query.state, motion, after, contact);
    if (!touches) contact.allowed_approach = distance / query.lasting->step();
  }
}

template <int D>
void GroundContacts::fill(const PlacedFeature<D>& at, Index shape, const Gap& gap, const StateView& state,
                          const GroundMotion* motion, const GroundMotion* after, Constraint& out) const {
  out.key = {at.feature.key, shapes_.key(shape)};
  out.law = laws_.law(at.feature.material, shape);
  out.friction = out.law.friction;
  fill_rows(at, gap, state, out);
  if constexpr (D == 2) {
    if (motion != nullptr) add_ground_motion(at, state, *motion, after, out);
  }
  if (out.law.has_static_friction()) out.friction = out.law.friction_at(out.sliding_speed(state.v));
}

void GroundContacts::contact(const ContactPair& pair, const StateView& state, const Evaluation& evaluation,
                             const GroundMotion* motion, Constraint& out) const {
  const BodySlot body = assembly_->layout()->bodies()[pair.body];
  const BodyFeature feature = pair.feature == none ? BodyFeature::at_centre(body, pair.body, pair.material)
                                                   : features_.points()[pair.feature];
  out = {};  // it may have held a contact of another body
  const auto with_dimension = [&]<int D>(std::integral_constant<int, D>) {
    const PlacedFeature<D> at = place_feature<D>(body, feature, state, evaluation);
    const Gap gap = shapes_.gap(pair.ground_shape, motion, at.centre.data());
    fill(at, pair.ground_shape, gap, state, motion, nullptr, out);
  };
  if (assembly_->layout()->dimension() == 2) {
    with_dimension(std::integral_constant<int, 2>{});
  } else {
    with_dimension(std::integral_constant<int, 3>{});
  }
}

void GroundContacts::append_pairs(Index component, std::vector<ContactPair>& out) const {
  const auto append = [&](Index body, Index feature, Index material) {
    for (Index shape = 0; shape < shapes_.size(); ++shape) {
      out.push_back({body, feature, material, shape, none});
    }
  };
  const std::vector<BodyFeature>& points = features_.points();
  const auto append_point = [&](Index i) { append(points[i].body, i, points[i].material); };
  const BodyFeatures::OfComponent own = features_.of(component);
  PointsInOrder rest(points, own.points);
  for (Index i = own.centres.begin; i < own.centres.end; ++i) {
    const CentreRun& centres = features_.centres()[i];
    for (Index body = centres.bodies.begin; body < centres.bodies.end; ++body) {
      rest.before(body, append_point);
      append(body, none, centres.material);
    }
  }
  rest.before(none, append_point);
}

}  // namespace carom
