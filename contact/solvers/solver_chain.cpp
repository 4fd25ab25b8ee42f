// Problem: get impulses that are right, know how right, and know who found them.

#include <carom/contact/solvers/solver_chain.h>

#include <carom/contact/solvers/exact_solvers.h>
#include <carom/contact/solvers/large_problem_solver.h>
#include <carom/contact/solvers/planar_certificate.h>
#include <carom/contact/solvers/regular_counts.h>
#include <carom/contact/solvers/single_contact.h>
#include <carom/contact/solvers/warm_start.h>

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

namespace carom {

namespace {

void demand_grouped(const ContactProblem& problem, std::span<const double> impulse) {
  const auto rows = static_cast<std::size_t>(problem.rows());
  if (impulse.size() != rows) throw std::invalid_argument("contact solver: one impulse for each row");
  if (rows == 0 || !problem.groups().empty()) return;
  throw std::invalid_argument("contact solver: the problem is not grouped");
}

}  // namespace

struct SolverChain::Workspace {
  ExactSolvers exact;
  WarmStart warm_start;
  LargeProblemSolver large;
  ChainStatistics statistics;  // but for `regular`
  RegularCounts regular;
  std::vector<double> xi, start;  // the last: impulses of a start
  std::vector<ContactMode> modes, start_modes;
  bool capped = false;  // a budget was set: it judges other problems too

