#pragma once

/// \file
/// Lasting contacts that turn within a step, of bodies that share contacts (TimeStepping::impacts, where
/// LocatedMotion does not follow a body alone). As joints are held: impulses act along the rows H_m halfway,
/// at the mean of the coordinates, and the law takes the velocities along the rows at both ends,
///
///     gamma^- = H_0 v_0,   gamma^+ = H_1 v_1,
///
/// so that contacts neither sink nor gain energy but by errors of third order in a step. The step is repeated
/// with the rows of its own path until its end no longer changes.

#include <carom/contact/detection/contact_look.h>
#include <carom/contact/detection/detector.h>
#include <carom/contact/island_problem.h>
#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/integrators/time_stepping/step_input.h>
#include <carom/integrators/time_stepping/step_islands.h>
#include <carom/integrators/time_stepping/step_trial.h>

#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace carom {

/// Rows of the contacts of one step. Keeps memory.
class CAROM_API ContactTurning {
public:
  /// Both must outlive it.
  ContactTurning(const Assembly& assembly, const Detector& detector)
      : look_(assembly, detector), lengths_(assembly.length_scales()) {}

  /// Begins a step whose contacts are those of some islands, as they are at its start.
  /// \param alone whether bodies none of whose contacts is shared are followed by themselves
  void begin(std::span<const StepIsland> islands, bool alone);
  /// Brings the contacts to the path of the trial. False if they are there: nothing turns, or the end of the
  /// trial has changed no more than rounding since the last time, or no less.
  [[nodiscard]] bool turn(const StepInput& in, const StepTrial& trial, std::span<const StepIsland> islands);
  /// Work of the impulses of a problem on what turning makes of the velocities along its rows: an error of
  /// the step [J].
  [[nodiscard]] double work(const IslandProblem& problem) const;

private:
  // A contact at the start of the step, and the velocities of the ground that it touches at the end.
  struct Turned {
    Constraint start;
    std::array<double, std::size_t{Constraint::max_rows}> ground_after{};
  };
  [[nodiscard]] bool may_be_followed(const Constraint& contact) const;
  [[nodiscard]] std::size_t find(const Constraint& contact) const;
  [[nodiscard]] bool turn(Constraint& contact, const double* v0, const double* v1);
  [[nodiscard]] bool has_converged(const StepTrial& trial);
  [[nodiscard]] double reach(const StepInput& in) const;
  void find_at(const State& state, double margin, std::vector<Constraint>& out);

  ContactLook look_;
  State middle_;
  std::vector<Turned> turned_;  // by key
  std::vector<Index> shared_;   // bodies with contacts of two, ascending
  std::vector<Constraint> at_middle_, at_end_;
  std::vector<double> lengths_;  // Assembly::length_scales()
  std::vector<double> last_;     // velocities at the end of the trial before
  double change_ = std::numeric_limits<double>::infinity();
  double noise_ = 0.0;  // velocities that are rounding [m/s]
  int tries_ = 0;
};

}  // namespace carom
