// Problem: move bodies out of shapes on ground, and apart from each other, by the smallest displacement.

#include <carom/core/dynamics/components_response.h>
#include <carom/integrators/time_stepping/gap_projection.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom {

namespace {

/// Gaps are brought to this depth: rounding of the coordinates, on the closed side so that a resting body
/// remains in contact.
double rounding_depth(const Assembly& assembly, Range components, const State& state) {
  const Index begin = assembly.components()[components.begin].q.begin;
  const Index end = assembly.components()[components.end - 1].q.end;
  double size = 1.0;
  for (Index i = begin; i < end; ++i) size = std::max(size, std::abs(state.q[i]));
  return 8.0 * std::numeric_limits<double>::epsilon() * size;
}

/// Key of a contact while it is opened: two bodies that are moved touch with other features then.
ConstraintKey pair_of(ConstraintKey key) {
  if (key.b.owner == FeatureKey::Owner::body || key.b.owner == FeatureKey::Owner::shape) {
    key.a.feature = key.b.feature = 0;
  }
  return key;
}

/// The first body that answers together with one: the first that joints bind in its component, or itself.
Index first_together(const Assembly& assembly, Index body) {
  if (!assembly.is_jointed(body)) return body;
  Index first = assembly.components()[assembly.component_of(body)].bodies.begin;
  while (!assembly.is_jointed(first)) ++first;
  return first;
}

}  // namespace

/// Contacts near enough to matter, of those that are asked for.
void GapProjection::find(const Bodies& bodies, const Which& which, double margin, const State& state,
                         const Evaluation& evaluation) {
  contacts_.clear();
  const ContactQuery query{state.view(), evaluation, bodies.places, nullptr, margin};
  bodies.detector.find(bodies.components, query, contacts_);
  if (which.of_bodies) bodies.detector.bodies().find(query, search_, contacts_);
  if (which.all) return;
  std::erase_if(contacts_, [&](const Constraint& contact) {
    return !std::binary_search(keys_.wanted.begin(), keys_.wanted.end(), pair_of(contact.key));
  });
}

/// No displacement yet, of some velocities.
void GapProjection::start(const Bodies& bodies, const Which& which, Range v, const State& state) {
  const std::vector<Component>& components = bodies.assembly.components();
  if (lengths_.size() != state.v.size()) lengths_ = bodies.assembly.length_scales();
  const Index first = components[bodies.components.begin].q.begin;
  const Index end = components[bodies.components.end - 1].q.end;
  unmoved_.resize(state.q.size());
  displacement_.resize(state.v.size());
  towards_.resize(state.v.size());
  std::copy(state.q.begin() + first, state.q.begin() + end, unmoved_.begin() + first);
  std::fill(displacement_.begin() + v.begin, displacement_.begin() + v.end, 0.0);
  keys_.pushed.clear();
  keys_.wanted.clear();
  for (const Constraint& contact : which.taking_part) keys_.wanted.push_back(pair_of(contact.key));
  std::sort(keys_.wanted.begin(), keys_.wanted.end());
}

