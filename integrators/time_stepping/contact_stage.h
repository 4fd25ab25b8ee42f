#pragma once

/// \file
/// Constraints of a step (contacts with gap <= 0 at its start, those of the step before that turning has
/// opened, limits and friction of joints), the islands that they make of components, and their impulses
/// against the guess at the loads (Johansson 1999, section 4).

#include <carom/contact/detection/detector.h>
#include <carom/contact/island_partition.h>
#include <carom/contact/island_problem.h>
#include <carom/core/dynamics/body_response.h>
#include <carom/core/export.h>
#include <carom/integrators/run/time_stepping.h>
#include <carom/integrators/time_stepping/step_input.h>
#include <carom/integrators/time_stepping/step_rule.h>
#include <carom/integrators/time_stepping/step_trial.h>

#include <span>
#include <vector>

namespace carom {

/// Components that constraints join in a step: the unit of its coupling iteration.
struct StepIsland {
  std::span<const Index> components;  ///< ascending
  std::span<Constraint> constraints;  ///< that act on them
};

/// Finds and solves contact. Keeps memory, and statistics of its solvers.
class CAROM_API ContactStage {
public:
  /// Throws ModelError for a contact without a law.
  ContactStage(const Assembly& assembly, const TimeStepping& options);

  /// What the constraints are found with.
  [[nodiscard]] const Detector& detector() const { return detector_; }
  /// Ground shapes that move, at the end of the step.
  [[nodiscard]] const GroundPlaces& places_at_end() const { return places_after_; }
  /// Moves ground shapes. Throws SolverError naming one whose motion is not finite or jumps.
  void place_surfaces(const StepInput& in);

  /// Finds all constraints of a step, and its islands: every component belongs to one. Rotations at the start
  /// (StepTrial::at_start) must be up to date where asked for.
  void find(const StepInput& in, const StepTrial& trial);
  /// The islands, in the order of their first components. Valid until the next find().
  [[nodiscard]] std::span<const StepIsland> islands() const { return islands_; }

  /// States the contact problems of an island. \param together its bodies answer together: one problem, whose
  /// matrix is still to be made; else bodies answer for themselves, and constraints that share bodies share a
  /// problem
  void state_problems(const StepInput& in, const StepIsland& island, bool together, StepTrial& trial);
  /// Finds the constraints of an island as they were at the start, for another iteration.
  void restore(const StepInput& in, const StepIsland& island, const StepTrial& trial);
  /// Problems of the island at hand.
  [[nodiscard]] std::span<IslandProblem> problems() { return {problems_.data(), in_use_}; }
  [[nodiscard]] std::span<const IslandProblem> problems() const { return {problems_.data(), in_use_}; }
  /// True if problems lie within the blocks of one component each, so that blocks can be solved one by one.
  [[nodiscard]] bool by_block() const { return by_block_; }
  /// True if impulses may change velocities of a block of the only component.
  [[nodiscard]] bool touches(Index part) const;
  /// Impulses of a block, while others are at work on other runs. Unsolved problems get no impulses.
  void solve_block(const StepInput& in, const StepRule& rule, const Block& block, Index part,
                   StepTrial& trial);
  /// Impulses of all problems of the island; the first that is not solved, or null.
  [[nodiscard]] const IslandProblem* solve(const StepInput& in, const StepRule& rule, StepTrial& trial);
  /// The first problem whose last answer is not usable; null if all are.
  [[nodiscard]] const IslandProblem* first_unsolved() const;
  /// Solvers of what is not shared out to threads.
  [[nodiscard]] SolverChain& chain() { return chains_.front(); }

  /// Adds what solvers have counted since the last call.
  void add_statistics(ChainStatistics& sum);
  /// Forgets what they counted in a step that failed.
  void forget_statistics();

private:
  void remember(const StepInput& in, double last_step);
  void find(const StepInput& in, Index component, const StepTrial& trial, std::vector<Constraint>& out);
  void make_islands();
  [[nodiscard]] Index component_of(Index body) const;
  void add_problem(const StepInput& in, std::span<Constraint> constraints);
  void share_out(const StepIsland& island, StepTrial& trial);
  [[nodiscard]] bool solve(const StepInput& in, const StepRule& rule, IslandProblem& problem,
                           SolverChain& chain, StepTrial& trial);

  const Assembly* assembly_;
  Detector detector_;
  MassResponse masses_;
  double capture_speed_;
  GroundPlaces places_, places_after_;   // at the start; at the end
  LastingContacts lasting_;              // contacts of the last step that turning may have opened
  std::vector<ConstraintKey> sticking_;  // in the last step, ordered; where static friction asks
  std::vector<Constraint> constraints_, again_;
  std::vector<Index> members_;  // components, island by island
  std::vector<StepIsland> islands_;
  IslandPartition partition_;
  std::vector<IslandProblem> problems_;
  std::size_t in_use_ = 0;
  bool by_block_ = true;
  Index first_run_ = 0;                // of the component at hand
  std::vector<Range> block_problems_;  // by block of the component at hand, if there are any
  std::vector<SolverChain> chains_;  // one for each run of a component; the first for what is not shared out
};

}  // namespace carom
