// Problem: take errors against the constraints out of a state, and no more than that.

#include <carom/contact/closure.h>

#include <algorithm>
#include <cmath>

namespace carom {

namespace {

/// False near a singular position where positions and velocities obey the joints to rounding. There rounding
/// of the rows, divided by the distance a from the position, would move bodies, and divided by a^2 their
/// velocities: by more than tolerances allow, so that steps of a multistep method would shrink to nothing.
bool leaves(const JointConstraints& joints, Range q, const ClosureInput& in, ClosureMemory& memory) {
  constexpr double near_pivot = 1e-4;  // within some 0.01 rad
  constexpr double rounding = 1e-14;   // of gaps and rates, against the numbers that they are made of
  const auto near = [&](std::size_t row) {
    const double pivot = joints.factors().pivot(row);
    return pivot > dependent_pivot && pivot < near_pivot;
  };
  bool any_near = false;
  for (std::size_t row = 0; row < joints.size() && !any_near; ++row) any_near = near(row);
  if (!any_near) return true;
  const Range v = joints.velocities();
  double extent = 0.0, speed = 0.0;
  for (Index i = q.begin; i < q.end; ++i) extent = std::max(extent, std::abs(in.state.q[i]));
  for (Index i = v.begin; i < v.end; ++i)
    speed = std::max(speed, std::abs(in.state.v[i]) * std::max(memory.lengths[i], 1.0));
  memory.rates.resize(joints.size());
  joints.residuals(JointLevel::velocity, in.state.v, memory.rates.data());
  for (std::size_t row = 0; row < joints.size(); ++row) {
    if (std::abs(joints.gaps()[row]) > rounding * extent) return true;
    if (std::abs(memory.rates[row]) > rounding * speed) return true;
  }
  return false;
}

}  // namespace

ClosureMemory::ClosureMemory(const Assembly& assembly) : lengths(assembly.length_scales()) {
  of_position.resize(lengths.size());
  of_velocity.resize(lengths.size());
  momentum.resize(lengths.size());
}

bool find_closure(const ClosureInput& in, ClosureMemory& memory) {
  std::vector<double>&of_position = memory.of_position, &of_velocity = memory.of_velocity;
  if (in.contacts.list().empty() && in.joints.empty()) return false;
  const std::vector<Component>& components = in.assembly.components();
  for (const Index component : in.components) {
    const Range v = components[component].v;
    std::fill(of_position.begin() + v.begin, of_position.begin() + v.end, 0.0);
    std::fill(of_velocity.begin() + v.begin, of_velocity.begin() + v.end, 0.0);
  }
  for (JointConstraints* const joints : in.joints) {
    const auto begins = [](const Component& component, Index v) { return component.v.begin < v; };
    const Component& all =
        *std::lower_bound(components.begin(), components.end(), joints->velocities().begin, begins);
    if (!leaves(*joints, all.q, in, memory)) continue;
    joints->project(JointLevel::displacement, of_position.data());
    std::copy(in.state.v + all.v.begin, in.state.v + all.v.end, of_velocity.begin() + all.v.begin);
    joints->project(JointLevel::velocity, of_velocity.data());
    for (Index i = all.v.begin; i < all.v.end; ++i) of_velocity[i] -= in.state.v[i];
  }
  return in.contacts.corrections(in.assembly, in.state.v, of_position.data(), of_velocity.data()) ||
         !in.joints.empty();
}

Closure close(const ClosureInput& in, FunctionRef<ClosedPlace(Index)> place_of, ClosureMemory& memory) {
  const std::vector<double>&of_position = memory.of_position, &of_velocity = memory.of_velocity;
  Closure result;
  result.changed = find_closure(in, memory);
  if (!result.changed) return result;
  for (const Index component : in.components) {
    const Range v = in.assembly.components()[component].v;
    for (Index i = v.begin; i < v.end; ++i) {
      result.lost += in.force[i] * of_position[i];
      result.shift = std::max(result.shift, std::abs(of_position[i]) * memory.lengths[i]);
    }
  }
  for (const Index component : in.components) {
    const Index first = in.assembly.components()[component].q.begin;
    double* const out = place_of(component).q;
    in.assembly.for_bodies(component, [&](const BodyKind& kind, Range slots, Index q, Index v, Index) {
      kind.apply_mass(slots, of_velocity.data() + v, memory.momentum.data() + v);
      kind.advance(slots, in.state.q + q, of_position.data() + v, out + (q - first));
    });
  }
  for (const Index component : in.components) {
    const Range v = in.assembly.components()[component].v;
    double* const out = place_of(component).v;
    for (Index i = v.begin; i < v.end; ++i) {
      result.lost -= (in.state.v[i] + 0.5 * of_velocity[i]) * memory.momentum[i];
      result.velocity_energy += 0.5 * of_velocity[i] * memory.momentum[i];
      out[i - v.begin] = in.state.v[i] + of_velocity[i];
    }
  }
  return result;
}

}  // namespace carom
