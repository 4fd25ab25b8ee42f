#pragma once

/// \file
/// The contact problems of the islands of a step, one behind the other. A step that is made in several
/// passes, over constraints that stay where they are, keeps them: each pass, and a step that begins as the
/// one before, starts from their answers.

#include <carom/contact/island_problem.h>
#include <carom/core/constraint.h>
#include <carom/core/export.h>
#include <carom/integrators/time_stepping/step_islands.h>

#include <cstddef>
#include <span>
#include <vector>

namespace carom {

/// Keeps the problems of islands, and their memory.
class CAROM_API IslandProblems {
public:
  /// \param options of all problems
  explicit IslandProblems(const IslandOptions& options) : options_(options) {}

  /// Begins a step that may be made in several passes: the problems of all its islands are kept up to the
  /// next step. \param repeats whether the step before began with the same constraints
  void begin_passes(bool repeats);
  /// Begins the next pass of such a step, in which rows have turned a little.
  void begin_next_pass() { goes_on_ = true; }

  /// Begins an island. Forgets the problems of the one before, unless they are kept.
  void begin(const StepIsland& island);
  /// One more problem of the island.
  [[nodiscard]] IslandProblem& next();
  /// Where the solvers of a problem of some constraints start from, beside the impulses of a step before.
  [[nodiscard]] IslandStart start_of(std::span<const Constraint> constraints) const;
  /// The problems of the island.
  [[nodiscard]] std::span<IslandProblem> list() {
    return count_ == 0 ? std::span<IslandProblem>() : std::span(problems_).subspan(first_, count_);
  }
  /// The problems of the island.
  [[nodiscard]] std::span<const IslandProblem> list() const {
    return count_ == 0 ? std::span<const IslandProblem>() : std::span(problems_).subspan(first_, count_);
  }

private:
  // Where the problems of an island stand.
  struct Place {
    const Constraint* constraints;  // the first of the island
    std::size_t first;
  };
  [[nodiscard]] std::size_t place_of(const StepIsland& island);

  IslandOptions options_;
  std::vector<IslandProblem> problems_;
  std::size_t first_ = 0, count_ = 0;  // of the island at hand
  bool is_kept_ = false;               // problems are, from island to island
  bool goes_on_ = false;               // and there are answers to start from
  std::vector<Place> places_;          // of islands with constraints, ascending by address
  std::size_t used_ = 0;               // problems of all of them
};

}  // namespace carom
