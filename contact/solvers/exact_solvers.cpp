// Problem: get an answer of rounding, or a proof that there is none, from the first solver that has one.

#include <carom/contact/solvers/exact_solvers.h>

#include <carom/contact/solvers/planar_certificate.h>
#include <carom/contact/solvers/warm_start.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <utility>

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

}  // namespace

/// Null of what is none of the solvers of an answer.
ContactSolver* ExactSolvers::solver(SolverId id) {
  switch (id) {
    case SolverId::single_contact:
      return &single_;
    case SolverId::principal_pivoting:
      return &pivoting_;
    case SolverId::lemke:
      return &lemke_;
    case SolverId::dense_sweeps:
      return &dense_sweeps_;
    case SolverId::nonlinear_cg:
    case SolverId::enumeration:
      break;
  }
  return nullptr;
}

void ExactSolvers::solve(const ContactProblem& problem, std::span<ContactMode> modes, ExactAttempt& state) {
  const bool alone = problem.groups().size() == 1;
  const SolverId first = alone ? SolverId::single_contact : SolverId::principal_pivoting;
  // All solutions of one contact are known, but not where it has rolling resistance.
  const bool knows_all = alone && (problem.rows() <= 2 || problem.sets()[1].kind == SetKind::bounded_disc);
  // An answer that came with the problem has been tried by sweeps and their polish. Where it is good enough,
  // Lemke's method, which has to repeat its path then, finds hardly better ones at many times the cost.
  const bool suffices = state.report.residual <= tolerated_residual;
  const bool sweeps = !state.basic || has_discs(problem);
  const bool done = (!knows_all && leave_open(problem, state)) || (!alone && fold(problem, state)) ||
                    (!alone && sweeps && sweep(problem, state)) || attempt(problem, first, state) ||
                    suffices || attempt(problem, SolverId::lemke, state) ||
                    (alone && attempt(problem, SolverId::dense_sweeps, state)) || approach(problem, state);
  if (!done && !(state.report.residual <= tolerated_residual)) {
    attempt(problem, SolverId::enumeration, state);
  }
  conclude(problem, modes, state);
}

// Takes the trial as the best answer so far if it is.
void ExactSolvers::keep(const Residual& found, SolverId id, Outcome outcome, bool degenerate,
                        ExactAttempt& state) {
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
    std::copy(trial_.begin(), trial_.end(), state.impulse.begin());
    std::copy(trial_xi_.begin(), trial_xi_.end(), state.xi.begin());
  }
}

bool ExactSolvers::attempt(const ContactProblem& problem, SolverId id, ExactAttempt& state) {
  state.last = id;
  trial_.resize(state.impulse.size());
  trial_xi_.resize(state.impulse.size());
  if (id == SolverId::enumeration) return enumerate(problem, state);
  ContactReport& report = state.report;
  ContactSolver* const asked = solver(id);
  if (asked == nullptr) {
    report.reason = not_applicable;
    return false;
  }
  const SolverAnswer answer = asked->solve(problem, trial_);
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
  problem.velocities(trial_, trial_xi_);
  Residual found = residual(problem, trial_, trial_xi_);
  bool degenerate = answer.degenerate;
  if (id != SolverId::single_contact) {
    if (found.value > polish_from) {
      found = polish_.improve(problem, trial_, polish_steps);
      if (found.value > accepted_residual) found = polish_.improve(problem, trial_, rescue_steps);
      problem.velocities(trial_, trial_xi_);
    }
    degenerate = degenerate || at_mode_boundary(problem, trial_, trial_xi_);
  }
  keep(found, id, answer.outcome, degenerate, state);
  return report.residual <= accepted_residual;
}

