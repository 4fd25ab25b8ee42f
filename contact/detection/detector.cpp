#include <carom/contact/detection/contact_name.h>
#include <carom/contact/detection/corner_names.h>
#include <carom/contact/detection/detector.h>
#include <carom/contact/detection/rolling_resistance.h>

#include <algorithm>
#include <cassert>

namespace carom {

void Detector::find(Index component, const StateView& state, const Evaluation& evaluation, double margin,
                    ConstraintSet& out) const {
  GroundPlaces places;
  place(state.time, places);
  find(component, state, evaluation, places, nullptr, margin, out);
}

void Detector::find(Range components, const ContactQuery& query, ConstraintSet& out) const {
  assert(!has_moving_ground() || query.places.time() == query.state.time);
  if (outlines_.ground_touches()) {
    for (Index component = components.begin; component < components.end; ++component) {
      points_.find({component, component + 1}, query, out);
      const Range bodies = assembly_->bodies_of({component, component + 1});
      for (Index body = bodies.begin; body < bodies.end; ++body) on_ground_.find(outlines_, body, query, out);
      if (!joints_.empty()) joints_.find_limits(component, query, out);
    }
    return;
  }
  points_.find(components, query, out);
  if (joints_.empty()) return;
  for (Index component = components.begin; component < components.end; ++component) {
    joints_.find_limits(component, query, out);
  }
}

namespace {

/// Whether a contact had an impulse, and what by its name may be the other contact of the same two corners.
/// Of corners that meet the two follow one another in the list.
LastingContacts::Pressed pressed_of(std::span<const std::pair<ConstraintKey, ContactMode>> contacts,
                                    std::size_t which) {
  const auto is_other = [&](std::size_t i) {
    return contacts[i].second != ContactMode::open &&
           may_be_of_corners(contacts[i].first, contacts[which].first);
  };
  return {contacts[which].second != ContactMode::open,
          (which > 0 && is_other(which - 1)) || (which + 1 < contacts.size() && is_other(which + 1))};
}

}  // namespace

void Detector::remember(std::span<const std::pair<ConstraintKey, ContactMode>> contacts, double step,
                        const OpeningSlack& slack, LastingContacts& out) const {
  out.start(step, slack);
  const bool no_slack = out.slack() == 0.0;
  const Layout& layout = *assembly_->layout();
  const GroundShapes& on_ground = shapes();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const ConstraintKey& key = contacts[i].first;
    const LastingContacts::Pressed pressed = pressed_of(contacts, i);
    const bool of_bodies = key.b.owner != FeatureKey::Owner::obstacle;
    if (key.a.owner != FeatureKey::Owner::body || of_bodies) {
      out.add(key, pressed);
      continue;
    }
    // A centre of mass has no arm: but for slack only a shape that turns, or is curved, can open such a
    // contact.
    if (no_slack && !on_ground.any_moves() && !outlines_.ground_touches()) continue;
    const Index shape = on_ground.find(key.b.serial);
    if (shape != none && on_ground.has_pieces(shape)) {
      out.add(key, pressed);
      continue;
    }
    const BodyId body{key.a.serial, layout.token()};
    if (shape == none || !layout.contains(body)) continue;
    if (no_slack && !on_ground.moves(shape)) continue;
    out.add(key, pressed, layout.index(body));
  }
  out.finish();
}

void Detector::find_all(const ContactQuery& query, BodyContactSearch& memory, ConstraintSet& out) const {
  query.bodies.for_components(*assembly_, [&](Range components) { find(components, query, out); });
  find_between_bodies(query, memory, out);
}

void Detector::find_between_bodies(const ContactQuery& query, BodyContactSearch& memory,
                                   ConstraintSet& out) const {
  for (const Touch& touch : find_body_touches(outlines_, query, memory))
    outlines_.write(touch, query, out.add_contact());
}

void Detector::find_of(Index body, const ContactQuery& query, ConstraintSet& out) const {
  points_.find_of(body, query, out);
  if (outlines_.ground_touches()) on_ground_.find(outlines_, body, query, out);
}

std::vector<ContactPair> Detector::pairs(Index component) const {
  std::vector<ContactPair> out;
  points_.append_pairs(component, out);
  if (outlines_.ground_touches()) {
    on_ground_.append_pairs(outlines_, assembly_->bodies_of({component, component + 1}), out);
    std::stable_sort(out.begin(), out.end(),
                     [](const ContactPair& a, const ContactPair& b) { return a.body < b.body; });
  }
  joints_.append_limits(component, out);
  return out;
}

void Detector::contact(const ContactPair& pair, const StateView& state, const Evaluation& evaluation,
                       const GroundPlaces& places, Constraint& out) const {
  assert(pair.ground_shape == none || !moves(*this, pair) || places.time() == state.time);
  if (pair.rolling) {
    ContactPair resisted = pair;
    resisted.rolling = false;
    contact(resisted, state, evaluation, places, out);
    write_rolling_resistance(out, motion_of(*this, pair, places), out);
    return;
  }
  if (pair.joint_row != none) return joints_.constraint(pair.joint_row, state, evaluation, out);
  if (pair.has_outline()) return write_contact(outlines_.sides(pair, state, evaluation, places), state, out);
  points_.contact(pair, state, evaluation, shapes().motion(pair.ground_shape, places), out);
}

std::string Detector::name(const ConstraintKey& key) const { return contact_name(assembly_->system(), key); }

void follow(const Detector& detector, const ContactPair& pair, Index feature, const StateView& state,
            const Evaluation& evaluation, const GroundPlaces& places, Constraint& contact) {
  follow(detector.outlines().sides(pair, state, evaluation, places), feature, contact);
}

}  // namespace carom
