#pragma once

/// \file
/// Motion of one body through a step in which shapes on ground hit it (TimeStepping::impacts): it flies to
/// the instant at which a gap closes, is hit there, and flies on. Every flight is a step of the rule by
/// itself, under the part of the loads that falls into it: loads vary linearly between the ends of the step.
/// So the impulse of the loads over the step is the same as without impacts, and momentum is passed on in
/// full.

#include <carom/contact/island_problem.h>
#include <carom/core/constraint_set.h>
#include <carom/core/export.h>
#include <carom/integrators/time_stepping/flight_closings.h>
#include <carom/integrators/time_stepping/flight_look.h>
#include <carom/integrators/time_stepping/motion_phase.h>
#include <carom/integrators/time_stepping/step_input.h>
#include <carom/integrators/time_stepping/step_trial.h>

#include <array>
#include <span>
#include <vector>

namespace carom {

/// The motion of one body. Keeps memory.
class CAROM_API LocatedMotion {
public:
  /// Looks at another body, none of whose contacts is shared with others. \param contacts that take part from
  /// the start of the step on \param struck whether one of them is closed by an impact
  void begin(Index body, std::span<const Constraint> contacts, bool struck);
  /// The body.
  [[nodiscard]] Index body() const { return body_; }
  /// Moves it through the step: writes its numbers in `trial.end` and what rounding cuts off. After the last
  /// impact that is allowed, contacts that close do not rebound; after as many of these they act to the end
  /// of the step as in any other (Johansson 1999, section 4). False if a contact problem is not solved:
  /// failed().
  bool advance(const LocatedStep& step);
  /// The problem that was not solved; null if none.
  [[nodiscard]] const IslandProblem* failed() const { return failed_; }
  /// Phases of the last advance(), in their order.
  [[nodiscard]] std::span<const MotionPhase> phases() const { return {phases_.data(), used_}; }
  /// Velocities of the body among all.
  [[nodiscard]] Range velocities(const StepInput& in) const;
  /// Makes its velocities at the end of a phase those of the trial.
  void show_end(const StepInput& in, const MotionPhase& phase, StepTrial& trial) const;
  /// True if an impact is among the phases.
  [[nodiscard]] bool is_hit() const { return hit_ <= 1.0; }
  /// Work of loads over the flights [J].
  [[nodiscard]] double work(const StepInput& in, const StepLoads& loads) const;
  /// Solvers of its contact problems.
  [[nodiscard]] SolverChain& chain() { return chain_; }

private:
  [[nodiscard]] bool move(const LocatedBody& at);
  MotionPhase& add_phase(const LocatedBody& at, double begin, double end);
  [[nodiscard]] bool fly(const LocatedBody& at, MotionPhase& flight);
  [[nodiscard]] bool strike(const LocatedBody& at, double share, bool fast);
  [[nodiscard]] bool fly_and_turn(const LocatedBody& at, MotionPhase& flight);
  [[nodiscard]] bool fly_along_begin(const LocatedBody& at, MotionPhase& flight);
  [[nodiscard]] bool fly_once(const LocatedBody& at, MotionPhase& flight);
  [[nodiscard]] bool solve(const LocatedBody& at, MotionPhase& phase);
  void take_turned(std::span<const Constraint> found, double same_place, ConstraintSet& out) const;
  [[nodiscard]] bool turn(const LocatedBody& at, MotionPhase& flight);
  void book_turning(MotionPhase& flight) const;
  [[nodiscard]] bool gains(const LocatedBody& at, const MotionPhase& flight) const;
  void list_parted(const MotionPhase& flight);

  Index body_ = none;
  bool struck_ = false;
  FlightLook look_;
  FlightClosings closings_;
  ConstraintSet start_;
  struct {
    ConstraintSet begin, middle, end, next_middle, next_end;
  } of_flight_;                        // its contacts then
  std::vector<ConstraintKey> closed_;  // contacts that take part in what comes next
  std::vector<ConstraintKey> turned_;  // those of a flight
  std::vector<ConstraintKey> parted_;  // of these, those that have not pushed in the flight before
  std::vector<MotionPhase> phases_;
  std::size_t used_ = 0;
  double hit_ = 2.0;  // share of the first impact; above 1: none
  SolverChain chain_;
  const IslandProblem* failed_ = nullptr;
};

}  // namespace carom