GapProjection::Result GapProjection::project(const Bodies& bodies, const Which& which, SolverChain& chain,
                                             State& state, Evaluation& evaluation) {
  // Gaps are linear in the coordinates but for turning bodies. The least displacement is then found by a part
  // of what is left from pass to pass, the smaller the less it turns; and bodies that are deep in something
  // touch with other features from pass to pass, and may do so without end. So at last each pass moves them
  // by the least from where the one before has left them, which squares what is left.
  constexpr int passes = 20, most_passes = 20 * passes;
  const Assembly& assembly = bodies.assembly;
  const double depth = rounding_depth(assembly, bodies.components, state);
  const Range v{assembly.components()[bodies.components.begin].v.begin,
                assembly.components()[bodies.components.end - 1].v.end};
  start(bodies, which, v, state);
  Result result{.depth = depth};
  for (int pass = 0; pass < most_passes; ++pass) {
    // Bodies may have been moved too far: those contacts are open now, and looked at too.
    find(bodies, which, 2.0 * result.shift, state, evaluation);
    if (pass >= passes) start(bodies, which, v, state);
    const auto islands =
        partition_.arrange(std::span(contacts_), static_cast<Index>(assembly.layout()->bodies().size()),
                           [&](Index body) { return first_together(assembly, body); });
    result.left = nullptr;
    double worst = 2.0 * depth;
    bool improved = false;
    for (const Range island : islands) {
      const std::span<const Constraint> together(contacts_.data() + island.begin, island.size());
      const bool moved = has_moved(bodies, together);
      for (const Constraint& contact : together) {
        if (-contact.gap <= worst) continue;
        worst = -contact.gap;
        result.left = &contact;
        result.together = together;
      }
      const bool deep = std::any_of(together.begin(), together.end(),
                                    [&](const Constraint& at) { return at.gap < -2.0 * depth; });
      // Contacts that push end closed: a pass that moves a body too far leaves them open by the square of
      // the way, and the next step is made without them.
      const bool open = moved && std::any_of(together.begin(), together.end(), [&](const Constraint& at) {
                          return at.gap > 0.0 && has_pushed(at.key);
                        });
      // Where turning bodies have been moved far their joints are off by the square of it.
      if (deep || open || (moved && is_off(state, evaluation, 2.0 * depth))) {
        improved = move(bodies, together, chain, state, evaluation, depth) || improved;
      }
    }
    if (!improved) return result;
    result.moved = true;
    double shift = 0.0;
    for (Index i = v.begin; i < v.end; ++i) shift = std::max(shift, std::abs(displacement_[i]) * lengths_[i]);
    result.shift = pass < passes ? std::max(result.shift, shift) : result.shift + shift;
    for (Index component = bodies.components.begin; component < bodies.components.end; ++component) {
      evaluate_positions(assembly, component, state.view(), evaluation);
    }
  }
  return result;
}

/// Lists the bodies and joints of an island, as those at hand. True if any of them has been moved.
bool GapProjection::has_moved(const Bodies& bodies, std::span<const Constraint> contacts) {
  const Assembly& assembly = bodies.assembly;
  of_island_.clear();
  mechanisms_.clear();
  const auto add = [&](Index body) {
    if (!assembly.is_jointed(body)) return of_island_.push_back(body);
    const Component& all = assembly.components()[assembly.component_of(body)];
    const auto its =
        std::find_if(bodies.joints.begin(), bodies.joints.end(),
                     [&](const JointConstraints* at) { return at->velocities().begin == all.v.begin; });
    if (its == bodies.joints.end()) return of_island_.push_back(body);
    if (std::find(mechanisms_.begin(), mechanisms_.end(), *its) != mechanisms_.end()) return;
    mechanisms_.push_back(*its);
    for (Index other = all.bodies.begin; other < all.bodies.end; ++other) {
      if (assembly.is_jointed(other)) of_island_.push_back(other);
    }
  };
  for (const Constraint& contact : contacts) {
    for (int b = 0; b < contact.bodies; ++b) add(contact.blocks[static_cast<std::size_t>(b)].body);
  }
  std::sort(mechanisms_.begin(), mechanisms_.end(), [](const JointConstraints* a, const JointConstraints* b) {
    return a->velocities().begin < b->velocities().begin;
  });
  std::sort(of_island_.begin(), of_island_.end());
  of_island_.erase(std::unique(of_island_.begin(), of_island_.end()), of_island_.end());
  return std::any_of(of_island_.begin(), of_island_.end(), [&](Index body) {
    const BodySlot slot = assembly.layout()->bodies()[body];
    return std::any_of(displacement_.begin() + slot.v, displacement_.begin() + slot.v + slot.v_size,
                       [](double number) { return number != 0.0; });
  });
}

