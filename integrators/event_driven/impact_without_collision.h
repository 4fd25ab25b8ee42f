#pragma once

/// \file
/// The impact of contacts that no forces keep (Painleve): the limit of an impact at vanishing speed.

#include <carom/contact/island_problem.h>
#include <carom/contact/solvers/newton_polish.h>
#include <carom/contact/solvers/solution_list.h>
#include <carom/contact/solvers/solver_chain.h>
#include <carom/core/constraint_set.h>
#include <carom/core/export.h>
#include <carom/integrators/event_driven/event_instant.h>
#include <carom/integrators/event_driven/impact_stage.h>
#include <carom/integrators/event_driven/mode_decision.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace carom {

/// Impacts without collision; memory that clock groups share.
class CAROM_API ImpactWithoutCollision {
public:
  /// Up to enumeration_groups contacts: of all answers with impulses that change something takes the one that
  /// takes most energy. Of more, or where there is none: the limit for vanishing eps of the impulses of an
  /// impact with e = 0 and b = gamma + eps a, which exists wherever forces do not. Applies it, books and
  /// records it by `impacts`, and resolves the impacts that follow. False where there is none: nothing
  /// happens. \param candidates contacts of one island without forces that keep them
  [[nodiscard]] bool resolve(std::span<const Candidate> candidates, ImpactStage& impacts, SolverChain& chain,
                             EventInstant& at);
  /// The contact problem of the impact that was looked for last.
  [[nodiscard]] const IslandProblem& problem() const { return problem_; }
  /// Where the last search found no impact since the impulses vanish with eps while all that slides slides
  /// on: the forces P/eps, by candidate; else nothing.
  [[nodiscard]] std::span<const ForceOnCandidate> forces() const { return forces_; }

private:
  // The normal velocities of what touches are rounding, which the certificate of P = 0 would refuse: they
  // are removed. But where sliding is almost as slow, they are what makes the velocities those of bodies: of
  // contacts that jam, H^T P = 0, an answer without restitution needs P.gamma = 0.
  enum class NormalSpeed : std::uint8_t { removed, kept };
  void list_touching(std::span<const Candidate> candidates, NormalSpeed speed, const EventInstant& at);
  [[nodiscard]] bool find_listed(SolverChain& chain, EventInstant& at);
  [[nodiscard]] bool solve(SolverChain& chain, EventInstant& at);
  [[nodiscard]] bool find_limit(std::span<const Candidate> candidates, SolverChain& chain, EventInstant& at);
  [[nodiscard]] bool take_limit(SolverChain& chain, double step, EventInstant& at);
  [[nodiscard]] bool changes(double speed_noise);
  void take_forces(std::span<const Candidate> candidates, double step);
  [[nodiscard]] std::size_t most_dissipative_solution(double speed_noise) const;

  IslandProblem problem_;
  SolutionList solutions_;
  NewtonPolish polish_;
  ConstraintSet touching_;
  std::vector<std::size_t> taking_part_;  // candidates by contact of the problem
  std::size_t best_ = 0;                  // of the solutions; their number if none
  std::vector<double> limit_, xi_;        // impulses and velocities of the limit
  std::vector<double> step_impulses_;     // of the last step,
  std::vector<ContactMode> step_modes_;   // and modes
  std::vector<double> ahead_;             // velocities after a step
  std::vector<ForceOnCandidate> forces_;
};

}  // namespace carom
