#include <carom/contact/detection/point_contacts.h>
#include <carom/contact/detection/points_in_order.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <type_traits>

namespace carom {

namespace {

/// A look at so many points together is not worth while.
constexpr Index hardly_any = 2;

/// Calls f(dimension of space).
template <class F>
void in_dimension(const Assembly& assembly, F&& f) {
  if (assembly.layout()->dimension() == 2) {
    f(std::integral_constant<int, 2>{});
  } else {
    f(std::integral_constant<int, 3>{});
  }
}

template <class F>
void for_parts(Range all, Index size, F&& f) {
  for (Index first = all.begin; first < all.end; first += size) {
    f(Range{first, std::min(first + size, all.end)});
  }
}

}  // namespace

PointContacts::PointContacts(const Assembly& assembly, const GroundShapes& shapes, const ContactLaws& laws)
    : assembly_(&assembly),
      shapes_(&shapes),
      laws_(&laws),
      features_(shapes.empty() ? BodyFeatures() : BodyFeatures(assembly)),
      touched_(assembly, features_, shapes, laws),
      needs_rotations_(features_.any_off_centre()) {}

void PointContacts::find(Range components, const ContactQuery& query, ConstraintSet& out) const {
  in_dimension(*assembly_, [&](auto d) { find_in<d()>(components, query, out); });
}

void PointContacts::find_of(Index body, const ContactQuery& query, ConstraintSet& out) const {
  const Index component = assembly_->component_of(body);
  const BodySlot slot = assembly_->layout()->bodies()[body];
  const auto add_point = [&](const BodyFeature& point) {
    in_dimension(*assembly_, [&](auto d) { add<d()>(slot, point, all_shapes, query, out); });
  };
  for_runs({component, component + 1}, [&](const CentreRun& run) {
    if (run.points != none || body < run.bodies.begin || body >= run.bodies.end) return;
    add_point(BodyFeature::at_centre(slot, body, run.material));
  });
  const Range own = features_.of({component, component + 1}).points;
  const auto points = features_.points().begin();
  const auto before = [](const BodyFeature& point, Index of) { return point.body < of; };
  for (auto point = std::lower_bound(points + own.begin, points + own.end, body, before);
       point != points + own.end && point->body == body; ++point) {
    add_point(*point);
  }
}

Index PointContacts::material_of(const CentreRun& centres) const {
  return centres.points == none ? centres.material : features_.points()[centres.points].material;
}

bool PointContacts::find_near(Range bodies, const CentreRun& centres, const ContactQuery& query,
                              ShapesOfEach& near) const {
  const LastingContacts* const lasting = query.lasting;
  const bool bare = centres.points == none;
  if (lasting != nullptr &&
      (bare ? lasting->any_centre(bodies) : shapes_->any_moves() || lasting->keeps_pressed())) {
    std::fill_n(near.begin(), bodies.size(), all_shapes);
    return true;
  }
  std::fill_n(near.begin(), bodies.size(), 0);
  const std::uint64_t all_bodies = ~std::uint64_t{0} >> (PointRow::most - bodies.size());
  const double margin = centres.reach(query.margin + (lasting == nullptr ? 0.0 : lasting->slack()));
  const BodySlot slot = assembly_->layout()->bodies()[bodies.begin];
  const PointRow row{query.state.q + slot.q, slot.q_size, bodies.size()};
  const std::span<const TouchedShape> touched = touched_.by(material_of(centres));
  std::uint64_t any = 0;
  for (std::size_t place = 0; place < touched.size(); ++place) {
    const Index shape = touched[place].shape;
    // Contacts with curved shapes last beyond the margin where turning explains it.
    const bool may_be_open = lasting != nullptr && !bare && !shapes_->is_flat(shape);
    std::uint64_t within =
        may_be_open ? all_bodies
                    : shapes_->points_within(shape, shapes_->motion(shape, query.places), row, margin);
    any |= within;
    if (within == all_bodies) {  // bodies in a row on a floor: without a loop over bits
      for (Index i = 0; i < bodies.size(); ++i) near[i] |= bit_of(place);
      continue;
    }
    for (; within != 0; within &= within - 1) {
      near[static_cast<std::size_t>(std::countr_zero(within))] |= bit_of(place);
    }
  }
  return any != 0;
}

/// Calls f(run) for the centres of some components.
template <class F>
void PointContacts::for_runs(Range components, F&& f) const {
  const Range all = assembly_->bodies_of(components), own = features_.of(components).centres;
  for (Index i = own.begin; i < own.end; ++i) {
    CentreRun run = features_.centres()[i];
    const Index first = std::max(all.begin, run.bodies.begin);
    if (run.points != none) run.points += first - run.bodies.begin;
    run.bodies = {first, std::min(all.end, run.bodies.end)};
    f(run);
  }
}

bool PointContacts::any_near(Range components, const ContactQuery& query) const {
  Index others = features_.of(components).points.size();  // beside centres
  bool any = false;
  for_runs(components, [&](const CentreRun& run) {
    if (run.points != none) others -= run.bodies.size();
    for_parts(run.bodies, PointRow::most, [&](Range part) {
      ShapesOfEach near;
      any = any || find_near(part, run, query, near);
    });
  });
  return any || others > 0;
}

/// True if no body of some runs touches at its bare centre.
bool PointContacts::only_points(Range runs) const {
  for (Index i = runs.begin; i < runs.end; ++i) {
    if (features_.centres()[i].points == none) return false;
  }
  return true;
}

template <int D>
void PointContacts::find_in(Range components, const ContactQuery& query, ConstraintSet& out) const {
  const BodyFeatures::OfComponents own = features_.of(components);
  if (own.points.size() > hardly_any || !only_points(own.centres)) {
    return find_among<D>(components, query, out);
  }
  for (Index i = own.points.begin; i < own.points.end; ++i) {
    const BodyFeature& point = features_.points()[i];
    add<D>(assembly_->layout()->bodies()[point.body], point, all_shapes, query, out);
  }
}

/// Many centres are looked at together.
template <int D>
void PointContacts::find_among(Range components, const ContactQuery& query, ConstraintSet& out) const {
  const BodySlots& bodies = assembly_->layout()->bodies();
  const std::vector<BodyFeature>& points = features_.points();
  PointsInOrder rest(points, features_.of(components).points);
  const auto add_point = [&](Index i) { add<D>(bodies[points[i].body], points[i], all_shapes, query, out); };
  for_runs(components, [&](const CentreRun& centres) {
    const bool rounded = centres.points != none;
    if (rounded) {
      rest.before(centres.bodies.begin, add_point);
      rest.skip_to(centres.points + centres.bodies.size());
    }
    const auto add_body = [&](Index body, const BodySlot& at, ShapeBits near) {
      if (rounded)
        return add<D>(at, points[centres.points + (body - centres.bodies.begin)], near, query, out);
      rest.before(body, add_point);
      add<D>(at, BodyFeature::at_centre(at, body, centres.material), near, query, out);
    };
    for_parts(centres.bodies, PointRow::most, [&](Range part) {
      ShapesOfEach near;
      if (part.size() <= hardly_any) {
        std::fill_n(near.begin(), part.size(), all_shapes);
      } else if (!find_near(part, centres, query, near)) {
        return;
      }
      bodies.for_range(part, [&](Index body, const BodySlot& at) {
        if (const ShapeBits shapes = near[body - part.begin]; shapes != 0) add_body(body, at, shapes);
      });
    });
  });
  rest.before(none, add_point);
}

template <int D>
void PointContacts::add(const BodySlot& body, const BodyFeature& feature, ShapeBits shapes,
                        const ContactQuery& query, ConstraintSet& out) const {
  const PlacedFeature<D> at = place_feature<D>(body, feature, query.state, query.evaluation);
  const std::span<const TouchedShape> touched = touched_.by(feature.material);
  for (std::size_t place = 0; place < touched.size(); ++place) {
    if ((shapes & bit_of(place)) == 0) continue;
    const Index shape = touched[place].shape;
    const GroundMotion* const motion = shapes_->motion(shape, query.places);
    const Gap gap = shapes_->gap(shape, motion, at.centre.data());
    const double distance = gap.distance - feature.radius;
    const bool touches = !(distance > query.margin);  // no number: that is told where it is used
    if (!touches) {
      if (query.lasting == nullptr) continue;
      double turning = turning_bound(at, query.state, motion, gap.distance);
      if constexpr (D == 2) {
        if (!shapes_->is_flat(shape)) {
          turning += std::abs(curvature_drift(at, query.state, *shapes_, shape, motion)[0]);
        }
      }
      if (!query.lasting->lasts({feature.key, shapes_->key(shape)}, distance, turning)) continue;
    }
    if (query.leaves_out && query.leaves_out(feature.body, {feature.key, shapes_->key(shape)})) continue;
    GroundAtEnd end = query.end_of(*shapes_, shape);
    if (!shapes_->is_flat(shape)) end.step = 0.0;  // where it is touched then is not known
    Constraint& contact = out.add_contact();
    fill(at, touched[place], gap, query.state, motion, end, contact);
    if (!touches) contact.allowed_approach = distance / query.lasting->step();
  }
}

template <int D>
void PointContacts::fill(const PlacedFeature<D>& at, const TouchedShape& touched, const Gap& gap,
                         const StateView& state, const GroundMotion* motion, const GroundAtEnd& end,
                         Constraint& out) const {
  const Index shape = touched.shape;
  if (at.centre.allFinite()) shapes_->demand_numbers(shape, gap, at.centre.data(), state.time);
  out.key = {at.feature.key, shapes_->key(shape)};
  out.law = (*laws_)[touched.law];
  out.friction = out.law.friction;
  fill_rows(at, gap, state, out);
  if constexpr (D == 2) {
    if (motion != nullptr) add_ground_motion(at, state, *motion, end, out);
    if (!shapes_->is_flat(shape)) {
      const std::array<double, 2> curved = curvature_drift(at, state, *shapes_, shape, motion);
      out.drift[0] += curved[0];
      out.drift[1] += curved[1];
    }
    if (const double speed = shapes_->surface_speed(shape); speed != 0.0) {
      out.surface_velocity[1] += speed;
      out.surface_velocity_after[1] += speed;
    }
  }
  if (out.law.has_static_friction()) out.friction = out.law.friction_at(out.sliding_speed(state.v));
}

void PointContacts::contact(const ContactPair& pair, const StateView& state, const Evaluation& evaluation,
                            const GroundMotion* motion, Constraint& out) const {
  const BodySlot body = assembly_->layout()->bodies()[pair.body];
  const BodyFeature feature =
      pair.feature == none ? BodyFeature::at_centre(body, pair.body, none) : features_.points()[pair.feature];
  out.start_contact();
  in_dimension(*assembly_, [&]<int D>(std::integral_constant<int, D>) {
    const PlacedFeature<D> at = place_feature<D>(body, feature, state, evaluation);
    const Gap gap = shapes_->gap(pair.ground_shape, motion, at.centre.data());
    fill(at, {pair.ground_shape, pair.law}, gap, state, motion, {}, out);
  });
}

std::size_t PointContacts::count_pairs(Range components) const {
  std::size_t pairs = 0;
  const auto add = [&](Index points, Index material) { pairs += points * touched_.by(material).size(); };
  for_runs(components, [&](const CentreRun& centres) {
    if (centres.points == none) add(centres.bodies.size(), centres.material);
  });
  const Range own = features_.of(components).points;
  for (Index i = own.begin; i < own.end; ++i) add(1, features_.points()[i].material);
  return pairs;
}

void PointContacts::append_pairs(Index component, std::vector<ContactPair>& out) const {
  const auto append = [&](Index body, Index feature, Index material) {
    for (const TouchedShape& touched : touched_.by(material)) {
      out.push_back({.body = body, .feature = feature, .law = touched.law, .ground_shape = touched.shape});
    }
  };
  const std::vector<BodyFeature>& points = features_.points();
  const auto append_point = [&](Index i) { append(points[i].body, i, points[i].material); };
  const Range own{component, component + 1};
  PointsInOrder rest(points, features_.of(own).points);
  for_runs(own, [&](const CentreRun& centres) {
    if (centres.points != none) return;  // they are among the points
    for (Index body = centres.bodies.begin; body < centres.bodies.end; ++body) {
      rest.before(body, append_point);
      append(body, none, centres.material);
    }
  });
  rest.before(none, append_point);
}

}  // namespace carom
