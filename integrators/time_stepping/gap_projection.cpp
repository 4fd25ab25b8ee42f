// Problem: move bodies out of shapes on ground by the smallest displacement.

#include <carom/integrators/time_stepping/gap_projection.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom {

namespace {

/// Gaps are brought to this depth: rounding of the coordinates, on the closed side so that a resting body
/// remains in contact.
double rounding_depth(const Assembly& assembly, Index component, const State& state) {
  const Range q = assembly.components()[component].q;
  double size = 1.0;
  for (Index i = q.begin; i < q.end; ++i) size = std::max(size, std::abs(state.q[i]));
  return 8.0 * std::numeric_limits<double>::epsilon() * size;
}

/// The largest gap of the joints.
double off(JointConstraints& joints, const State& state, const Evaluation& evaluation) {
  joints.update_gaps({state.view(), evaluation.rotation.data()});
  double worst = 0.0;
  for (std::size_t row = 0; row < joints.size(); ++row) worst = std::max(worst, std::abs(joints.gap(row)));
  return worst;
}

/// The first body of a component that a joint binds; `none` if there is none.
Index first_jointed(const Assembly& assembly, Index component) {
  const Range bodies = assembly.components()[component].bodies;
  for (Index body = bodies.begin; body < bodies.end; ++body) {
    if (assembly.is_jointed(body)) return body;
  }
  return none;
}

}  // namespace

/// Contacts near enough to matter, of those that are asked for (both lists are in the detector's order).
void GapProjection::find(Index component, const Detector& detector, const GroundPlaces& places,
                         const Which& which, double margin, const State& state,
                         const Evaluation& evaluation) {
  found_.clear();
  contacts_.clear();
  detector.find(component, state.view(), evaluation, places, nullptr, margin, found_);
  if (which.all) {
    contacts_ = found_;
    return;
  }
  auto wanted = which.taking_part.begin();
  for (const Constraint& contact : found_) {
    auto at = wanted;
    while (at != which.taking_part.end() && at->key != contact.key) ++at;
    if (at == which.taking_part.end()) continue;  // has not taken part
    wanted = at + 1;
    contacts_.push_back(contact);
  }
}

GapProjection::Result GapProjection::project(const Assembly& assembly, Index component,
                                             const Detector& detector, const GroundPlaces& places,
                                             const Which& which, SolverChain& chain, State& state,
                                             Evaluation& evaluation, JointConstraints& joints) {
  // Gaps are linear in the coordinates but for turning bodies, where each pass squares what is left.
  constexpr int most_passes = 20;
  const double depth = rounding_depth(assembly, component, state);
  const Component& range = assembly.components()[component];
  if (lengths_.size() != state.v.size()) lengths_ = assembly.length_scales();
  unmoved_.resize(state.q.size());
  displacement_.resize(state.v.size());
  std::copy(state.q.begin() + range.q.begin, state.q.begin() + range.q.end, unmoved_.begin() + range.q.begin);
  std::fill(displacement_.begin() + range.v.begin, displacement_.begin() + range.v.end, 0.0);
  Result result{.depth = depth};
  for (int pass = 0; pass < most_passes; ++pass) {
    // Bodies may have been moved too far: those contacts are open now, and looked at too.
    find(component, detector, places, which, 2.0 * result.shift, state, evaluation);
    // Bodies that joints bind move together.
    const Index jointed = first_jointed(assembly, component);
    const auto islands =
        partition_.arrange(std::span(contacts_), static_cast<Index>(assembly.layout()->bodies().size()),
                           [&](Index body) { return assembly.is_jointed(body) ? jointed : body; });
    result.left = nullptr;
    double worst = 2.0 * depth;
    bool improved = false;
    for (const Range island : islands) {
      const std::span<const Constraint> of_body(contacts_.data() + island.begin, island.size());
      const BodySlot body = assembly.layout()->bodies()[of_body.front().body()];
      const bool bound = assembly.is_jointed(of_body.front().body());
      const Range own = bound ? range.v : Range{body.v, body.v + body.v_size};
      const bool moved = std::any_of(displacement_.begin() + own.begin, displacement_.begin() + own.end,
                                     [](double number) { return number != 0.0; });
      for (const Constraint& contact : of_body) {
        if (-contact.gap <= worst) continue;
        worst = -contact.gap;
        result.left = &contact;
        result.together = of_body;
      }
      const bool deep = std::any_of(of_body.begin(), of_body.end(),
                                    [&](const Constraint& at) { return at.gap < -2.0 * depth; });
      const bool open = moved && std::all_of(of_body.begin(), of_body.end(),
                                             [](const Constraint& at) { return at.gap > 0.0; });
      // Where turning bodies have been moved far their joints are off by the square of it.
      const bool loose = bound && moved && off(joints, state, evaluation) > 2.0 * depth;
      if (deep || open || loose) {
        const bool better =
            bound ? move_bound(assembly, component, of_body, chain, state, evaluation, depth, joints)
                  : move_body(assembly, of_body, chain, state, depth);
        improved = better || improved;
      }
    }
    if (!improved) return result;
    result.moved = true;
    for (Index i = range.v.begin; i < range.v.end; ++i) {
      result.shift = std::max(result.shift, std::abs(displacement_[i]) * lengths_[i]);
    }
    evaluate_positions(assembly, component, state.view(), evaluation);
  }
  return result;
}

