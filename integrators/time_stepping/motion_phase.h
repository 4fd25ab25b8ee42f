#pragma once

/// \file
/// Loads, flights and impacts: the parts of a step of a body that is hit within it.

#include <carom/contact/detection/detector.h>
#include <carom/contact/island_problem.h>
#include <carom/contact/solvers/impact_rules.h>
#include <carom/core/body_kind.h>
#include <carom/core/constraint_set.h>
#include <carom/core/export.h>
#include <carom/integrators/time_stepping/capture_rule.h>
#include <carom/integrators/time_stepping/step_input.h>
#include <carom/integrators/time_stepping/step_rule.h>
#include <carom/integrators/time_stepping/step_trial.h>

#include <array>
#include <vector>

namespace carom {

/// Loads over a step, arrays over all velocities [N, N m]: linear between its ends, or mean loads, the same
/// all along. Where impacts make loads jump, since these depend on velocities, `jump` is by how much, and
/// `correction` the sum of (1 - 2 t) J over the jumps J at the shares t: half of it belongs to the mean of
/// loads that are linear, a mean load has it already.
struct StepLoads {
  const double* start;                 ///< F0, or the mean loads
  const double* end;                   ///< F1, or the mean loads
  const double* jump = nullptr;        ///< J; null: none
  const double* correction = nullptr;  ///< null: none
  bool is_mean = false;                ///< loads are mean loads
  /// The body at hand is hit: its loads jump when it is. Those of any other are spread over the step.
  bool at_impact = false;

  /// A load at a share of the step. Over the step the mean of a load is the same, however it jumps.
  /// \param hit share at which it jumps, if that is behind: else above 1
  [[nodiscard]] double at(Index i, double share, double hit) const {
    const double even = start[i] + share * (end[i] - start[i]);
    if (jump == nullptr) return even;
    const double mean = is_mean ? end[i] : 0.5 * (start[i] + end[i] + correction[i]);
    if (!at_impact) return is_mean ? mean : even + 0.5 * correction[i];
    // Before the impacts J and half of that of which the mean is too much are still to come.
    const double slope = is_mean ? 0.0 : end[i] - start[i] - jump[i];
    const double before = is_mean ? mean - 0.5 * (jump[i] + correction[i]) : start[i];
    if (!(hit < 1.0)) return before + share * slope;
    const double left = mean - before - 0.5 * slope;  // of the impulse over the step
    return before + share * slope + left / (1.0 - hit);
  }
};

/// The loads that the guess of a trial leads along.
[[nodiscard]] CAROM_API StepLoads step_loads(const StepInput& in, const StepRule& rule,
                                             const StepTrial& trial);

/// Part of a step of one body: a flight, or an impact, which takes no time. Times are shares of the step.
struct MotionPhase {
  double begin = 0.0, end = 0.0;  ///< equal: an impact
  double hit = 2.0;               ///< share of the first impact before it; above 1: none
  /// Work of contacts by the turning of their directions, an error of the step [J].
  double turning_work = 0.0;
  bool cut = false;                  ///< an impact beyond those that are allowed: it does not rebound
  std::array<double, 7> q{};         ///< coordinates at its begin
  std::array<double, 6> v0{}, v1{};  ///< velocities at its begin, at its end
  ConstraintSet constraints;         ///< contacts that take part
  IslandProblem problem;             ///< theirs, if there are any

  /// True of an impact.
  [[nodiscard]] bool is_impact() const { return begin == end; }
  /// Adds the work of loads in it [J]. \param v velocities of the body among all \param step length of the
  /// whole step [s]
  void add_work(const StepLoads& loads, Range v, double step, double& sum) const {
    for (Index i = 0; i < v.size(); ++i) {
      const double load = loads.at(v.begin + i, begin, hit) + loads.at(v.begin + i, end, hit);
      sum += 0.25 * (end - begin) * step * load * (v0[i] + v1[i]);
    }
  }
};

/// Numbers that follow from the options.
struct LocatedRules {
  int most_impacts;     ///< of one body that rebound, >= 1
  CaptureRule capture;  ///< which contacts do not rebound
  double gap;           ///< gap_rounding() [m]
  double turning;       ///< turning_rounding() [m]
  ImpactRules impacts;  ///< how they are resolved
};

/// A step that bodies are moved through.
struct LocatedStep {
  const StepInput& in;
  const StepRule& rule;
  const Detector& detector;
  StepLoads loads;
  const LocatedRules& rules;
  StepTrial& trial;
};

/// A step that one body is moved through.
struct LocatedBody : LocatedStep {
  Index body;
  BodySlot slot;
  const BodyKind& kind;
};

}  // namespace carom
