#pragma once

/// \file
/// Errors of a step, with the names of the parts to blame and what would help. The failed trial is asked, the
/// step is not repeated.

#include <carom/contact/detection/detector.h>
#include <carom/contact/island_problem.h>
#include <carom/core/dynamics/coupling_rating.h>
#include <carom/core/export.h>
#include <carom/core/numerics/fixed_point.h>
#include <carom/core/run_error.h>
#include <carom/integrators/run/time_stepping.h>
#include <carom/integrators/time_stepping/joint_stage.h>
#include <carom/integrators/time_stepping/step_input.h>
#include <carom/integrators/time_stepping/step_trial.h>

#include <span>

namespace carom {

/// Demands options that can be. Throws ModelError naming the option.
CAROM_API void check_options(const TimeStepping& options);

/// An error that knows of no step, as of a prescribed motion, with the time and the length of this one.
[[nodiscard]] CAROM_API RunError with_place(const RunError& error, const StepInput& in);

/// The error with the name of a file of its contact problem, if it has one and a directory is given.
[[nodiscard]] CAROM_API RunError with_file(const RunError& error, const TimeStepping& options);

/// The island whose iteration fails.
struct FailedIsland {
  std::span<const Index> components;
  const JointStages& joints;                ///< of all components of the model
  std::span<const IslandProblem> problems;  ///< of its contacts
};

/// Says why a step of one component failed, or of an island that begins with it.
class CAROM_API StepErrors {
public:
  /// \param trial as the step left it; rotations in it are worked with
  StepErrors(const StepInput& in, Index component, const Detector& detector, const TimeStepping& options,
             StepTrial& trial)
      : in_(in), component_(component), detector_(detector), options_(options), trial_(trial) {}

  /// The iteration does not contract.
  [[noreturn]] void fail_contraction(const FixedPointJudge& judge, Iteration iteration,
                                     const FailedIsland& island) const;
  /// A joint stays open. \param gap by how much
  [[noreturn]] void fail_open(JointId joint, double gap) const;
  /// The step has gained energy that nothing explains [J].
  [[noreturn]] void fail_gain(double gain) const;
  /// Bodies would be moved back onto the joints farther than is allowed [m].
  [[noreturn]] void fail_stray(const StrayBody& stray) const;
  /// A contact problem is not solved.
  [[noreturn]] void fail_contact(const IslandProblem& problem) const;
  /// A contact problem as a failure tells it: its parts by name, its residual, a copy of it.
  [[nodiscard]] SolverFailure failure_of(const IslandProblem& problem) const;
  /// An energy is not finite: in the first of some components of which one is not.
  [[noreturn]] void fail_account(Range components) const;
  /// The internal variables of an element cannot be advanced.
  [[noreturn]] void fail_internal(ElementId element) const;
  /// A matrix of Newton's method is singular, of some components.
  [[noreturn]] void fail_linearisation(std::span<const Index> components) const;
  /// A gap cannot be opened.
  [[noreturn]] void fail_projection(const Constraint& left) const;
  /// Impacts at the start of the step that cannot be resolved. \param what why
  [[noreturn]] void fail_impacts(const IslandProblem& problem, const std::string& what) const;
  /// An impact adds energy [J], which is refused.
  [[noreturn]] void refuse_gain(const IslandProblem& problem, double gain) const;

private:
  [[nodiscard]] std::string tell_turn(SolverFailure& failure) const;
  [[nodiscard]] std::string tell_joints(const FailedIsland& island, SolverFailure& failure) const;
  [[nodiscard]] std::string tell_jumps(const FailedIsland& island, SolverFailure& failure) const;
  [[nodiscard]] std::string tell_light_bodies(const FailedIsland& island, SolverFailure& failure) const;
  [[nodiscard]] CouplingRating rate(std::span<const Index> components) const;
  void demand_finite_loads(const StateView& at) const;
  void find_cause(bool implicit) const;
  [[noreturn]] void fail_account() const;
  [[nodiscard]] SolverFailure failure() const;
  // Throws. \param failure is moved from
  [[noreturn]] void fail(const std::string& what, SolverFailure& failure) const;
  [[nodiscard]] const System& system() const { return in_.assembly.system(); }

  const StepInput& in_;
  Index component_;
  const Detector& detector_;
  const TimeStepping& options_;
  StepTrial& trial_;
};

}  // namespace carom
