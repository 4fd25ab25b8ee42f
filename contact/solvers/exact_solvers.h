#pragma once

/// \file
/// The exact solvers of a dense contact problem, tried in turn, each answer judged before it is used.

#include <carom/contact/solvers/contact_mode.h>
#include <carom/contact/solvers/contact_problem.h>
#include <carom/contact/solvers/contact_report.h>
#include <carom/contact/solvers/contact_solver.h>
#include <carom/contact/solvers/dense_sweeps_solver.h>
#include <carom/contact/solvers/mirror_fold.h>
#include <carom/contact/solvers/newton_polish.h>
#include <carom/contact/solvers/pivoting_solvers.h>
#include <carom/contact/solvers/residual.h>
#include <carom/contact/solvers/single_contact.h>
#include <carom/contact/solvers/solution_list.h>
#include <carom/contact/solvers/sweep_watch.h>

#include <span>
#include <utility>
#include <vector>

namespace carom {

/// Answer under way: where the best one so far is written, and who has been asked.
struct ExactAttempt {
  std::span<double> impulse, xi;  ///< of the best answer [N s], [m/s]
  ContactReport& report;          ///< of the best answer
  SolverId best = SolverId::single_contact;
  SolverId last = SolverId::single_contact;  ///< asked last
  bool proved_unsolvable = false;            ///< by the last one
  int applicable = 0;                        ///< solvers that could be tried
  double aim = accepted_residual;            ///< from above which on problems nearby are asked, too
  bool basic = false;                        ///< impulses that are not unique are to be basic ones
};

/// One contact exactly by its modes, several by principal pivoting, then Lemke, many and those with discs
/// first by sweeps (dense_sweeps_solver.h), those of the plane only where impulses need not be basic, as
/// pivoting finds them; where these leave more than the aim by problems nearby that are regular; up to three
/// by enumeration of the modes when all else failed. An answer of sweeps over factors that is good enough is
/// only shown to principal pivoting. Contacts that all separate, and one with rolling resistance, get no
/// impulses: where friction is strong the solvers might find another solution. A problem that is its own
/// image in a mirror gets an answer that is so too (mirror_fold.h), where there is one. Reuse it: its memory
/// is kept.
class ExactSolvers {
public:
  /// Tries solvers until an answer is accepted, and concludes.
  void solve(const ContactProblem& problem, std::span<ContactMode> modes, ExactAttempt& state);
  /// Tries one solver; returns whether the search is over: an accepted answer, or a proof that there is none.
  bool attempt(const ContactProblem& problem, SolverId id, ExactAttempt& state);
  /// Judges what was found, and reads the modes off it.
  static void conclude(const ContactProblem& problem, std::span<ContactMode> modes, ExactAttempt& state);
  /// Has every sweep over dense problems looked at from now on.
  void set_watch(SweepWatch watch) { dense_sweeps_.set_watch(std::move(watch)); }

private:
  [[nodiscard]] ContactSolver* solver(SolverId id);
  bool enumerate(const ContactProblem& problem, ExactAttempt& state);
  bool approach(const ContactProblem& problem, ExactAttempt& state);
  bool solve_near(const ContactProblem& problem, double softness);
  bool sweep(const ContactProblem& problem, ExactAttempt& state);
  bool leave_open(const ContactProblem& problem, ExactAttempt& state);
  bool fold(const ContactProblem& problem, ExactAttempt& state);
  void keep(const Residual& found, SolverId id, Outcome outcome, bool degenerate, ExactAttempt& state);

  SingleContactSolver single_;
  PrincipalPivotingSolver pivoting_;
  LemkeSolver lemke_;
  DenseSweepsSolver dense_sweeps_;
  SolutionList list_;
  NewtonPolish polish_;
  std::vector<double> trial_, trial_xi_;
  ContactProblem near_;  // the problem, made regular
  MirrorFold mirror_;
  std::vector<double> half_impulse_;  // of what the mirror leaves
  std::vector<double> anchor_;        // impulses at which it is the problem itself
};

}  // namespace carom
