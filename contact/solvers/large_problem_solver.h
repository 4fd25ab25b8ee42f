#pragma once

/// \file
/// From a problem in factors to impulses that have been judged.

#include <carom/contact/solvers/contact_problem.h>
#include <carom/contact/solvers/contact_report.h>
#include <carom/contact/solvers/newton_polish.h>
#include <carom/contact/solvers/nonlinear_cg_solver.h>
#include <carom/contact/solvers/residual.h>
#include <carom/contact/solvers/sweep_budget.h>
#include <carom/contact/solvers/sweep_watch.h>

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace carom {

/// Judges the impulses that it is given, asks for sweeps where they are no answer, and judges again, by the
/// residual of residual.h on the problem itself. The modes that sweeps over a small problem find are solved
/// exactly (newton_polish.h), as the forces of a stack are far less certain than its residual.
class LargeProblemSolver {
public:
  /// Contacts up to which exact solvers are asked where sweeps do not end.
  static constexpr std::size_t most_exact = most_exact_contacts;
  /// Contacts up to which an answer that must not be used is polished all the same: some 0.1 s. Of a single
  /// body, and where bodies answer together, an answer at the cap is too, and exact solvers are asked after
  /// that; and at any number of contacts where the answer must not be used.
  static constexpr std::size_t most_polished = 200;

  /// Ratio of masses from which on heavy bodies on light ones need more sweeps than the budget has.
  static constexpr double uneven_masses = 1e3;

  /// Largest mass of a problem in factors over the smallest one; immovable bodies do not count.
  [[nodiscard]] static double mass_ratio(const ContactProblem& problem);

  /// Budget of an answer. Throws std::invalid_argument unless sweeps >= 0, 0 < residual and 0 <=
  /// accepted.
  void set_budget(const SweepBudget& budget);
  /// Improves impulses, and writes xi = W P + b, the modes of the groups and a report. Impulses that are an
  /// answer stay as they are.
  /// \param equations those of the modes of the impulses, as a problem of the same rows had them that was a
  /// little different: they are tried first; out: those that solved this one, if any did. Null: none
  void solve(const ContactProblem& problem, std::span<double> impulse, std::span<double> xi,
             std::span<ContactMode> modes, ContactReport& report, ModeEquations* equations = nullptr);
  /// M^-1 H^T P of the impulses that were written, three numbers a slot. Valid until the next solve().
  [[nodiscard]] std::span<const double> response() const { return slot_velocity_; }
  /// Outcome of an answer of some residual.
  [[nodiscard]] Outcome judged(double residual) const;
  /// True if the exact solvers may be asked for a problem whose sweeps did not end.
  /// \param report of the answer of solve()
  [[nodiscard]] bool has_dense(const ContactProblem& problem, const ContactReport& report) const;
  /// The last problem that was polished, with W in full.
  [[nodiscard]] const ContactProblem& dense() const { return dense_; }
  /// Has every sweep looked at from now on.
  void set_watch(SweepWatch watch) { sweeps_.set_watch(std::move(watch)); }

private:
  [[nodiscard]] int sweeps_of(const ContactProblem& problem) const;
  [[nodiscard]] Residual judge(const ContactProblem& problem, std::span<const double> impulse,
                               std::span<double> xi);
  void polish(const ContactProblem& problem, std::span<double> impulse);

  SweepBudget budget_;
  NonlinearCgSolver sweeps_;
  NewtonPolish polish_;
  ContactProblem dense_;
  std::vector<double> slot_velocity_;
};

}  // namespace carom
