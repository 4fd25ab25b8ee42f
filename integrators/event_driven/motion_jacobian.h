#pragma once

/// \file
/// How the rates of a clock group change with its unknowns, for implicit methods.

#include <carom/contact/active_set.h>
#include <carom/core/export.h>
#include <carom/core/force_kind.h>
#include <carom/integrators/event_driven/group_model.h>
#include <carom/integrators/event_driven/joint_reactions.h>
#include <carom/integrators/event_driven/motion_memory.h>
#include <carom/integrators/event_driven/motion_sample.h>
#include <carom/integrators/flow/flow.h>

#include <array>
#include <cstddef>
#include <vector>

namespace carom {

/// The derivative of the equations of motion of one group, with a multiplier for each row of joints and
/// each force of a closed contact that is a constraint. Works have no rows.
class CAROM_API MotionJacobian {
public:
  /// All must outlive it.
  MotionJacobian(const GroupModel& model, JointReactions& reactions, ActiveSet& active, MotionMemory& memory);

  /// Appends it. \param sample with all forces, the one that the motion made last; differences move its state
  /// and put it back
  void append(MotionSample& sample, std::vector<RateDerivative>& out);

private:
  // Changes of a contact's load, its forces as they are, and of the accelerations along its rows, those of
  // the bodies as they are.
  struct ContactChange {
    static constexpr std::size_t most = 9;  // columns of three bodies in the plane
    template <std::size_t N>
    using ByMove = std::array<std::array<double, N>, most>;  // by what is moved

    std::array<Index, most> columns{};
    std::size_t count = 0;
    ByMove<most> load_by_position{}, load_by_velocity{};
    ByMove<2> row_by_position{}, row_by_velocity{};
  };
  [[nodiscard]] Index unknown(Index v) const { return static_cast<Index>(model_->unknowns.of_velocity(v)); }
  void differentiate_internals(const MotionSample& sample, const MotionUnknowns::Part& part,
                               std::vector<RateDerivative>& out);
  void differentiate_joints(const MotionSample& sample, std::vector<RateDerivative>& out, Index& multiplier);
  void differentiate_joints(const MotionSample& sample, const JointConstraints& joints, std::size_t first_row,
                            std::vector<RateDerivative>& out, Index& multiplier);
  void differentiate_contacts(MotionSample& sample, std::vector<RateDerivative>& out, Index& multiplier);
  void differentiate_friction_bound(const MotionSample& sample, const ActiveContact& contact,
                                    std::vector<RateDerivative>& out);
  [[nodiscard]] ContactChange change_of(MotionSample& sample, const ActiveContact& contact);

  const GroupModel* model_;
  JointReactions* reactions_;
  ActiveSet* active_;
  MotionMemory* memory_;
  std::vector<LoadDerivative> derivatives_;
  std::vector<ContactChange> contact_changes_;
  std::vector<double> joint_forces_;    // multipliers of the rows of joints
  std::vector<Index> row_multipliers_;  // unknowns by row of joints; none: without force
};

}  // namespace carom