  bool certify(const ContactProblem& problem, ContactSolution& solution);
  bool begin(const ContactProblem& problem, std::span<double> impulse, ContactReport& report);
  bool solve_regular(const ContactProblem& problem, std::span<double> impulse, ContactReport& report);
  void take_at_cap(const ExactAttempt& attempt, ContactReport& report) const;
  [[nodiscard]] bool is_nearly_solved(const ContactProblem& problem, std::span<const double> impulse,
                                      const ContactReport& report) const;
  void sweep(const ContactProblem& problem, std::span<double> impulse, ContactReport& report,
             ModeEquations* equations = nullptr);
  bool sweep_or_solve(const ContactProblem& problem, std::span<double> impulse, ContactReport& report,
                      ModeEquations* equations = nullptr);
};

// Sizes the workspace; false for a problem without rows, which is solved.
bool SolverChain::Workspace::begin(const ContactProblem& problem, std::span<double> impulse,
                                   ContactReport& report) {
  const std::size_t n = impulse.size();
  xi.resize(n);
  modes.resize(problem.groups().size());
  if (n > 0) return true;
  report.outcome = Outcome::solved;
  report.residual = 0.0;
  return false;
}

// The hot path: one planar contact, regular and unique. False where the long way has to be gone.
bool SolverChain::Workspace::solve_regular(const ContactProblem& problem, std::span<double> impulse,
                                           ContactReport& report) {
  if (!problem.is_one_planar_contact() || impulse.size() != 2) return false;
  const CertifiedImpulse answer = solve_regular_contact(problem);
  if (!answer.usable || !(answer.residual <= accepted_residual)) return false;
  impulse[0] = answer.impulse.normal;
  impulse[1] = answer.impulse.tangential;
  if (xi.size() != 2) xi.resize(2);
  xi[0] = answer.xi_n;
  xi[1] = answer.xi_t;
  if (modes.size() != 1) modes.resize(1);
  modes[0] = answer.mode;
  constexpr auto id = static_cast<std::size_t>(SolverId::single_contact);
  report.outcome = Outcome::solved;
  report.degenerate = answer.degenerate;
  report.residual = answer.residual;
  report.worst_group = 0;
  report.iterations = 1;
  report.tried = 1u << id;
  report.solver = solver_names[id];
  report.reason = {};
  regular.count(answer.residual, answer.degenerate);
  return true;
}

// Impulses to start from that are an answer as they are: of contacts at rest those of the step before. They
// are told as those of the pivoting, whose scan ends where it begins.
bool SolverChain::Workspace::certify(const ContactProblem& problem, ContactSolution& solution) {
  constexpr auto id = SolverId::principal_pivoting;
  const auto acts = [](double impulse) { return impulse != 0.0; };
  if (std::none_of(solution.impulse.begin(), solution.impulse.end(), acts)) return false;
  demand_grouped(problem, solution.impulse);
  ContactReport& report = solution.report;
  if (!begin(problem, solution.impulse, report)) return false;
  problem.velocities(solution.impulse, xi);
  const Residual found = residual(problem, solution.impulse, xi);
  if (!(found.value <= certified_start)) return false;
  report = {};
  report.outcome = Outcome::solved;
  report.residual = found.value;
  report.worst_group = found.group;
  report.degenerate = at_mode_boundary(problem, solution.impulse, xi);
  report.solver = to_string(id);
  contact_modes(problem, solution.impulse, xi, modes);
  solution.modes.assign(modes.begin(), modes.end());
  count(report, id, 1, statistics);
  return true;
}

// A problem in factors, from the impulses at hand.
void SolverChain::Workspace::sweep(const ContactProblem& problem, std::span<double> impulse,
                                   ContactReport& report, ModeEquations* equations) {
  if (begin(problem, impulse, report)) large.solve(problem, impulse, xi, modes, report, equations);
}

// Sweeps a problem in factors from the impulses at hand; a small one is solved by the exact solvers where the
// modes of the sweeps are not those of the answer. True if the impulses are those that `large` has judged.
bool SolverChain::Workspace::sweep_or_solve(const ContactProblem& problem, std::span<double> impulse,
                                            ContactReport& report, ModeEquations* equations) {
  sweep(problem, impulse, report, equations);
  ExactAttempt attempt{
      impulse, xi, report, SolverId::nonlinear_cg, SolverId::nonlinear_cg, false, 1, tolerated_residual};
  const bool is_left = !(report.residual <= accepted_residual) && large.has_dense(problem, report);
  if (is_left) {
    exact.solve(large.dense(), modes, attempt);
    take_at_cap(attempt, report);
  }
  count(report, attempt.best, attempt.applicable, statistics);
  return !is_left;
}

// Where no solver finishes, the best answer is judged by the budget.
void SolverChain::Workspace::take_at_cap(const ExactAttempt& attempt, ContactReport& report) const {
  if (!report.usable() && !attempt.proved_unsolvable) report.outcome = large.judged(report.residual);
}

// Farther off, few contacts may have no solution at all: that is an error. Bodies that jam, with velocities
// that their contacts cannot all have but for their rounding or for what turning left, have none that is
// nearer.
bool SolverChain::Workspace::is_nearly_solved(const ContactProblem& problem, std::span<const double> impulse,
                                              const ContactReport& report) const {
  constexpr double nearly_solved = 1e-7, of_velocities = 1e-4;
  return report.residual <= nearly_solved || residual_of_velocities(problem, impulse, xi) <= of_velocities;
}

SolverChain::SolverChain() : work_(new Workspace) {}
SolverChain::~SolverChain() = default;
SolverChain::SolverChain(SolverChain&&) noexcept = default;
SolverChain& SolverChain::operator=(SolverChain&&) noexcept = default;

ContactReport SolverChain::solve(const ContactProblem& problem, std::span<double> impulse) {
  ContactReport report;
  solve(problem, impulse, report, false);
  return report;
}

/// The report is built where the caller reads it: copying it would cost as much as solving a contact.
void SolverChain::solve(const ContactProblem& problem, std::span<double> impulse, ContactReport& report,
                        bool basic) {
  Workspace& work = *work_;
  if (work.solve_regular(problem, impulse, report)) return;
  demand_grouped(problem, impulse);
  report = {};
  if (problem.is_factored()) {
    std::fill(impulse.begin(), impulse.end(), 0.0);
    work.sweep_or_solve(problem, impulse, report);
    return;
  }
  if (!work.begin(problem, impulse, report)) return;
  ExactAttempt attempt{.impulse = impulse,
                       .xi = work.xi,
                       .report = report,
                       .aim = work.capped ? tolerated_residual : accepted_residual,
                       .basic = basic};
  work.exact.solve(problem, work.modes, attempt);
  if (work.capped && !report.usable() && work.is_nearly_solved(problem, impulse, report)) {
    work.take_at_cap(attempt, report);
  }
  count(report, attempt.best, attempt.applicable, work.statistics);
}

void SolverChain::solve(const ContactProblem& problem, ContactSolution& solution, ModeEquations* equations) {
  Workspace& work = *work_;
  ContactReport& report = solution.report;
  const bool warm = std::exchange(solution.known, true) && report.usable();
  const bool several = problem.groups().size() > 1;
  solution.changed_modes = false;
  solution.response.clear();
  if (!warm && solution.modes.size() == 1 && work.solve_regular(problem, solution.impulse, report)) {
    solution.modes[0] = work.modes[0];
    return;
  }
  if (problem.is_factored()) {
    demand_grouped(problem, solution.impulse);
    report = {};
    if (!warm && equations != nullptr) equations->pieces.clear();
    if (work.sweep_or_solve(problem, solution.impulse, report, equations)) {
      const std::span<const double> response = work.large.response();
      solution.response.assign(response.begin(), response.end());
    }
    solution.changed_modes = warm && solution.modes != work.modes;
    solution.modes.assign(work.modes.begin(), work.modes.end());
    return;
  }
  Residual found;
  const auto keep = [&](std::span<const ContactMode> modes, std::vector<double>& impulse) {
    if (!work.warm_start.keep_modes(problem, modes, impulse, found)) return false;
    report.residual = found.value;
    report.worst_group = found.group;
    return true;
  };
  if (warm && several && keep(solution.modes, solution.impulse)) return;
  if (!warm && several && work.certify(problem, solution)) return;
  if (warm) {
    work.start.assign(solution.impulse.begin(), solution.impulse.end());
    work.start_modes.assign(solution.modes.begin(), solution.modes.end());
  }
  solve(problem, solution.impulse, report, solution.basic);
  solution.modes.assign(work.modes.begin(), work.modes.end());
  solution.changed_modes = warm && solution.modes != work.start_modes;
  if (!solution.changed_modes || several || !keep(work.start_modes, work.start)) return;
  if (report.usable()) report.outcome = Outcome::several_solutions;
  solution.impulse.swap(work.start);
  solution.modes.swap(work.start_modes);
  solution.changed_modes = false;
}

ContactReport SolverChain::solve_with(SolverId solver, const ContactProblem& problem,
                                      std::span<double> impulse) {
  demand_grouped(problem, impulse);
  ContactReport report;
  if (!work_->begin(problem, impulse, report)) return report;
  ExactAttempt attempt{.impulse = impulse, .xi = work_->xi, .report = report, .last = solver};
  if (!problem.is_factored()) {
    work_->exact.attempt(problem, solver, attempt);
  } else if (solver != SolverId::nonlinear_cg) {
    report.reason = "not applicable";
  } else {
    std::fill(impulse.begin(), impulse.end(), 0.0);
    work_->sweep(problem, impulse, report);
    return report;
  }
  ExactSolvers::conclude(problem, work_->modes, attempt);
  return report;
}

void SolverChain::set_budget(const SweepBudget& budget) {
  work_->large.set_budget(budget);
  work_->capped = true;
}

void SolverChain::set_watch(const SweepWatch& watch) {
  work_->exact.set_watch(watch);
  work_->large.set_watch(watch);
}

std::span<const double> SolverChain::velocities() const { return work_->xi; }
std::span<const ContactMode> SolverChain::modes() const { return work_->modes; }
const ChainStatistics& SolverChain::statistics() const {
  work_->regular.add_to(work_->statistics);
  work_->regular = {};
  return work_->statistics;
}
void SolverChain::take_statistics(ChainStatistics& sum) {
  Workspace& work = *work_;
  if (work.regular.problems > 0) work.regular.add_to(sum);
  work.regular = {};
  if (work.statistics.problems == 0) return;
  sum += work.statistics;
  work.statistics = {};
}
void SolverChain::reset_statistics() {
  work_->regular = {};
  if (work_->statistics.problems > 0) work_->statistics = {};
}

}  // namespace carom
