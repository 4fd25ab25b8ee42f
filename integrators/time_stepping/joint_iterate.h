#pragma once

/// \file
/// Iterate of the joints of one component in a step: impulses L, what they do to velocities, the displacement
/// d back onto the joints; and the pieces that every sweep is made of.

#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/integrators/time_stepping/step_input.h>
#include <carom/integrators/time_stepping/step_joint_rows.h>
#include <carom/integrators/time_stepping/step_rule.h>
#include <carom/integrators/time_stepping/step_trial.h>

#include <algorithm>
#include <vector>

namespace carom {

/// Arrays over all velocities or coordinates of a model with joints; a component uses its part.
struct JointArrays {
  explicit JointArrays(const Assembly& assembly);

  std::vector<double> dv_joints;           ///< changes of velocity by reactions
  std::vector<double> dv_contact;          ///< by contact
  std::vector<double> displacement;        ///< back onto the joints
  std::vector<double> scratch;             ///< between two lines
  std::vector<double> before_q, before_v;  ///< the iterate before
  std::vector<double> allowed;             ///< v_{j+1} as contact of bodies with joints sees it
  std::vector<double> lengths;             ///< Assembly::length_scales()
};

/// How far velocities and positions are from obeying the joints, in units of JointIterate::rounding.
struct JointViolation {
  double velocity = 0.0;  ///< of velocities along the rows, of the largest row; 0 along mean rows
  double gap = 0.0;       ///< of gaps, of the extent of the positions
  /// The larger.
  [[nodiscard]] double worst() const { return std::max(velocity, gap); }
};

/// The iterate of one component. Keeps memory.
struct CAROM_API JointIterate {
  /// \param shared arrays of all components; must outlive it
  JointIterate(const Assembly& model, Index which, JointArrays& shared);

  /// Velocities of the component.
  [[nodiscard]] Range v() const { return assembly->components()[component].v; }
  /// Zeroes the part of the component.
  void clear(std::vector<double>& numbers) const;
  /// Velocities at the end without joints and contact, by the guess at the loads.
  void find_free_velocities(const StepInput& in, const StepRule& rule, StepTrial& trial) const;
  /// One step of Newton's method for G1 v_{j+1} + rate = 0; along mean rows for g(q_{j+1}, t_{j+1}) = 0.
  void correct_impulses(const StepInput& in, const StepTrial& trial);
  /// Changes of velocity by the impulses along the rows of the reactions.
  void find_reactions();
  /// Brings the rows to the iterate, and factors them. Its coordinates and velocities are kept as those of
  /// the iterate before the next one.
  /// \param first of the step: chooses the rows of the reactions
  void place(const StepInput& in, StepTrial& trial, bool first);
  /// Reactions to the loads, with the rows of the iterate. The iterate before is kept.
  void react(const StepInput& in, const StepRule& rule, StepTrial& trial);
  /// Bodies move, and back onto the joints.
  void move_onto_joints(const StepInput& in, const StepRule& rule, StepTrial& trial);
  /// Velocities at the end, and positions but for the displacement back onto the joints.
  void move_bodies(const StepInput& in, const StepRule& rule, StepTrial& trial) const;
  /// One step of Newton's method for g(q_{j+1}, t_{j+1}) = 0.
  void return_to_joints(const StepInput& in, StepTrial& trial);
  /// Several.
  void return_near_singular(const StepInput& in, StepTrial& trial);
  /// Moves bodies by a displacement over all velocities.
  void displace(const std::vector<double>& by, State& state) const;
  /// Roundings of the numbers that a row is made of, some room for those of the factors included, relative to
  /// them.
  static constexpr double rounding = 1e-13;
  /// Distance of velocities and positions from obeying the joints, with the rows at the end there.
  [[nodiscard]] JointViolation violation(const State& end);
  /// Largest displacement of a body back onto the joints; angles times the radius of gyration [m].
  [[nodiscard]] double largest_displacement() const;
  /// Work of the impulses along the mean velocities [J].
  [[nodiscard]] double work(const StepTrial& trial);

  const Assembly* assembly;
  Index component;
  JointArrays* arrays;
  StepJointRows rows;
  std::vector<double> impulse;      ///< L [N s, N m s]
  std::vector<double> left, sizes;  ///< by row, between two lines
};

}  // namespace carom