// By problems W + s D, b - s D P with D the traces of the groups, s smaller from one to the next: each is
// regular, so that pivoting does not lose its digits in rows that almost follow from each other (bodies that
// lie along each other), and an answer near P is one of the problem but for s times how far it is from P
// (the proximal point method: R. T. Rockafellar, SIAM J. Control Optim. 14 (1976) 877). P is an answer that
// is nearly one, with a small s, or else nothing, with s from 1 on: the first of these problems are of
// contacts that give way, whose modes Newton's method often finishes. Impulses without end are no answer:
// they leave a residual of about s. Nor are impulses that creep, as those of a body on a light one do that is
// too heavy for the digits there are: changes have to shrink.
bool ExactSolvers::approach(const ContactProblem& problem, ExactAttempt& state) {
  constexpr double near = 1e-6, softest = 1e-5, hardest = 1e-11, harder = 0.25;
  constexpr double shrinking = 0.5, without_end = 1e-2;
  constexpr int most_hardest = 3, most_failures = 2;
  if (state.report.residual <= state.aim || has_discs(problem)) return false;
  const bool is_near = state.report.residual <= near;
  anchor_.assign(state.impulse.begin(), state.impulse.end());
  if (!is_near) std::fill(anchor_.begin(), anchor_.end(), 0.0);
  double last = 0.0;
  int failures = 0, hard = 0;  // in a row; problems of the least s
  for (double s = is_near ? softest : 1.0; hard < most_hardest; s = std::max(harder * s, hardest)) {
    if (s == hardest) ++hard;
    if (!solve_near(problem, s)) {
      if (++failures == most_failures) return false;
      continue;
    }
    failures = 0;
    double change = 0.0;
    for (std::size_t row = 0; row < trial_.size(); ++row)
      change = std::max(change, std::abs(trial_[row] - anchor_[row]));
    anchor_ = trial_;
    const bool shrinks = change <= shrinking * std::exchange(last, change);
    if (!shrinks && s < softest) continue;
    const Residual found = polish_.improve(problem, trial_, rescue_steps);
    if (found.value > (shrinks ? without_end * s : accepted_residual)) continue;
    problem.velocities(trial_, trial_xi_);
    keep(found, SolverId::lemke, Outcome::solved, at_mode_boundary(problem, trial_, trial_xi_), state);
    if (state.report.residual <= state.aim) return true;
  }
  return false;
}

// Writes the answer of the problem near the anchor as the trial. False where it has none to rounding.
bool ExactSolvers::solve_near(const ContactProblem& problem, double softness) {
  near_ = problem;
  for (const RowGroup& group : problem.groups()) {
    const double added = softness * group_trace(problem, group);
    for (int i = group.first; i < group.first + group.size; ++i) {
      near_.w(i, i) += added;
      near_.vector()[static_cast<std::size_t>(i)] -= added * anchor_[static_cast<std::size_t>(i)];
    }
  }
  for (const SolverId id : {SolverId::principal_pivoting, SolverId::lemke}) {
    if (solver(id)->solve(near_, trial_).outcome == Outcome::no_solution) continue;
    if (polish_.improve(near_, trial_, rescue_steps).value <= tolerated_residual) return true;
  }
  return false;
}

// Sweeps over several contacts. Pivoting may know better where their answer is not one of rounding: light
// bodies among heavy ones move by what is left.
bool ExactSolvers::sweep(const ContactProblem& problem, ExactAttempt& state) {
  return attempt(problem, SolverId::dense_sweeps, state) &&
         (has_discs(problem) || state.report.residual <= certified_start);
}

// Takes no impulses if these are an answer: of several solutions the one that does nothing. It is told as
// that of the pivoting, whose scan ends where it begins if nothing approaches.
bool ExactSolvers::leave_open(const ContactProblem& problem, ExactAttempt& state) {
  constexpr double no_speed = 1e-14;  // of the largest velocity: rounding
  const std::span<const double> b = problem.vector();
  double largest = 0.0;
  for (const double velocity : b) largest = std::max(largest, std::abs(velocity));
  for (const RowGroup& group : problem.groups()) {
    const auto row = static_cast<std::size_t>(group.first);
    if (problem.sets()[row].kind != SetKind::half_line) return false;
    if (!(b[row] >= -no_speed * largest)) return false;
  }
  trial_.assign(state.impulse.size(), 0.0);
  trial_xi_.assign(b.begin(), b.end());
  const Residual found = residual(problem, trial_, trial_xi_);
  if (!(found.value <= accepted_residual)) return false;
  ++state.applicable;
  constexpr SolverId id = SolverId::principal_pivoting;
  state.report.tried = static_cast<std::uint8_t>(state.report.tried | 1u << static_cast<unsigned>(id));
  keep(found, id, Outcome::solved, at_mode_boundary(problem, trial_, trial_xi_), state);
  return true;
}

