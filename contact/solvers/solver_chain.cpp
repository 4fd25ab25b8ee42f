// Problem: get impulses that are right, know how right, and know who found them.

#include <carom/contact/solvers/solver_chain.h>

#include <carom/contact/solvers/large_problem_solver.h>
#include <carom/contact/solvers/newton_polish.h>
#include <carom/contact/solvers/pivoting_solvers.h>
#include <carom/contact/solvers/projection_solver.h>
#include <carom/contact/solvers/single_contact.h>
#include <carom/contact/solvers/solution_list.h>
#include <carom/contact/solvers/warm_start.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

namespace carom {

namespace {

// Answers of a larger residual are polished before they are judged. Below, nothing is left to gain.
constexpr double polish_from = 1e-16;
constexpr int polish_steps = 3;
// Steps where these leave the answer unacceptable: far from rounding, modes still change.
constexpr int rescue_steps = 30;

constexpr std::string_view not_applicable = "not applicable";

// A proof about numbers that are none is no proof.
bool finite(const ContactProblem& problem) {
  const auto good = [](double value) { return std::isfinite(value); };
  return std::ranges::all_of(problem.matrix(), good) && std::ranges::all_of(problem.vector(), good);
}

void demand_grouped(const ContactProblem& problem, std::span<const double> impulse) {
  const auto rows = static_cast<std::size_t>(problem.rows());
  if (impulse.size() != rows) throw std::invalid_argument("contact solver: one impulse for each row");
  if (rows == 0 || !problem.groups().empty()) return;
  throw std::invalid_argument("contact solver: the problem is not grouped");
}

}  // namespace

struct SolverChain::Workspace {
  SingleContactSolver single;
  PrincipalPivotingSolver pivoting;
  LemkeSolver lemke;
  ProjectionSolver projection;
  SolutionList list;
  NewtonPolish polish;
  WarmStart warm_start;
  LargeProblemSolver large;
  ChainStatistics statistics;
  std::vector<double> trial, trial_xi, xi, start;  // the last: impulses of a start
  std::vector<ContactMode> modes, start_modes;

  // Result of the solvers tried so far.
  struct Attempt {
    ContactReport& report;  // of the best answer
    SolverId best = SolverId::single_contact;
    SolverId last = SolverId::single_contact;  // asked last
    bool proved_unsolvable = false;            // by the last one
    int applicable = 0;                        // solvers that could be tried
  };

  bool begin(const ContactProblem& problem, std::span<double> impulse, ContactReport& report);
  bool solve_regular(const ContactProblem& problem, std::span<double> impulse, ContactReport& report);
  bool attempt(const ContactProblem& problem, SolverId id, std::span<double> impulse, Attempt& state);
  bool enumerate(const ContactProblem& problem, std::span<double> impulse, Attempt& state);
  void keep(const Residual& found, SolverId id, Outcome outcome, bool degenerate, std::span<double> impulse,
            Attempt& state);
  void conclude(const ContactProblem& problem, std::span<double> impulse, Attempt& state);
  void sweep(const ContactProblem& problem, std::span<double> impulse, ContactReport& report);