/// W = G B G^T of the normal rows, each with P >= 0.
void GapProjection::state_problem(std::span<const Constraint> contacts, BodyResponse& response) {
  normals_.clear();
  for (const Constraint& contact : contacts) normals_.push_back({&contact, 0});
  delassus_.build(normals_, response);
  problem_.reset(static_cast<int>(contacts.size()));
  delassus_.write(problem_.matrix().data());
  problem_.group();
  multipliers_.assign(contacts.size(), 0.0);
}

bool GapProjection::move_body(const Assembly& assembly, std::span<const Constraint> contacts,
                              SolverChain& chain, State& state, double depth) {
  const BodySlot& body = assembly.layout()->bodies()[contacts.front().body()];
  const BodyKind& kind = *assembly.body_kinds()[body.kind];
  const std::size_t columns = body.v_size;
  double* const displacement = displacement_.data() + body.v;
  MassResponse masses(assembly);
  state_problem(contacts, masses);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    problem_.vector()[i] = contacts[i].gap + depth - contacts[i].times(0, displacement_.data());
  }
  if (!chain.solve(problem_, multipliers_).usable()) return false;
  std::fill_n(displacement, columns, 0.0);
  delassus_.add_response(multipliers_, displacement_.data());
  moved_.assign(body.q_size, 0.0);
  kind.advance({body.slot, body.slot + 1}, unmoved_.data() + body.q, displacement, moved_.data());
  std::copy(moved_.begin(), moved_.end(), state.q.begin() + body.q);
  return true;
}

bool GapProjection::move_bound(const Assembly& assembly, Index component,
                               std::span<const Constraint> contacts, SolverChain& chain, State& state,
                               const Evaluation& evaluation, double depth, JointConstraints& joints) {
  const std::size_t size = state.v.size();
  joints.update_and_factor({state.view(), evaluation.rotation.data()});
  of_joints_.resize(joints.size());
  joints.residuals(JointLevel::change, displacement_.data(), of_joints_.data());
  for (std::size_t i = 0; i < joints.size(); ++i) of_joints_[i] = joints.gap(i) - of_joints_[i];
  joints.solve(of_joints_.data());
  towards_.assign(size, 0.0);
  joints.add_response(of_joints_.data(), towards_.data());
  JointResponse with_joints(joints);
  state_problem(contacts, with_joints);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    problem_.vector()[i] = contacts[i].gap + depth - contacts[i].times(0, displacement_.data()) +
                           contacts[i].times(0, towards_.data());
  }
  if (!chain.solve(problem_, multipliers_).usable()) return false;
  const auto& bodies = assembly.layout()->bodies();
  const Range all = assembly.components()[component].bodies;
  moved_.resize(state.q.size());
  delassus_.add_response(multipliers_, towards_.data());
  for (Index body = all.begin; body < all.end; ++body) {
    if (!assembly.is_jointed(body)) continue;
    const BodySlot slot = bodies[body];
    for (Index k = slot.v; k < slot.v + slot.v_size; ++k) {
      displacement_[k] = towards_[k];
    }
    assembly.body_kinds()[slot.kind]->advance({slot.slot, slot.slot + 1}, unmoved_.data() + slot.q,
                                              displacement_.data() + slot.v, moved_.data() + slot.q);
    std::copy(moved_.begin() + slot.q, moved_.begin() + slot.q + slot.q_size, state.q.begin() + slot.q);
  }
  return true;
}

}  // namespace carom
