#pragma once

/// \file
/// Sliding that ends, turns round or begins within a step, as an error of the step.
///
/// Friction is that of the end of a step all the time. Where sliding stops or turns round in it, friction has
/// taken away too early what was left of the sliding speed, |gamma_t| at the start of the step; where it
/// begins, it has given the speed at the end too early. That is a bound of the error of sliding speeds, and
/// times the step of the error of places. A step and two halves of it may have the same wrong friction, and
/// then agree: their difference does not tell.

#include <carom/contact/detection/joint_rows.h>
#include <carom/contact/solvers/contact_mode.h>
#include <carom/core/assembly.h>
#include <carom/core/constraint_set.h>
#include <carom/core/evaluation.h>
#include <carom/core/export.h>
#include <carom/core/state.h>
#include <carom/integrators/run/companion.h>
#include <carom/integrators/run/step_report.h>

#include <vector>

namespace carom {

/// A step, for changes of sliding in it. A view.
struct SlidStep {
  const State& start;          ///< state at the start of the step
  const ContactModes& before;  ///< modes in the step before
  const State& end;            ///< state at the end of the step
  const ContactModes& modes;   ///< modes in the step
  const StepReport& report;    ///< of the step
};

/// Finds changes of sliding in steps. Keeps memory.
class CAROM_API SlipChanges {
public:
  /// \param assembly must outlive it
  explicit SlipChanges(const Assembly& assembly);

  /// True if the states of a step are asked for.
  [[nodiscard]] bool needs_states() const { return joints_.has_friction(); }
  /// Bound of the error of sliding speeds in a step, the largest of all contacts and joints; of an angle it
  /// is taken as a length by the radius of gyration. 0 where everything slid or stuck as before [m/s].
  [[nodiscard]] double largest_speed(const SlidStep& of);

private:
  [[nodiscard]] double largest_in_joints(const SlidStep& of);
  [[nodiscard]] double in_length(const Constraint& friction, double rate) const;

  const Assembly* assembly_;
  JointRows joints_;
  std::vector<double> lengths_;  // that weight velocities
  Evaluation at_start_;
  ConstraintSet friction_;
};

}  // namespace carom
