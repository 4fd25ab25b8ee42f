// Problem: the forces of drivers from the motion that they prescribe.

#include <carom/analysis/inverse_dynamics.h>
#include <carom/core/assembly.h>
#include <carom/core/dynamics/joint_closure.h>
#include <carom/core/dynamics/joint_constraints.h>
#include <carom/core/errors.h>
#include <carom/core/part_check.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace carom {

namespace {

/// Drivers have a row, and act on the coordinate of another joint.
template <class F>
void for_drivers(const Assembly& assembly, Index component, F&& f) {
  Index row = 0;
  for (Index kind = 0; kind < assembly.joint_kinds().size(); ++kind) {
    const JointKind& joints = *assembly.joint_kinds()[kind];
    const Range range = assembly.joints(component, kind);
    for (Index joint = range.begin; joint < range.end; ++joint, row += joints.rows()) {
      if (joints.rows() == 1 && joints.on_joint(joint).valid()) f(assembly.joint_id(kind, joint), row);
    }
  }
}

/// Demands that no driver prescribes what follows from other joints.
void check_determined(const Assembly& assembly, const State& state, const std::vector<JointId>& drivers) {
  const auto is_driver = [&](JointId id) {
    return std::find(drivers.begin(), drivers.end(), id) != drivers.end();
  };
  for (const RedundantJoint& redundant : mobility(assembly, state).redundant) {
    JointId driver = redundant.joint;
    if (!is_driver(driver)) {
      const auto found = std::find_if(redundant.with.begin(), redundant.with.end(), is_driver);
      if (found == redundant.with.end()) continue;
      driver = *found;
    }
    SolverFailure failure;
    failure.time = state.time;
    failure.parts.push_back(assembly.system().name(driver));
    std::string message =
        failure.parts.front() + ": its force at t = " + to_text(state.time) + " s is not determined";
    if (driver != redundant.joint) {
      failure.parts.push_back(assembly.system().name(redundant.joint));
      message += ", " + failure.parts.back() + " prescribes the same";
    }
    for (const JointId with : redundant.with) {
      if (with == driver) continue;
      failure.parts.push_back(assembly.system().name(with));
      message += ", " + failure.parts.back() + " prescribes the same";
    }
    throw SolverError(message + "; allowed: drivers that do not depend on each other", std::move(failure));
  }
}

void check_times(std::span<const double> times) {
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (std::isfinite(times[i]) && (i == 0 || times[i] > times[i - 1])) continue;
    throw ModelError("inverse dynamics: time #" + std::to_string(i) + " is " + to_text(times[i]) +
                     " s; allowed: finite and ascending");
  }
}

}  // namespace

std::vector<JointId> drivers(const Assembly& assembly) {
  std::vector<JointId> found;
  for (Index component = 0; component < assembly.components().size(); ++component) {
    for_drivers(assembly, component, [&](JointId id, Index) { found.push_back(id); });
  }
  return found;
}

DriverForces driver_forces(const Assembly& assembly, const State& state) {
  check_state(assembly, state);
  check_determined(assembly, state, drivers(assembly));
  DriverForces result;
  result.state = state;
  result.accelerations.assign(state.v.size(), 0.0);
  Evaluation evaluation = make_evaluation(assembly);
  std::vector<double> multipliers;
  for (Index component = 0; component < assembly.components().size(); ++component) {
    evaluate(assembly, component, state.view(), evaluation);
    assembly.for_bodies(component, [&](const BodyKind& kind, Range slots, Index, Index v, Index) {
      kind.apply_inverse_mass(slots, evaluation.force.data() + v, result.accelerations.data() + v);
    });
    JointConstraints joints(assembly, component);
    if (joints.empty()) continue;
    joints.update_and_factor({state.view(), evaluation.rotation.data()});
    multipliers.resize(joints.size());
    joints.project(JointLevel::acceleration, result.accelerations.data(), multipliers.data());
    for_drivers(assembly, component, [&](JointId, Index row) {
      result.forces.push_back(multipliers[row]);
      result.powers.push_back(multipliers[row] * joints.row(row).times(state.v.data()));
    });
  }
  return result;
}

InverseDynamics inverse_dynamics(const System& system, std::span<const double> times) {
  check_times(times);
  // Drivers say where bodies are: none keeps its place against them.
  System prescribed = system;
  for (const BodyId body : prescribed.bodies()) prescribed.keep_place(body, false);
  const Assembly assembly(std::move(prescribed));
  InverseDynamics result;
  result.drivers = drivers(assembly);
  if (result.drivers.empty()) throw ModelError("inverse dynamics: no driver; allowed: a system with drivers");

  State state = assembly.initial_state();
  for (const double time : times) {
    if (!result.samples.empty()) {
      // From the sample before as if accelerations stayed what they were.
      const DriverForces& last = result.samples.back();
      const double passed = time - last.state.time;
      std::vector<double> change(state.v.size());
      for (std::size_t i = 0; i < change.size(); ++i) {
        change[i] = passed * (last.state.v[i] + 0.5 * passed * last.accelerations[i]);
        state.v[i] = last.state.v[i] + passed * last.accelerations[i];
      }
      for (Index component = 0; component < assembly.components().size(); ++component) {
        assembly.for_bodies(component, [&](const BodyKind& kind, Range slots, Index q, Index v, Index) {
          kind.advance(slots, last.state.q.data() + q, change.data() + v, state.q.data() + q);
        });
      }
    }
    state.time = time;
    close_joints(assembly, state);
    const Index freedom = result.samples.empty() ? mobility(assembly, state).degrees_of_freedom : 0;
    if (freedom > 0) {
      throw ModelError("inverse dynamics: joints and drivers leave " + std::to_string(freedom) +
                       " degrees of freedom; allowed: motions that are prescribed completely");
    }
    result.samples.push_back(driver_forces(assembly, state));
  }
  return result;
}

}  // namespace carom
