#pragma once

// All conversions of fields: included by files that describe structs.

#include "enums.h"
#include "functions.h"
#include "ids.h"
#include "record.h"

#include <carom/bodies/mass_properties.h>
#include <carom/contact/detection/prescribed_motion.h>
#include <carom/contact/solvers/chain_statistics.h>
#include <carom/contact/solvers/sweep_budget.h>
#include <carom/core/contact_filter.h>
#include <carom/core/dynamics/joint_closure.h>
#include <carom/core/joint_kind.h>
#include <carom/core/surface.h>
#include <carom/integrators/run/step_report.h>

namespace carom_python {

template <>
struct Convert<carom::MassProperties<2>> : BoundRecord<carom::MassProperties<2>> {};
template <>
struct Convert<carom::ContactFilter> : BoundRecord<carom::ContactFilter> {};
template <>
struct Convert<carom::Surface> : BoundRecord<carom::Surface> {};
template <>
struct Convert<carom::planar::PrescribedMotion> : BoundRecord<carom::planar::PrescribedMotion> {
  static bool is_python(const carom::planar::PrescribedMotion& motion) {
    const auto python = [](const auto& function) {
      return Convert<std::decay_t<decltype(function)>>::is_python(function);
    };
    return python(motion.displacement) || python(motion.velocity) || python(motion.acceleration) ||
           python(motion.angle) || python(motion.spin) || python(motion.angular_acceleration);
  }
};
template <>
struct Convert<carom::StepControl> : BoundRecord<carom::StepControl> {};
template <>
struct Convert<carom::ImpactRules> : BoundRecord<carom::ImpactRules> {};
template <>
struct Convert<carom::OverlapRules> : BoundRecord<carom::OverlapRules> {};
template <>
struct Convert<carom::SweepBudget> : BoundRecord<carom::SweepBudget> {};
template <>
struct Convert<carom::TimeStepping> : BoundRecord<carom::TimeStepping> {};
template <>
struct Convert<carom::EventDriven> : BoundRecord<carom::EventDriven> {};
template <>
struct Convert<carom::FeatureKey> : BoundRecord<carom::FeatureKey> {};
template <>
struct Convert<carom::ConstraintKey> : BoundRecord<carom::ConstraintKey> {};
template <>
struct Convert<carom::EventMotion> : BoundRecord<carom::EventMotion> {};
template <>
struct Convert<carom::ContactRecord> : BoundRecord<carom::ContactRecord> {};
template <>
struct Convert<carom::JointReaction> : BoundRecord<carom::JointReaction> {};
template <>
struct Convert<carom::JointImpulse> : BoundRecord<carom::JointImpulse> {};
template <>
struct Convert<carom::ControlReport> : BoundRecord<carom::ControlReport> {};
template <>
struct Convert<carom::ModelFinding> : BoundRecord<carom::ModelFinding> {};
template <>
struct Convert<carom::RedundantJoint> : BoundRecord<carom::RedundantJoint> {};
template <>
struct Convert<carom::CrossCheckLevel> : BoundRecord<carom::CrossCheckLevel> {};
template <>
struct Convert<carom::CrossCheckOutlier> : BoundRecord<carom::CrossCheckOutlier> {};

}  // namespace carom_python
