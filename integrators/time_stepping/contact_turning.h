#pragma once

/// \file
/// Lasting contacts that turn within a step, of bodies that share contacts or have joints
/// (TimeStepping::impacts, where LocatedMotion does not follow a body alone). As joints are held: impulses
/// act along the rows H_m halfway, at the mean of the coordinates, and the law takes the velocities along the
/// rows at both ends,
///
///     gamma^- = H_0 v_0,   gamma^+ = H_1 v_1,
///
/// so that contacts neither sink nor gain energy but by errors of third order in a step. Joints answer
/// contact by the same convention (joint_answer.h): were contact to act halfway, and the answer at the start,
/// the two would do work on each other of first order. The step is repeated with the rows of its own path
/// until its end no longer changes.

#include <carom/contact/detection/contact_look.h>
#include <carom/contact/detection/detector.h>
#include <carom/contact/detection/lasting_contacts.h>
#include <carom/contact/island_problem.h>
#include <carom/core/assembly.h>
#include <carom/core/constraint_set.h>
#include <carom/core/export.h>
#include <carom/integrators/time_stepping/joint_stage.h>
#include <carom/integrators/time_stepping/pass_convergence.h>
#include <carom/integrators/time_stepping/step_input.h>
#include <carom/integrators/time_stepping/step_islands.h>
#include <carom/integrators/time_stepping/step_trial.h>

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace carom {

/// Rows of the contacts of one step, and of the joints that answer them. Keeps memory.
class CAROM_API ContactTurning {
public:
  /// All must outlive it. \param negligible turning_rounding() [m]
  ContactTurning(const Assembly& assembly, const Detector& detector, JointStages& joints, double negligible)
      : look_(assembly, detector), joints_(&joints), negligible_(negligible), convergence_(assembly) {}

  /// Begins a step whose constraints are those of some islands, as they are at its start. \param step [s]
  /// \param alone whether bodies none of whose contacts is shared are followed by themselves
  void begin(std::span<const StepIsland> islands, double step, bool alone);
  /// Brings the constraints to the path that the velocities at the start lead along. Not those of mechanisms.
  void predict(const StepInput& in, StepTrial& trial, std::span<const StepIsland> islands);
  /// Brings the constraints to the path of the trial, and the joints that answer them. False if they are
  /// there: nothing turns, or further passes are of no use (PassConvergence).
  /// \param tolerance of h times velocities [m] \param residual the largest certificate of the answers
  [[nodiscard]] bool turn(const StepInput& in, StepTrial& trial, std::span<const StepIsland> islands,
                          double tolerance, double residual);
  /// Brings the constraints back to the start of the step. Contacts between which a body jams may press it,
  /// as they turn, by what is an error of the step; no impulses hold then, but along the rows at the start.
  void give_up(std::span<const StepIsland> islands);
  /// Work of the impulses of a problem on what turning makes of the velocities along its rows: an error of
  /// the step [J]. Friction in joints is booked with what it does.
  [[nodiscard]] double work(const IslandProblem& problem) const;

private:
  // A constraint at the start of the step, as it is turned, and the velocities of the ground that it touches
  // at the end.
  struct Turned {
    SingleConstraint start, now;
    std::array<double, std::size_t{Constraint::max_rows}> ground_after{};
  };
  [[nodiscard]] bool may_be_followed(const Constraint& contact) const;
  void list_mechanisms(const StepIsland& island);
  void restore(const StepIsland& island) const;
  [[nodiscard]] std::size_t find(const Constraint& contact) const;
  [[nodiscard]] bool turn(Turned& turned, const double* v0, const double* v1, const StepTrial& at) const;
  [[nodiscard]] double reach(const StepInput& in) const;
  void find_at(const State& state, const StepInput& in, double margin, ConstraintSet& out);
  [[nodiscard]] bool turn_along(const StepInput& in, StepTrial& trial, std::span<const StepIsland> islands);

  ContactLook look_;
  LastingContacts lasting_;  // those that turn
  JointStages* joints_;
  double negligible_;
  State middle_, end_;
  std::vector<Turned> turned_;     // by key and type
  std::vector<Index> shared_;      // bodies with contacts of two, ascending
  std::vector<Index> mechanisms_;  // components whose joints answer contact
  struct {
    ConstraintSet middle, end;
  } found_;  // halfway and at the end, by key and type
  PassConvergence convergence_;
};

}  // namespace carom
