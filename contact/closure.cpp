// Problem: take errors against the constraints out of a motion, and no more than that.

#include <carom/integrators/event_driven/constraint_projection.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace carom {

namespace {

/// False near a singular position where positions and velocities obey the joints to rounding. There rounding
/// of the rows, divided by the distance a from the position, would move bodies, and divided by a^2 their
/// velocities: by more than tolerances allow, so that steps of a multistep method would shrink to nothing.
bool leaves_joints(const JointConstraints& joints, Range q, const MotionSample& at, MotionMemory& memory) {
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
  for (Index i = q.begin; i < q.end; ++i) extent = std::max(extent, std::abs(at.state.q[i]));
  for (Index i = v.begin; i < v.end; ++i) {
    speed = std::max(speed, std::abs(at.state.v[i]) * std::max(memory.lengths[i], 1.0));
  }
  memory.multipliers.resize(joints.size());
  joints.residuals(JointLevel::velocity, at.state.v.data(), memory.multipliers.data());
  for (std::size_t row = 0; row < joints.size(); ++row) {
    if (std::abs(joints.gaps()[row]) > rounding * extent) return true;
    if (std::abs(memory.multipliers[row]) > rounding * speed) return true;
  }
  return false;
}

}  // namespace

bool find_corrections(SmoothMotion& motion, const MotionSample& at) {
  assert(motion.joints().is_at(at));
  ActiveSet& active = motion.active();
  const GroupJoints& joints = motion.joints().rows();
  if (active.list().empty() && joints.empty()) return false;
  MotionMemory& memory = motion.memory();
  const GroupModel& model = motion.model();
  const Assembly& assembly = *model.assembly;
  std::vector<double>&of_position = memory.of_position, &of_velocity = memory.of_velocity;
  for (const auto& part : model.parts()) {
    const Range v = part.ranges.v;
    std::fill(of_position.begin() + v.begin, of_position.begin() + v.end, 0.0);
    std::fill(of_velocity.begin() + v.begin, of_velocity.begin() + v.end, 0.0);
  }
  for (const GroupJoints::Part& part : joints.parts()) {
    const Component& all = assembly.components()[part.component];
    if (!leaves_joints(*part.joints, all.q, at, memory)) continue;
    part.joints->project(JointLevel::displacement, of_position.data());
    std::copy(at.state.v.begin() + all.v.begin, at.state.v.begin() + all.v.end,
              of_velocity.begin() + all.v.begin);
    part.joints->project(JointLevel::velocity, of_velocity.data());
    for (Index i = all.v.begin; i < all.v.end; ++i) of_velocity[i] -= at.state.v[i];
  }
  return active.corrections(assembly, at.state.v.data(), of_position.data(), of_velocity.data()) ||
         !joints.empty();
}

ConstraintProjection project_onto_constraints(SmoothMotion& motion, const MotionSample& at,
                                              std::span<double> y) {
  ConstraintProjection result;
  result.changed = find_corrections(motion, at);
  if (!result.changed) return result;
  MotionMemory& memory = motion.memory();
  const GroupModel& model = motion.model();
  const std::vector<double>&of_position = memory.of_position, &of_velocity = memory.of_velocity;
  // The potential changes by minus the work of its forces, to first order: the rest is the square of
  // rounding.
  for (const auto& part : model.parts()) {
    const Range v = part.ranges.v;
    for (Index i = v.begin; i < v.end; ++i) {
      result.lost += at.evaluation.force[i] * of_position[i];
      result.shift = std::max(result.shift, std::abs(of_position[i]) * memory.lengths[i]);
    }
  }
  model.for_bodies([&](const BodyKind& kind, Range slots, Index q, Index v, const auto& part) {
    kind.apply_mass(slots, of_velocity.data() + v, memory.held.data() + v);
    kind.advance(slots, at.state.q.data() + q, of_position.data() + v,
                 y.data() + part.q + (q - part.ranges.q.begin));
  });
  for (const auto& part : model.parts()) {
    const Range v = part.ranges.v;
    for (Index i = v.begin; i < v.end; ++i) {
      result.lost -= (at.state.v[i] + 0.5 * of_velocity[i]) * memory.held[i];
      result.velocity_energy += 0.5 * of_velocity[i] * memory.held[i];
      y[part.v + (i - v.begin)] += of_velocity[i];
    }
  }
  return result;
}

std::vector<std::string> causes_of_projection(SmoothMotion& motion, const MotionSample& at) {
  assert(motion.joints().is_at(at));
  // Of the largest impulse: smaller ones are caused by others.
  constexpr double considerable = 0.1;
  MotionMemory& memory = motion.memory();
  const GroupModel& model = motion.model();
  GroupJoints& joints = motion.joints().rows();
  model.unknowns.for_velocities([&](Range v, std::size_t) {
    std::copy(at.state.v.begin() + v.begin, at.state.v.begin() + v.end, memory.of_velocity.begin() + v.begin);
  });
  memory.multipliers.assign(joints.size(), 0.0);
  joints.project(JointLevel::velocity, memory.of_velocity.data(), memory.multipliers.data());
  double largest = 0.0;
  for (const double impulse : memory.multipliers) largest = std::max(largest, std::abs(impulse));
  std::vector<std::string> names;
  for (const GroupJoints::Part& part : joints.parts()) {
    const JointPattern& pattern = part.joints->pattern();
    const double* const multipliers = memory.multipliers.data() + part.first_row;
    for (std::size_t joint = 0; joint < pattern.size(); ++joint) {
      bool takes_part = false;
      for (Index row = pattern.first_row(joint); row < pattern.first_row(joint + 1); ++row) {
        takes_part = takes_part || (largest > 0.0 && std::abs(multipliers[row]) >= considerable * largest);
      }
      if (takes_part) names.push_back(model.assembly->system().name(pattern.id(joint)));
    }
  }
  if (!names.empty()) return names;
  for (const ActiveContact& contact : motion.active().list()) {
    names.push_back(model.detector->name(contact.at.key));
  }
  return names;
}

}  // namespace carom