  ContactSolver& solver(SolverId id) {
    switch (id) {
      case SolverId::principal_pivoting:
        return pivoting;
      case SolverId::lemke:
        return lemke;
      case SolverId::projection:
        return projection;
      case SolverId::nonlinear_cg:
        return large.sweeps();
      case SolverId::single_contact:
      case SolverId::enumeration:
        break;
    }
    return single;
  }
};

// Sizes the workspace; false for a problem without rows, which is solved.
bool SolverChain::Workspace::begin(const ContactProblem& problem, std::span<double> impulse,
                                   ContactReport& report) {
  const std::size_t n = impulse.size();
  trial.resize(n);
  trial_xi.resize(n);
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
  if (impulse.size() != 2 || problem.groups().size() != 1 || problem.sets().size() != 2 ||
      problem.sets()[0].kind != SetKind::half_line || problem.sets()[1].kind != SetKind::bounded_interval) {
    return false;
  }
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
  ++statistics.problems;
  ++statistics.tried[id];
  ++statistics.accepted[id];
  if (answer.degenerate) ++statistics.degenerate;
  statistics.count_residual(answer.residual);
  return true;
}

// Takes the trial as the best answer so far if it is.
void SolverChain::Workspace::keep(const Residual& found, SolverId id, Outcome outcome, bool degenerate,
                                  std::span<double> impulse, Attempt& state) {
  ContactReport& report = state.report;
  if (found.value < report.residual || report.worst_group < 0) {
    report.residual = found.value;
    report.worst_group = found.group;
    report.degenerate = degenerate;
    // Whether a solver was sure of itself is not asked: the residual judges.
    const bool named = outcome == Outcome::several_solutions || outcome == Outcome::forces_not_unique;
    report.outcome = named ? outcome : Outcome::solved;
    report.solver = to_string(id);
    state.best = id;
    std::copy(trial.begin(), trial.end(), impulse.begin());
    std::copy(trial_xi.begin(), trial_xi.end(), xi.begin());
  }
}

// Tries one solver; returns whether the search is over: an accepted answer, or a proof that there is none.
bool SolverChain::Workspace::attempt(const ContactProblem& problem, SolverId id, std::span<double> impulse,
                                     Attempt& state) {
  state.last = id;
  if (id == SolverId::enumeration) return enumerate(problem, impulse, state);
  const SolverAnswer answer = solver(id).solve(problem, trial);
  ContactReport& report = state.report;
  report.iterations += answer.iterations;
  if (answer.outcome == Outcome::not_solved) {
    report.reason = answer.reason;
    if (answer.reason == not_applicable) return false;
  }
  ++state.applicable;
  report.tried = static_cast<std::uint8_t>(report.tried | 1u << static_cast<unsigned>(id));
  if (answer.outcome == Outcome::no_solution) {
    report.reason = answer.reason;
    state.proved_unsolvable = finite(problem);
    return true;
  }
  // Where the scan gives up it has no point to offer; the others end near one, and polishing may reach it.
  if (answer.outcome == Outcome::not_solved && id == SolverId::principal_pivoting) return false;
  problem.velocities(trial, trial_xi);
  Residual found = residual(problem, trial, trial_xi);
  bool degenerate = answer.degenerate;
  if (id != SolverId::single_contact) {
    if (found.value > polish_from) {
      found = polish.improve(problem, trial, polish_steps);
      if (found.value > accepted_residual) found = polish.improve(problem, trial, rescue_steps);
      problem.velocities(trial, trial_xi);
    }
    degenerate = degenerate || at_mode_boundary(problem, trial, trial_xi);
  }
  keep(found, id, answer.outcome, degenerate, impulse, state);
  return report.residual <= accepted_residual;
}

bool SolverChain::Workspace::enumerate(const ContactProblem& problem, std::span<double> impulse,
                                       Attempt& state) {
  const Outcome outcome = list.enumerate(problem);
  if (!list.applicable()) {
    if (state.report.reason.empty()) state.report.reason = not_applicable;
    return false;
  }
  state.report.tried =
      static_cast<std::uint8_t>(state.report.tried | 1u << static_cast<unsigned>(SolverId::enumeration));
  state.proved_unsolvable = outcome == Outcome::no_solution && finite(problem);
  if (list.size() > 0) {
    std::copy(list.impulse(0).begin(), list.impulse(0).end(), trial.begin());
    problem.velocities(trial, trial_xi);
    keep(residual(problem, trial, trial_xi), SolverId::enumeration, outcome,
         at_mode_boundary(problem, trial, trial_xi), impulse, state);
  }
  return state.proved_unsolvable || state.report.residual <= accepted_residual;
}

// Judges what was found, and reads the modes off it.
void SolverChain::Workspace::conclude(const ContactProblem& problem, std::span<double> impulse,
                                      Attempt& state) {
  ContactReport& report = state.report;
  if (report.residual <= tolerated_residual) {
    report.reason = {};
  } else {
    report.outcome = state.proved_unsolvable ? Outcome::no_solution : Outcome::not_solved;
    if (report.reason.empty()) report.reason = "residual too large";
    if (state.proved_unsolvable) report.reason = "no mode is possible";
    if (state.proved_unsolvable || report.worst_group < 0) {
      // A proof, or nobody had anything to offer: nothing acts.
      std::fill(impulse.begin(), impulse.end(), 0.0);
      problem.velocities(impulse, xi);
      const Residual found = residual(problem, impulse, xi);
      report.residual = found.value;
      report.worst_group = found.group;
      report.solver = to_string(state.last);
    }
  }
  for (std::size_t g = 0; g < modes.size(); ++g) {
    modes[g] = contact_mode(problem, problem.groups()[g], impulse, xi);
  }
}

// A problem in factors, from the impulses at hand.
void SolverChain::Workspace::sweep(const ContactProblem& problem, std::span<double> impulse,
                                   ContactReport& report) {
  if (begin(problem, impulse, report)) large.solve(problem, impulse, xi, modes, report);
}

SolverChain::SolverChain() : work_(std::make_unique<Workspace>()) {}
SolverChain::~SolverChain() = default;
SolverChain::SolverChain(SolverChain&&) noexcept = default;
SolverChain& SolverChain::operator=(SolverChain&&) noexcept = default;

ContactReport SolverChain::solve(const ContactProblem& problem, std::span<double> impulse) {
  ContactReport report;
  solve(problem, impulse, report);
  return report;
}

/// The report is built where the caller reads it: copying it would cost as much as solving a contact.
void SolverChain::solve(const ContactProblem& problem, std::span<double> impulse, ContactReport& report) {
  Workspace& work = *work_;
  if (work.solve_regular(problem, impulse, report)) return;
  demand_grouped(problem, impulse);
  report = {};
  if (problem.is_factored()) {
    std::fill(impulse.begin(), impulse.end(), 0.0);
    work.sweep(problem, impulse, report);
    return count(report, SolverId::nonlinear_cg, 1, work.statistics);
  }
  if (!work.begin(problem, impulse, report)) return;
  Workspace::Attempt attempt{.report = report};
  const SolverId first =
      problem.groups().size() == 1 ? SolverId::single_contact : SolverId::principal_pivoting;
  const bool done = work.attempt(problem, first, impulse, attempt) ||
                    work.attempt(problem, SolverId::lemke, impulse, attempt) ||
                    work.attempt(problem, SolverId::projection, impulse, attempt);
  if (!done && !(report.residual <= tolerated_residual)) {
    work.attempt(problem, SolverId::enumeration, impulse, attempt);
  }
  work.conclude(problem, impulse, attempt);
  count(report, attempt.best, attempt.applicable, work.statistics);
}

void SolverChain::solve(const ContactProblem& problem, ContactSolution& solution) {
  Workspace& work = *work_;
  ContactReport& report = solution.report;
  const bool warm = std::exchange(solution.known, true) && report.usable();
  const bool several = problem.groups().size() > 1;
  solution.changed_modes = false;
  if (!warm && solution.modes.size() == 1 && work.solve_regular(problem, solution.impulse, report)) {
    solution.modes[0] = work.modes[0];
    return;
  }
  if (problem.is_factored()) {
    demand_grouped(problem, solution.impulse);
    report = {};
    work.sweep(problem, solution.impulse, report);
    count(report, SolverId::nonlinear_cg, 1, work.statistics);
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
  if (warm) {
    work.start.assign(solution.impulse.begin(), solution.impulse.end());
    work.start_modes.assign(solution.modes.begin(), solution.modes.end());
  }
  solve(problem, solution.impulse, report);
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
  Workspace::Attempt attempt{.report = report, .last = solver};
  if (!problem.is_factored()) {
    work_->attempt(problem, solver, impulse, attempt);
  } else if (solver != SolverId::nonlinear_cg) {
    report.reason = not_applicable;
  } else {
    std::fill(impulse.begin(), impulse.end(), 0.0);
    work_->sweep(problem, impulse, report);
    return report;
  }
  work_->conclude(problem, impulse, attempt);
  return report;
}

void SolverChain::set_budget(const SweepBudget& budget) { work_->large.set_budget(budget); }

std::span<const double> SolverChain::velocities() const { return work_->xi; }
std::span<const ContactMode> SolverChain::modes() const { return work_->modes; }
const ChainStatistics& SolverChain::statistics() const { return work_->statistics; }
void SolverChain::reset_statistics() { work_->statistics = {}; }

}  // namespace carom
