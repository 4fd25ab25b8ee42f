#pragma once

/// \file
/// Reactions of the joints of one clock group, to loads and to impulses, and friction in joints that they
/// bound.

#include <carom/contact/active_set.h>
#include <carom/contact/friction_bounds.h>
#include <carom/contact/island_problem.h>
#include <carom/contact/solvers/solver_chain.h>
#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/core/numerics/bound_iteration.h>
#include <carom/integrators/event_driven/group_joints.h>
#include <carom/integrators/event_driven/motion_memory.h>
#include <carom/integrators/event_driven/motion_sample.h>

#include <memory>
#include <span>
#include <vector>

namespace carom {

/// The joints of one group. A sample given must be that of the last react(): the rows belong to it.
/// Multipliers handed out are valid until the next call.
class CAROM_API JointReactions {
public:
  /// \param assembly, memory must outlive it \param components of the group, ascending
  JointReactions(const Assembly& assembly, std::span<const Index> components, MotionMemory& memory);
  JointReactions(const JointReactions&) = delete;
  JointReactions& operator=(const JointReactions&) = delete;

  /// The rows.
  [[nodiscard]] GroupJoints& rows() { return joints_->rows; }
  [[nodiscard]] const GroupJoints& rows() const { return joints_->rows; }
  /// Bounds of friction that follow from forces.
  [[nodiscard]] FrictionBounds& friction_bounds() { return joints_->bounds; }
  [[nodiscard]] const FrictionBounds& friction_bounds() const { return joints_->bounds; }
  /// True if the bound of friction in a joint follows from forces.
  [[nodiscard]] bool depends_on_joint_force(const Constraint& contact) const {
    return joints_->bounds.depends_on_joint_force(contact);
  }

  /// Brings the rows to a sample, and its accelerations, by the loads alone, onto them.
  void react(MotionSample& at);
  /// Multipliers at a sample, contacts acting as they do.
  [[nodiscard]] std::span<const double> multipliers(const MotionSample& at,
                                                    std::span<const ActiveContact> contacts);
  /// Adds the forces of contacts to the accelerations of a sample, with friction in joints bound by the
  /// forces that follow. False where there are none, or no bounds.
  bool add_contact_forces(ActiveSet& active, MotionSample& at);
  /// Forces of contacts in place of those of the active set, as the flow finds them, with bounds of friction
  /// in joints as they are; then the bounds that follow, their largest relative change, and the margins of
  /// the forces. \param at a sample without contacts. False where there are no forces.
  bool update_friction_bounds(ActiveSet& active, MotionSample& at, std::vector<ActiveContact>& contacts,
                              std::vector<ForceMargin>& margins, BoundIteration& iteration, double& change);

  /// True if the rows belong to a sample.
  [[nodiscard]] bool is_at(const MotionSample& at) const { return sample_ == &at; }
  /// Makes a problem of contacts, bodies answering with their joints. \param velocity_before of the model
  void build(IslandProblem& problem, std::span<const Constraint> contacts, const double* velocity_before);
  /// Solves the problem of an impact. Bounds of friction in joints that follow from impulses are found by
  /// repetition; it is not solved where they do not converge. \param contacts those of the problem
  bool solve(IslandProblem& problem, std::span<Constraint> contacts, const MotionSample& at,
             SolverChain& chain);
  /// Impulses of the joints by the answer of a problem.
  [[nodiscard]] std::span<const double> impulses(const IslandProblem& problem);

  /// Where a law of time of joints jumps in its rate: the impulses that make joints follow, contacts aside,
  /// if a velocity is off by more than `noise`; empty otherwise. Adds the change to the velocities of the
  /// group and the work of the impulses [J].
  [[nodiscard]] std::span<const double> follow_jump(const MotionSample& at, std::span<double> velocities,
                                                    double noise, double& work);

private:
  bool update_bounds_once(ActiveSet& active, MotionSample& at, BoundIteration& iteration, double& change);
  [[nodiscard]] double largest_load(const MotionSample& at) const;

  const Assembly* assembly_;
  MotionMemory* memory_;
  std::unique_ptr<BoundComponents> own_;  // null without joints
  BoundComponents* joints_;
  std::vector<Range> velocities_;         // of the group
  const MotionSample* sample_ = nullptr;  // that the rows were brought to last
};

}  // namespace carom