// Takes the answer that is its own image of a problem that is. It is told as that of the solver of one half.
bool ExactSolvers::fold(const ContactProblem& problem, ExactAttempt& state) {
  if (!mirror_.find(problem)) return false;
  const ContactProblem& half = mirror_.half();
  half_impulse_.resize(static_cast<std::size_t>(half.rows()));
  const bool alone = half.groups().size() == 1;
  for (const SolverId id : {SolverId::single_contact, SolverId::principal_pivoting, SolverId::lemke}) {
    if (alone != (id == SolverId::single_contact)) continue;
    const SolverAnswer answer = solver(id)->solve(half, half_impulse_);
    state.report.iterations += answer.iterations;
    if (answer.outcome == Outcome::not_solved || answer.outcome == Outcome::no_solution) continue;
    static_cast<void>(polish_.improve(half, half_impulse_, polish_steps));
    trial_.resize(state.impulse.size());
    trial_xi_.resize(state.impulse.size());
    mirror_.unfold(half_impulse_, trial_);
    problem.velocities(trial_, trial_xi_);
    Residual found = residual(problem, trial_, trial_xi_);
    if (found.value > polish_from) {
      found = polish_.improve(problem, trial_, polish_steps);
      problem.velocities(trial_, trial_xi_);
    }
    if (!(found.value <= accepted_residual)) continue;
    ++state.applicable;
    state.report.tried = static_cast<std::uint8_t>(state.report.tried | 1u << static_cast<unsigned>(id));
    keep(found, id, answer.outcome, answer.degenerate || at_mode_boundary(problem, trial_, trial_xi_), state);
    return state.report.residual <= accepted_residual;
  }
  return false;
}

bool ExactSolvers::enumerate(const ContactProblem& problem, ExactAttempt& state) {
  const Outcome outcome = list_.enumerate(problem);
  if (!list_.applicable()) {
    if (state.report.reason.empty()) state.report.reason = not_applicable;
    return false;
  }
  state.report.tried =
      static_cast<std::uint8_t>(state.report.tried | 1u << static_cast<unsigned>(SolverId::enumeration));
  state.proved_unsolvable = outcome == Outcome::no_solution && finite(problem);
  if (list_.size() > 0) {
    std::copy(list_.impulse(0).begin(), list_.impulse(0).end(), trial_.begin());
    problem.velocities(trial_, trial_xi_);
    keep(residual(problem, trial_, trial_xi_), SolverId::enumeration, outcome,
         at_mode_boundary(problem, trial_, trial_xi_), state);
  }
  return state.proved_unsolvable || state.report.residual <= accepted_residual;
}

void ExactSolvers::conclude(const ContactProblem& problem, std::span<ContactMode> modes,
                            ExactAttempt& state) {
  ContactReport& report = state.report;
  if (report.residual <= tolerated_residual) {
    report.reason = {};
  } else {
    report.outcome = state.proved_unsolvable ? Outcome::no_solution : Outcome::not_solved;
    if (report.reason.empty()) report.reason = "residual too large";
    if (state.proved_unsolvable) report.reason = "no mode is possible";
    if (state.proved_unsolvable || report.worst_group < 0) {
      // A proof, or nobody had anything to offer: nothing acts.
      std::fill(state.impulse.begin(), state.impulse.end(), 0.0);
      problem.velocities(state.impulse, state.xi);
      const Residual found = residual(problem, state.impulse, state.xi);
      report.residual = found.value;
      report.worst_group = found.group;
      report.solver = to_string(state.last);
    }
  }
  contact_modes(problem, state.impulse, state.xi, modes);
}

}  // namespace carom
