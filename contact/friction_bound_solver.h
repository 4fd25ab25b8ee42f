#pragma once

/// \file
/// Problem: friction in joints is bound by the forces in the joints, which follow from the impulses of
/// contact and of friction. Find bounds, impulses and forces that agree.

#include <carom/contact/friction_bounds.h>
#include <carom/contact/island_problem.h>
#include <carom/contact/solvers/solver_chain.h>
#include <carom/core/export.h>
#include <carom/core/joint_kind.h>
#include <carom/core/numerics/rank_revealing_qr.h>

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace carom {

/// One problem of contacts with friction in joints. All members must outlive the calls.
struct CAROM_API FrictionBoundProblem {
  IslandProblem& problem;
  std::span<Constraint> contacts;           ///< contacts of the problem
  std::span<FrictionBounds* const> bounds;  ///< of friction in the joints, each of joints of its own
  JointView at;                             ///< where forces of joints are looked at
  double duration = 1.0;                    ///< as for FrictionBounds::take() [s]
  double size = 0.0;                        ///< of loads, as for FrictionBounds::take()
  /// Multipliers of all rows of the joints of one of the bounds, under the impulses that the problem has.
  std::function<const double*(std::size_t bounds)> multipliers;

  /// The bounds that hold for a contact; null if no force of a joint bounds its friction.
  [[nodiscard]] FrictionBounds* bounds_of(const Constraint& contact) const;
};

/// Solves problems of contacts with friction in joints. Keeps its memory.
class CAROM_API FrictionBoundSolver {
public:
  /// Solves, and repeats with the bounds that follow until these stay. Forces of joints are those of the
  /// impulses of least norm that move bodies as the answer does: where impulses are not unique (two bars
  /// touch the ground where a pin joins them) solvers find now these and now those. Without friction bound by
  /// forces solves once. False if there is no usable answer, or no bounds.
  [[nodiscard]] bool solve(const FrictionBoundProblem& problem, SolverChain& chain);

private:
  void find_null_space(const ContactProblem& problem);
  static void take_multipliers(const FrictionBoundProblem& problem);
  void take_forces(const FrictionBoundProblem& problem, bool least);
  [[nodiscard]] bool converge(const FrictionBoundProblem& problem, SolverChain& chain, int repetitions,
                              bool least);

  RankRevealingQr factors_;
  std::vector<double> null_;  // of W, orthonormal vectors one behind the other
  std::vector<double> vector_, found_, least_;
};

}  // namespace carom
