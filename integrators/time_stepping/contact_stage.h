#pragma once

/// \file
/// Contact problems of an island in a step, and their impulses against the guess at the loads (Johansson
/// 1999, section 4).

#include <carom/contact/island_partition.h>
#include <carom/contact/island_problem.h>
#include <carom/contact/lone_contacts.h>
#include <carom/core/dynamics/body_response.h>
#include <carom/core/export.h>
#include <carom/integrators/time_stepping/island_problems.h>
#include <carom/integrators/time_stepping/step_input.h>
#include <carom/integrators/time_stepping/step_islands.h>
#include <carom/integrators/time_stepping/step_rule.h>
#include <carom/integrators/time_stepping/step_trial.h>

#include <cstdint>
#include <span>
#include <vector>

namespace carom {

/// Budget of contact problems. Where jams are refused no answer is taken that sweeps have not finished:
/// whether many contacts jam nobody can tell from it.
[[nodiscard]] CAROM_API SweepBudget budget_of(const TimeStepping& options);

/// Solves contact. Keeps memory, and statistics of its solvers.
class CAROM_API ContactStage {
public:
  /// \param assembly must outlive it
  ContactStage(const Assembly& assembly, const TimeStepping& options);

  /// Begins a step that may be made in several passes, as IslandProblems::begin_passes().
  void begin_passes(bool repeats) { problems_.begin_passes(repeats); }
  /// Begins the next pass of such a step, as IslandProblems::begin_next_pass().
  void begin_next_pass() { problems_.begin_next_pass(); }

  /// States the contact problems of an island. \param together its bodies answer together: one problem, whose
  /// matrix is still to be made; else bodies answer for themselves, and constraints that share bodies share a
  /// problem
  void state_problems(const StepInput& in, const StepIsland& island, bool together, StepTrial& trial);
  /// How contacts that are alone on their bodies are solved, where all of an island are: as problems() like
  /// any others, or from their numbers, as lone().
  enum class Alone : std::uint8_t { as_problems, from_numbers };
  /// States and solves the contact problems of an island under constant loads, or of a part of it, whose
  /// bodies answer for themselves. Impulses change velocities of the bodies struck() alone. Returns the first
  /// problem that is not solved, or null.
  [[nodiscard]] const IslandProblem* solve_constant(const StepInput& in, const StepIsland& island,
                                                    Alone alone, StepTrial& trial);
  /// The contacts that solve_constant() has solved from their numbers.
  [[nodiscard]] const LoneContacts& lone() const { return lone_; }
  /// Those of the given bodies that have constraints, after solve_constant().
  [[nodiscard]] std::span<const Index> struck(Range bodies) const;
  /// Problems of the island at hand.
  [[nodiscard]] std::span<IslandProblem> problems() { return problems_.list(); }
  [[nodiscard]] std::span<const IslandProblem> problems() const { return problems_.list(); }
  /// The problem of an island whose bodies answer together; null where nothing touches.
  [[nodiscard]] IslandProblem* together() {
    return problems_.list().empty() ? nullptr : &problems_.list().front();
  }
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
  // Loads at both ends of a step, over all velocities.
  struct EndLoads {
    const double* start;
    const double* end;
  };
  template <class F>
  [[nodiscard]] const IslandProblem* part_problems(const StepInput& in, const StepIsland& island, F&& solved);
  [[nodiscard]] bool list_lone(std::span<const Constraint> constraints);
  void list_struck(std::span<const Constraint> constraints);
  void put_struck_in_order();
  void share_out(const StepIsland& island, StepTrial& trial);
  [[nodiscard]] bool solve(const StepInput& in, const EndLoads& loads, IslandProblem& problem,
                           SolverChain& chain, StepTrial& trial);

  const Assembly* assembly_;
  MassResponse masses_;
  bool one_body_each_;  // components are bodies
  IslandPartition partition_;
  IslandProblems problems_;
  bool by_block_ = true;
  Index first_run_ = 0;                // of the component at hand
  std::vector<Range> block_problems_;  // by block of the component at hand, if there are any
  std::vector<Index> struck_;          // ascending
  std::vector<char> is_struck_;
  LoneContacts lone_;
  std::vector<SolverChain> chains_;  // one for each run of a component; the first for what is not shared out
};

}  // namespace carom
