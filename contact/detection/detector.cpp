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
  if (!pieces_.empty()) {
    for (Index component = components.begin; component < components.end; ++component) {
      ground_.find({component, component + 1}, query, out);
      pieces_.find(component, query, out);
      if (!joints_.empty()) joints_.find_limits(component, query, out);
    }
    return;
  }
  ground_.find(components, query, out);
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
  const GroundShapes& shapes = ground_.shapes();
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
    if (no_slack && !shapes.any_moves() && pieces_.empty()) continue;
    const Index shape = shapes.find(key.b.serial);
    if (shape != none && shapes.has_pieces(shape)) {
      out.add(key, pressed);
      continue;
    }
    const BodyId body{key.a.serial, layout.token()};
    if (shape == none || !layout.contains(body)) continue;
    if (no_slack && !shapes.moves(shape)) continue;
    out.add(key, pressed, layout.index(body));
  }
  out.finish();
}

void Detector::find_all(const ContactQuery& query, BodyContactSearch& memory, ConstraintSet& out) const {
  find(Range{0, static_cast<Index>(assembly_->components().size())}, query, out);
  if (bodies_touch()) bodies_.find(query, memory, out);
}

std::vector<ContactPair> Detector::pairs(Index component) const {
  std::vector<ContactPair> out;
  ground_.append_pairs(component, out);
  if (!pieces_.empty()) {
    pieces_.append_pairs(component, out);
    std::stable_sort(out.begin(), out.end(),
                     [](const ContactPair& a, const ContactPair& b) { return a.body < b.body; });
  }
  joints_.append_limits(component, out);
  return out;
}

void Detector::contact(const ContactPair& pair, const StateView& state, const Evaluation& evaluation,
                       const GroundPlaces& places, Constraint& out) const {
  assert(!has_moving_ground() || places.time() == state.time);
  if (pair.rolling) {
    ContactPair resisted = pair;
    resisted.rolling = false;
    contact(resisted, state, evaluation, places, out);
    write_rolling_resistance(out, motion_of(*this, pair, places), out);
    return;
  }
  if (pair.joint_row != none) return joints_.constraint(pair.joint_row, state, evaluation, out);
  if (pair.has_outline()) return write_contact(sides(pair, state, evaluation, places), state, out);
  ground_.contact(pair, state, evaluation, ground_.shapes().motion(pair.ground_shape, places), out);
}

PairSides Detector::sides(const ContactPair& pair, const StateView& state, const Evaluation& evaluation,
                          const GroundPlaces& places) const {
  if (!pair.is_of_pieces()) return bodies_.sides(pair, state, evaluation);
  return pieces_.sides(pair, state, evaluation, places);
}

std::string Detector::name(const ConstraintKey& key) const { return contact_name(assembly_->system(), key); }

std::optional<ContactPair> pair_of(const Detector& detector, const ConstraintKey& key) {
  if (key.b.owner == FeatureKey::Owner::obstacle) return detector.pieces().pair_of(key);
  return detector.bodies().outlines().pair_of(key);
}

void follow(const Detector& detector, const ContactPair& pair, Index feature, const StateView& state,
            const Evaluation& evaluation, const GroundPlaces& places, Constraint& contact) {
  follow(detector.sides(pair, state, evaluation, places), feature, contact);
}

OutlinePair outline_pair(const Detector& detector, const ContactPair& pair, const StateView& state,
                         const Evaluation& evaluation, const GroundPlaces& places) {
  if (!pair.is_of_pieces()) return detector.bodies().outline_pair(pair, state, evaluation);
  return detector.pieces().outline_pair(pair, state, evaluation, places);
}

}  // namespace carom
