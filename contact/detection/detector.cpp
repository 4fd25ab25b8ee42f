#include <carom/contact/detection/contact_name.h>
#include <carom/contact/detection/detector.h>

#include <cassert>

namespace carom {

void Detector::find(Index component, const StateView& state, const Evaluation& evaluation, double margin,
                    std::vector<Constraint>& out) const {
  GroundPlaces places;
  place(state.time, places);
  find(component, state, evaluation, places, nullptr, margin, out);
}

void Detector::find(Range components, const ContactQuery& query, std::vector<Constraint>& out) const {
  assert(!has_moving_ground() || query.places.time() == query.state.time);
  ground_.find(components, query, out);
  if (joints_.empty()) return;
  for (Index component = components.begin; component < components.end; ++component) {
    joints_.find_limits(component, query, out);
  }
}

void Detector::remember(std::span<const std::pair<ConstraintKey, ContactMode>> contacts, double step,
                        double slack, LastingContacts& out) const {
  out.start(step, slack);
  const Layout& layout = *assembly_->layout();
  const GroundShapes& shapes = ground_.shapes();
  for (const auto& entry : contacts) {
    const ConstraintKey& key = entry.first;
    const bool of_bodies = key.b.owner != FeatureKey::Owner::obstacle;
    if (key.a.owner != FeatureKey::Owner::body || of_bodies) {
      out.add(key);
      continue;
    }
    // A centre of mass has no arm: but for slack only a shape that turns can open such a contact.
    if (slack == 0.0 && !shapes.any_moves()) continue;
    const Index shape = shapes.find(key.b.serial);
    const BodyId body{key.a.serial, layout.token()};
    if (shape == none || !layout.contains(body)) continue;
    if (slack == 0.0 && !shapes.moves(shape)) continue;
    out.add(key, layout.index(body));
  }
  out.finish();
}

std::vector<ContactPair> Detector::pairs(Index component) const {
  std::vector<ContactPair> out;
  ground_.append_pairs(component, out);
  joints_.append_limits(component, out);
  return out;
}

std::vector<ContactPair> Detector::body_pairs() const {
  std::vector<ContactPair> out;
  bodies_.append_pairs(out);
  return out;
}

std::vector<ContactPair> Detector::joint_friction(Index component) const {
  std::vector<ContactPair> out;
  joints_.append_friction(component, out);
  return out;
}

void Detector::contact(const ContactPair& pair, const StateView& state, const Evaluation& evaluation,
                       Constraint& out) const {
  if (pair.joint_row != none) return joints_.constraint(pair.joint_row, state, evaluation, out);
  if (pair.other != none) return bodies_.contact(pair, state, evaluation, out);
  if (!moves(pair)) return ground_.contact(pair, state, evaluation, nullptr, out);
  const GroundMotion now = ground_.shapes().motion(pair.ground_shape, state.time);
  ground_.contact(pair, state, evaluation, &now, out);
}

void Detector::contact(const ContactPair& pair, const StateView& state, const Evaluation& evaluation,
                       const GroundPlaces& places, Constraint& out) const {
  assert(!has_moving_ground() || places.time() == state.time);
  if (pair.joint_row != none) return joints_.constraint(pair.joint_row, state, evaluation, out);
  if (pair.other != none) return bodies_.contact(pair, state, evaluation, out);
  ground_.contact(pair, state, evaluation, ground_.shapes().motion(pair.ground_shape, places), out);
}

std::string Detector::name(const ConstraintKey& key) const { return contact_name(assembly_->system(), key); }

}  // namespace carom
