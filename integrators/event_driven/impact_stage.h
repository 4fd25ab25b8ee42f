#pragma once

/// \file
/// Impacts at one instant, island by island, until nothing that touches approaches; those slower than
/// the capture speed close their contacts (accumulations).

#include <carom/contact/active_set.h>
#include <carom/contact/island_problem.h>
#include <carom/contact/solvers/impact_rules.h>
#include <carom/contact/solvers/solver_chain.h>
#include <carom/contact/strike.h>
#include <carom/core/constraint_set.h>
#include <carom/core/export.h>
#include <carom/integrators/event_driven/accumulation.h>
#include <carom/integrators/event_driven/event_instant.h>
#include <carom/integrators/event_driven/group_failure.h>
#include <carom/integrators/event_driven/impact_settling.h>
#include <carom/integrators/event_driven/slow_contacts.h>
#include <carom/integrators/run/impact_note.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace carom {

/// Impacts of an island at one instant so far.
struct ImpactCounts {
  int sequence = 0;  ///< impacts, where they are sequential
  int closings = 0;  ///< projections that closed contacts, of slow impacts
};

/// Ways of solving an impact by Newton's law. Of many contacts: by sweeps, whose modes are solved exactly.
[[nodiscard]] constexpr IslandOptions options_of_impacts(const ImpactRules& rules) {
  return {.factored_from = factored_constraints,
          .factored_to = most_exact_contacts,
          .plastic_jams = !rules.refuse_jams};
}

/// Solvers and memory of impacts, shared by clock groups.
struct ImpactMemory {
  /// \param solvers must outlive it
  ImpactMemory(const ImpactRules& rules, SolverChain& solvers)
      : chain(solvers), problems(options_of_impacts(rules)) {}

  SolverChain& chain;
  ImpactProblems problems;
  ConstraintSet touching;     ///< constraints of the problem
  std::vector<Index> places;  ///< pairs of `touching`, as long as all of its constraints are in the problem
  std::vector<ActiveContact> captured;
  std::vector<ImpactCounts> counts;      ///< by island
  std::vector<double> velocities_after;  ///< of the problem's rows, W P + b
  ImpactNote note;                       ///< of the impact at hand
  ImpactSettling settling;
  ContactClosing closing;
};

/// The impacts of one clock group.
class CAROM_API ImpactStage {
public:
  /// All must outlive it.
  ImpactStage(const GroupFailure& failure, ImpactMemory& memory) : failure_(&failure), memory_(&memory) {}

  /// Begins with a new motion.
  void start() {
    accumulation_.clear();
    settlings_ = {};
  }
  /// Remembers the impacts of another group too.
  void take(const ImpactStage& other) {
    accumulation_.take(other.accumulation_);
    settlings_.take(other.settlings_);
  }
  /// Solves impacts until nothing approaches. True if there was one: velocities are those after it then, but
  /// loads and accelerations those before.
  [[nodiscard]] bool resolve(EventInstant& at);
  /// Settles what the impacts left slower than the capture speed, and solves the impacts that this leads to.
  /// \param at brought to the state after the impacts; is so again
  void settle(EventInstant& at);
  /// Settles one island, once. False if there was nothing to settle.
  [[nodiscard]] bool settle(std::span<const Index> pairs, EventInstant& at);
  /// Applies the answer of a problem of contacts of one island, books and records it.
  void apply(EventKind kind, const IslandProblem& problem, EventInstant& at);

private:
  [[nodiscard]] double fastest_approach(std::span<const Index> pairs, const EventInstant& at) const;
  void resolve_island(std::span<const Index> pairs, ImpactOnset onset, ImpactCounts& counts,
                      EventInstant& at);
  [[nodiscard]] StrikeAnswer solve(ImpactLaw law, EventInstant& at);
  [[nodiscard]] bool stops(const IslandProblem& problem);
  void list_touching(std::span<const Index> pairs, bool captured, const EventInstant& at);
  void leave_out_repeated(double gap_noise);
  void close_captured(std::span<const Index> pairs, EventInstant& at);
  // Contacts that a projection closes: those that part slower than the capture speed, where those that slide
  // slowly are stopped too; the same without stopping; or those only that do not part.
  enum class Closing : std::uint8_t { with_sliding, all, pressed };
  void list_captured(Closing closing, std::span<const Index> pairs, EventInstant& at);
  [[nodiscard]] std::string fastest_of(const ConstraintSet& contacts, const double* velocity) const;
  [[noreturn]] void fail_unsolved(const IslandProblem& problem, const EventInstant& at);

  const GroupFailure* failure_;
  ImpactMemory* memory_;
  Accumulation accumulation_;
  SettlingLimit settlings_;
};

}  // namespace carom
