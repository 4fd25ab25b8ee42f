// Problem: where the bodies of a model stand when they are moved along their joints, and what touches there.

#include <carom/contact/assembly_gaps.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom {

namespace {

/// Key of a contact while it is opened: two bodies that are moved touch with other features then.
ConstraintKey pair_of(ConstraintKey key) {
  if (key.b.owner == FeatureKey::Owner::body || key.b.owner == FeatureKey::Owner::shape) {
    key.a.feature = key.b.feature = 0;
  }
  return key;
}

}  // namespace

void AssemblyGaps::bind(const MovableBodies& bodies, State& state, Evaluation& evaluation) {
  bodies_.emplace(bodies);
  response_.emplace(bodies.assembly);
  state_ = &state;
  evaluation_ = &evaluation;
  if (lengths_.size() != state.v.size()) lengths_ = bodies.assembly.length_scales();
  wanted_.clear();
  for (const Constraint& contact : bodies.taking_part) wanted_.push_back(pair_of(contact.key));
  std::sort(wanted_.begin(), wanted_.end());
}

std::span<Constraint> AssemblyGaps::find(double margin) {
  contacts_.clear();
  const ContactQuery query{state_->view(), *evaluation_, bodies_->places, nullptr, margin};
  for (const Range components : bodies_->components) bodies_->detector.find(components, query, contacts_);
  if (bodies_->touch) bodies_->detector.find_between_bodies(query, search_, contacts_);
  if (bodies_->all) return contacts_;
  contacts_.remove_if([&](const Constraint& contact) {
    return !std::binary_search(wanted_.begin(), wanted_.end(), pair_of(contact.key));
  });
  return contacts_;
}

Index AssemblyGaps::bodies() const { return static_cast<Index>(bodies_->assembly.layout()->bodies().size()); }

/// The first that joints bind in its component, or itself.
Index AssemblyGaps::first_together(Index body) const {
  const Assembly& assembly = bodies_->assembly;
  if (!assembly.is_jointed(body)) return body;
  Index first = assembly.components()[assembly.component_of(body)].bodies.begin;
  while (!assembly.is_jointed(first)) ++first;
  return first;
}

Range AssemblyGaps::velocities() const {
  const std::vector<Component>& components = bodies_->assembly.components();
  return {components[bodies_->components.front().begin].v.begin,
          components[bodies_->components.back().end - 1].v.end};
}

/// Coordinates of consecutive components.
Range AssemblyGaps::coordinates(Range components) const {
  const std::vector<Component>& all = bodies_->assembly.components();
  return {all[components.begin].q.begin, all[components.end - 1].q.end};
}

/// Rounding of the coordinates of what may be moved; on the closed side a resting body remains in contact.
double AssemblyGaps::rounding() const {
  double size = 1.0;
  for (const Range components : bodies_->components) {
    const Range q = coordinates(components);
    for (Index i = q.begin; i < q.end; ++i) size = std::max(size, std::abs(state_->q[i]));
  }
  return 8.0 * std::numeric_limits<double>::epsilon() * size;
}

void AssemblyGaps::begin() {
  unmoved_.resize(state_->q.size());
  for (const Range components : bodies_->components) {
    const Range q = coordinates(components);
    std::copy(state_->q.begin() + q.begin, state_->q.begin() + q.end, unmoved_.begin() + q.begin);
  }
}

void AssemblyGaps::select(Index body) {
  const Assembly& assembly = bodies_->assembly;
  if (!assembly.is_jointed(body)) return at_hand_.push_back(body);
  const Component& all = assembly.components()[assembly.component_of(body)];
  const auto its =
      std::find_if(bodies_->joints.begin(), bodies_->joints.end(),
                   [&](const JointConstraints* at) { return at->velocities().begin == all.v.begin; });
  if (its == bodies_->joints.end()) return at_hand_.push_back(body);
  if (std::find(mechanisms_.begin(), mechanisms_.end(), *its) != mechanisms_.end()) return;
  mechanisms_.push_back(*its);
  for (Index other = all.bodies.begin; other < all.bodies.end; ++other) {
    if (assembly.is_jointed(other)) at_hand_.push_back(other);
  }
}

std::span<const Range> AssemblyGaps::select(std::span<const Constraint> contacts) {
  at_hand_.clear();
  mechanisms_.clear();
  for (const Constraint& contact : contacts) {
    for (int b = 0; b < contact.bodies; ++b) select(contact.blocks[static_cast<std::size_t>(b)].body);
  }
  std::sort(mechanisms_.begin(), mechanisms_.end(), [](const JointConstraints* a, const JointConstraints* b) {
    return a->velocities().begin < b->velocities().begin;
  });
  std::sort(at_hand_.begin(), at_hand_.end());
  at_hand_.erase(std::unique(at_hand_.begin(), at_hand_.end()), at_hand_.end());
  velocities_.clear();
  for (const Index body : at_hand_) {
    const BodySlot slot = bodies_->assembly.layout()->bodies()[body];
    velocities_.push_back({slot.v, slot.v + slot.v_size});
  }
  return velocities_;
}

BodyResponse& AssemblyGaps::response() {
  response_->bind(mechanisms_);
  return *response_;
}

void AssemblyGaps::move(const double* displacement) {
  const Assembly& assembly = bodies_->assembly;
  for (const Index body : at_hand_) {
    const BodySlot slot = assembly.layout()->bodies()[body];
    moved_.assign(slot.q_size, 0.0);
    assembly.body_kinds()[slot.kind]->advance({slot.slot, slot.slot + 1}, unmoved_.data() + slot.q,
                                              displacement + slot.v, moved_.data());
    std::copy(moved_.begin(), moved_.end(), state_->q.begin() + slot.q);
  }
}

void AssemblyGaps::update() {
  for (const Range components : bodies_->components) {
    for (Index component = components.begin; component < components.end; ++component)
      evaluate_positions(bodies_->assembly, component, state_->view(), *evaluation_);
  }
}

bool AssemblyGaps::is_off(double depth) {
  for (JointConstraints* const joints : mechanisms_) {
    joints->update_gaps({state_->view(), evaluation_->rotation.data()});
    for (std::size_t row = 0; row < joints->size(); ++row) {
      if (std::abs(joints->gaps()[row]) > depth) return true;
    }
  }
  return false;
}

void AssemblyGaps::close_joints(const double* displacement, double* sum) {
  for (JointConstraints* const joints : mechanisms_) {
    joints->update_and_factor({state_->view(), evaluation_->rotation.data()});
    rows_.resize(joints->size());
    joints->residuals(JointLevel::change, displacement, rows_.data());
    for (std::size_t i = 0; i < joints->size(); ++i) rows_[i] = joints->gaps()[i] - rows_[i];
    joints->solve(rows_.data());
    joints->add_response(rows_.data(), sum);
  }
}

Separation separate_all(const Assembly& assembly, const Detector& detector, const GroundPlaces& places,
                        AssemblyGaps& gaps, SolverChain& chain, State& state, Evaluation& evaluation) {
  const auto components = static_cast<Index>(assembly.components().size());
  if (components == 0) return {};
  std::vector<JointConstraints> joints;
  for (Index component = 0; component < components; ++component) {
    append_constraints(assembly, component, joints);
  }
  const std::vector<JointConstraints*> bound = addresses_of(joints);
  const Range every{0, components};
  gaps.bind({.assembly = assembly,
             .detector = detector,
             .places = places,
             .components = {&every, 1},
             .joints = bound,
             .all = true,
             .touch = detector.bodies_touch()},
            state, evaluation);
  return Separator().separate(gaps, chain);
}

}  // namespace carom
