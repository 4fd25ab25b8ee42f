#pragma once

/// \file
/// Which contacts of an island stay closed, which of these stick? Decided on the level of accelerations
/// (docs/method.md, section 7): contacts that touch without speed get forces by the law of contact with e =
/// 0, written for accelerations; one that slips already has its friction against the motion. A problem
/// without answer, or with several, is Painleve's: the contact and the quantity that cause it are named.

#include <carom/contact/active_set.h>
#include <carom/contact/island_problem.h>
#include <carom/contact/solvers/newton_polish.h>
#include <carom/contact/solvers/solution_list.h>
#include <carom/contact/solvers/solver_chain.h>
#include <carom/core/constraint_set.h>
#include <carom/core/export.h>
#include <carom/integrators/event_driven/modes_by_motion.h>
#include <carom/integrators/event_driven/slip_directions.h>
#include <carom/integrators/event_driven/smooth_motion.h>

#include <array>
#include <span>
#include <vector>

namespace carom {

/// Result of a decision.
enum class Decision : std::uint8_t {
  made,        ///< modes are given
  several,     ///< modes are given, chosen by rule among several
  impossible,  ///< no forces exist: an impact without collision is due
  failed       ///< no solver found an answer
};

/// Forces on a candidate by row [N]; 0 where it takes no part.
using ForceOnCandidate = std::array<double, Constraint::max_rows>;

/// Decides for the contacts of one island at a time. Keeps memory only.
class CAROM_API ModeDecision {
public:
  /// Decides by the solvers. \param now sample without contacts that the motion made last; its accelerations
  /// are put back
  Decision decide(SmoothMotion& motion, MotionSample& now, std::span<Candidate> candidates,
                  SolverChain& chain);
  /// Decides by forces found otherwise, by candidate. `failed` if they are no answer, to the tolerance of the
  /// certificate. \param now sample without contacts that the motion made last; its accelerations are put
  /// back
  Decision decide_by(std::span<const ForceOnCandidate> forces, SmoothMotion& motion, MotionSample& now,
                     std::span<Candidate> candidates);
  /// The last problem and its answer.
  [[nodiscard]] const IslandProblem& problem() const { return problem_; }
  /// Candidates by constraint of the last problem.
  [[nodiscard]] std::span<const std::size_t> taking_part() const { return taking_part_; }
  /// Accelerations of all bodies by the last answer.
  [[nodiscard]] const double* acceleration() const { return acceleration_.data(); }

private:
  void take_accelerations(const SmoothMotion& motion, const MotionSample& now);
  using Solve = Decision (ModeDecision::*)(SmoothMotion&, MotionSample&, std::span<Candidate>, SolverChain&);
  Decision repeat(Solve once, SmoothMotion& motion, MotionSample& now, std::span<Candidate> candidates,
                  SolverChain& chain);
  void list_contacts(std::span<Candidate> candidates);
  [[nodiscard]] bool bounds_follow(SmoothMotion& motion) const;
  void build(SmoothMotion& motion, const MotionSample& now);
  Decision solve(SmoothMotion& motion, MotionSample& now, std::span<Candidate> candidates,
                 SolverChain& chain);
  Decision solve_as_limit(SmoothMotion& motion, MotionSample& now, std::span<Candidate> candidates,
                          SolverChain& chain);
  bool take_present(std::span<Candidate> candidates);
  void take(std::span<Candidate> candidates, std::size_t solution);
  [[nodiscard]] bool finds_several(std::span<Candidate> candidates);
  void read_modes(std::span<Candidate> candidates, std::span<const double> force);
  bool converge_friction_bounds(SmoothMotion& motion, MotionSample& now, std::span<Candidate> candidates,
                                SolverChain& chain);
  void settle_modes(SmoothMotion& motion, MotionSample& now, std::span<Candidate> candidates);
  [[nodiscard]] bool keeps_motion(SmoothMotion& motion, MotionSample& now,
                                  std::span<const Candidate> candidates);
  [[nodiscard]] bool pulls_again(SmoothMotion& motion, MotionSample& now,
                                 std::span<const Candidate> candidates);
  void complete_modes(SmoothMotion& motion, MotionSample& now, std::span<Candidate> candidates);
  void list_closed(std::span<const Candidate> candidates);

  IslandProblem problem_{{.basic_impulses = true}};
  SolutionList solutions_;
  NewtonPolish polish_;
  ConstraintSet contacts_;
  std::vector<std::size_t> taking_part_;  // candidates by contact of the problem
  SlipDirections slips_;
  std::vector<double> zero_, acceleration_;
  std::vector<double> given_;          // forces by row [N]
  double size_ = 0.0;                  // of accelerations along rows, without contact [m/s^2]
  std::vector<ActiveContact> active_;  // those that stay, in the order of contacts_
  std::vector<ForceMargin> margins_;
  std::vector<ContactMode> by_forces_;  // modes of the answer
  MotionComparison comparison_;
};

}  // namespace carom