/// True if a contact pushed in the last pass that moved its bodies.
bool GapProjection::has_pushed(const ConstraintKey& key) const {
  return std::binary_search(keys_.pushed.begin(), keys_.pushed.end(), key);
}

/// Notes which contacts push, by their multipliers.
void GapProjection::note_pushes(std::span<const Constraint> contacts) {
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const auto place = std::lower_bound(keys_.pushed.begin(), keys_.pushed.end(), contacts[i].key);
    const bool is_there = place != keys_.pushed.end() && *place == contacts[i].key;
    if (multipliers_[i] > 0.0 && !is_there) keys_.pushed.insert(place, contacts[i].key);
    if (!(multipliers_[i] > 0.0) && is_there) keys_.pushed.erase(place);
  }
}

/// True if a gap of the joints at hand is larger than `depth`.
bool GapProjection::is_off(const State& state, const Evaluation& evaluation, double depth) const {
  for (JointConstraints* const joints : mechanisms_) {
    joints->update_gaps({state.view(), evaluation.rotation.data()});
    for (std::size_t row = 0; row < joints->size(); ++row) {
      if (std::abs(joints->gaps()[row]) > depth) return true;
    }
  }
  return false;
}

/// d0 of the joints at hand, added to the next displacement.
void GapProjection::close_joints(const State& state, const Evaluation& evaluation) {
  std::vector<double>& rows = moved_;  // not in use yet
  for (JointConstraints* const joints : mechanisms_) {
    joints->update_and_factor({state.view(), evaluation.rotation.data()});
    const Range v = joints->velocities();
    std::fill(towards_.begin() + v.begin, towards_.begin() + v.end, 0.0);
    rows.resize(joints->size());
    joints->residuals(JointLevel::change, displacement_.data(), rows.data());
    for (std::size_t i = 0; i < joints->size(); ++i) rows[i] = joints->gaps()[i] - rows[i];
    joints->solve(rows.data());
    joints->add_response(rows.data(), towards_.data());
  }
}

/// Makes a better estimate for the bodies of the island at hand; false if there is none.
bool GapProjection::move(const Bodies& bodies, std::span<const Constraint> contacts, SolverChain& chain,
                         State& state, const Evaluation& evaluation, double depth) {
  const BodySlots& slots = bodies.assembly.layout()->bodies();
  for (const Index body : of_island_) {
    std::fill_n(towards_.begin() + slots[body].v, slots[body].v_size, 0.0);
  }
  close_joints(state, evaluation);
  // W = G B G^T of the normal rows, each with y >= 0.
  normals_.clear();
  for (const Constraint& contact : contacts) normals_.push_back({&contact, 0});
  ComponentsResponse response(bodies.assembly);
  response.bind(mechanisms_);
  delassus_.build(normals_, response);
  problem_.reset(static_cast<int>(contacts.size()));
  delassus_.write(problem_.matrix().data());
  problem_.group();
  multipliers_.assign(contacts.size(), 0.0);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    problem_.vector()[i] = contacts[i].gap + depth - contacts[i].times(0, displacement_.data()) +
                           contacts[i].times(0, towards_.data());
  }
  if (!chain.solve(problem_, multipliers_).usable()) return false;
  note_pushes(contacts);
  delassus_.add_response(multipliers_, towards_.data());
  for (const Index body : of_island_) {
    const BodySlot slot = slots[body];
    std::copy_n(towards_.begin() + slot.v, slot.v_size, displacement_.begin() + slot.v);
    moved_.assign(slot.q_size, 0.0);
    bodies.assembly.body_kinds()[slot.kind]->advance({slot.slot, slot.slot + 1}, unmoved_.data() + slot.q,
                                                     displacement_.data() + slot.v, moved_.data());
    std::copy(moved_.begin(), moved_.end(), state.q.begin() + slot.q);
  }
  return true;
}

}  // namespace carom
