#pragma once

/// \file
/// The smooth motion of one clock group under fixed contact modes, as a problem for a flow:
///
///     dq/dt = v,   M dv/dt = f + reactions of joints and closed contacts,   dz/dt by the elements,
///     and the works of dashpots, friction, prescribed loads and moving shapes on ground.

#include <carom/contact/active_set.h>
#include <carom/contact/detection/detector.h>
#include <carom/contact/detection/feature_margin.h>
#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/integrators/event_driven/group_guards.h>
#include <carom/integrators/event_driven/group_model.h>
#include <carom/integrators/event_driven/joint_reactions.h>
#include <carom/integrators/event_driven/motion_jacobian.h>
#include <carom/integrators/event_driven/motion_memory.h>
#include <carom/integrators/event_driven/motion_sample.h>
#include <carom/integrators/flow/flow.h>
#include <carom/integrators/run/event_driven.h>

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace carom {

/// The unknowns of one group: q, v, z, then works.
class CAROM_API SmoothMotion final : public FlowProblem {
public:
  /// All must outlive it.
  SmoothMotion(const Assembly& assembly, const Detector& detector, const GroupComponents& group,
               const EventDriven& options, MotionMemory& memory);

  [[nodiscard]] std::size_t size() const override { return model_.unknowns.size(); }
  void rates(double time, const double* y, double* rates) override;
  [[nodiscard]] std::span<const double> absolute_tolerances() const override { return *model_.tolerances; }

  /// Where coordinates and velocities correspond one to one.
  [[nodiscard]] bool has_jacobian() const override {
    return model_.unknowns.q_size() == model_.unknowns.v_size();
  }
  /// Coordinates are the integrals of velocities.
  [[nodiscard]] std::size_t integrals() const override {
    return has_jacobian() ? model_.unknowns.q_size() : 0;
  }
  void jacobian(double time, const double* y, std::vector<RateDerivative>& out) override;
  /// True if nothing but constant fields acts: places are polynomials of time but for turning.
  [[nodiscard]] bool is_ballistic() const override {
    return model_.loads.are_constant && has_jacobian() && joints_.rows().empty() && active_.list().empty();
  }

  /// Evaluates one state. The rows of joints and the forces of closed contacts are those of this state then.
  void sample(double time, const double* y, Forces forces, MotionSample& out);
  /// The contact of a pair in a sample.
  void contact(std::size_t pair, const MotionSample& at, Constraint& out) const;
  /// The contact of a pair in a sample; of a pair with an outline that is farther away than `near` [m] only a
  /// lower bound of the gap, and no bodies.
  void contact_if_near(std::size_t pair, const MotionSample& at, double near, Constraint& out) const;
  /// Regions of the features of the outline of a pair in a sample.
  [[nodiscard]] FeatureRegions regions(const ContactPair& pair, const MotionSample& at) const {
    return FeatureRegions(
        model_.detector->outlines().outline_pair(pair, at.view(), at.evaluation, at.places));
  }
  /// Writes the guards of the group's elements in a sample, with derivatives.
  void read_guards(const MotionSample& at, std::vector<GuardMotion>& out);
  /// Writes guards at y with accelerations of the group's bodies, without loads. \param memory its
  /// positions and accelerations are overwritten
  void read_guards(double time, const double* y, const double* acceleration, MotionSample& memory,
                   std::vector<GuardMotion>& out);

  /// Facts of the group.
  [[nodiscard]] const GroupModel& model() const { return model_; }
  /// Contacts that are closed.
  [[nodiscard]] ActiveSet& active() { return active_; }
  [[nodiscard]] const ActiveSet& active() const { return active_; }
  /// Joints of the group.
  [[nodiscard]] JointReactions& joints() { return joints_; }
  [[nodiscard]] const JointReactions& joints() const { return joints_; }
  /// Guards of the group's elements.
  [[nodiscard]] const GroupGuards& guards() const { return guards_; }
  /// True if guards can be sampled along a path of coordinates (step_path.h).
  [[nodiscard]] bool guards_follow_path() const {
    return guards_.count() != 0 && guards_.all_have_motion() && has_jacobian();
  }
  /// Memory shared with other motions.
  [[nodiscard]] MotionMemory& memory() { return *memory_; }
  [[nodiscard]] const MotionMemory& memory() const { return *memory_; }

private:
  void place_bodies(MotionSample& at) const;
  void write_works(const MotionSample& at, double lost_inside, double* rates);

  MotionMemory* memory_;
  JointReactions joints_;
  GroupModel model_;
  ActiveSet active_;
  GroupGuards guards_;
  std::unique_ptr<MotionJacobian> jacobian_;  // null until asked for
};

}  // namespace carom
