// Problem: impulses of an impact by Poisson's or the energetic law.

#include <carom/contact/solvers/impact_solver.h>

#include <carom/contact/solvers/contact_mode.h>
#include <carom/contact/solvers/impact_path.h>
#include <carom/contact/solvers/planar_certificate.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace carom {

namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();
// Impulses and velocities below this part of the largest are rounding.
constexpr double rounding = 1e-13;
// Steps to the scale of expansion; regula falsi with halved weights gains a digit or more with each.
constexpr int most_scalings = 200;

double largest(std::span<const double> numbers) {
  double size = 0.0;
  for (const double number : numbers) size = std::max(size, std::abs(number));
  return size;
}

/// True if the problem is one planar contact, with rolling resistance or without.
bool is_one_contact(const ContactProblem& problem) {
  if (problem.groups().size() != 1 || problem.sets()[0].kind != SetKind::half_line) return false;
  const std::span<const RowSet> dry = problem.sets().subspan(1);
  return dry.size() <= 2 && std::all_of(dry.begin(), dry.end(), [](const RowSet& set) {
           return set.kind == SetKind::bounded_interval;
         });
}

/// One contact, as its path is followed. \param before velocities of its rows
ImpactPathInput path_of(const ContactProblem& problem, std::span<const double> before, double restitution) {
  ImpactPathInput in{.wnn = problem.w(0, 0), .restitution = restitution, .normal = before[0]};
  if (problem.rows() > 1) {
    in.wnt = problem.w(0, 1);
    in.wtt = problem.w(1, 1);
    in.friction = problem.sets()[1].coefficient;
    in.tangential = before[1];
  }
  if (problem.rows() > 2) {
    in.wnr = problem.w(0, 2);
    in.wtr = problem.w(1, 2);
    in.wrr = problem.w(2, 2);
    in.rolling_resistance = problem.sets()[2].coefficient;
    in.spin = before[2];
  }
  return in;
}

/// The exact answer of one contact. False if there is none.
bool follow(const ContactProblem& problem, std::span<const double> before, double restitution,
            ContactSolution& answer) {
  const auto n = static_cast<std::size_t>(problem.rows());
  ContactReport& report = answer.report;
  report = {};
  report.solver = "impact path";
  report.worst_group = 0;
  answer.modes.assign(1, ContactMode::open);
  const auto end = follow_impact(path_of(problem, before, restitution));
  if (!end) {
    report.outcome = Outcome::no_solution;
    report.reason = "no impulse ends the compression";
    return false;
  }
  const std::array<double, 3> impulse{end->normal_impulse, end->tangential_impulse, end->rolling_moment},
      after{end->normal, end->tangential, end->spin};
  std::copy_n(impulse.begin(), n, answer.impulse.begin());
  double error = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    double velocity = before[i];
    for (std::size_t j = 0; j < n; ++j)
      velocity += problem.w(static_cast<int>(i), static_cast<int>(j)) * impulse[j];
    error = std::max(error, std::abs(velocity - after[i]));
  }
  const double size = largest(before);
  report.residual = size > 0.0 ? error / size : 0.0;
  report.outcome = report.residual <= 1e-10 ? Outcome::solved : Outcome::not_solved;
  if (end->normal_impulse > 0.0) {
    answer.modes[0] = end->sticks || n == 1   ? ContactMode::stick
                      : end->tangential > 0.0 ? ContactMode::slip_positive
                                              : ContactMode::slip_negative;
  }
  return report.usable();
}

}  // namespace

void ImpactSolver::solve(ImpactLaw law, const ContactProblem& problem, std::span<const double> restitution,
                         SolverChain& chain, ContactSolution& answer) {
  const auto n = static_cast<std::size_t>(problem.rows());
  before_.resize(n);
  for (std::size_t i = 0; i < n; ++i) before_[i] = problem.vector()[i] / (1.0 + restitution[i]);
  answer.changed_modes = false;
  answer.response.clear();
  answer.impulse.assign(n, 0.0);
  if (law == ImpactLaw::energetic && is_one_contact(problem)) {
    static_cast<void>(follow(problem, before_, restitution[0], answer));
    return;
  }
  ContactReport& report = answer.report;
  report = {};
  answer.modes.assign(problem.groups().size(), ContactMode::open);
  const bool found = compress(problem, chain, report) &&
                     (law == ImpactLaw::energetic ? expand_energetically(problem, restitution, chain, report)
                                                  : expand(problem, restitution, 1.0, chain, report));
  if (!found) return;
  for (std::size_t i = 0; i < n; ++i) answer.impulse[i] = compression_[i] + expansion_[i];
  contact_modes(problem, answer.impulse, expanded_, answer.modes);
}

/// gamma + W P.
void ImpactSolver::find_velocities(const ContactProblem& problem, std::span<const double> impulse,
                                   std::span<const double> start, std::vector<double>& end) const {
  const auto n = static_cast<std::size_t>(problem.rows());
  end.resize(n);
  problem.velocities(impulse, end);
  for (std::size_t i = 0; i < n; ++i) end[i] += start[i] - problem.vector()[i];
}

bool ImpactSolver::compress(const ContactProblem& problem, SolverChain& chain, ContactReport& report) {
  phase_ = problem;
  std::copy(before_.begin(), before_.end(), phase_.vector().begin());
  compression_.assign(before_.size(), 0.0);
  expansion_.assign(before_.size(), 0.0);
  report = chain.solve(phase_, compression_);
  find_velocities(problem, compression_, before_, compressed_);
  // Velocities gamma that the compression stops are zero: where contacts jam, impulses without bound would
  // answer to their rounding.
  const double slow = rounding * largest(before_);
  for (double& velocity : compressed_) {
    if (std::abs(velocity) <= slow) velocity = 0.0;
  }
  expanded_ = compressed_;
  return report.usable();
}

/// Sets of the expansion: what is given back at least, and the friction that is left to joints.
void ImpactSolver::set_expansion(const ContactProblem& problem, std::span<const double> restitution,
                                 double scale) {
  std::copy(compressed_.begin(), compressed_.end(), phase_.vector().begin());
  for (std::size_t i = 0; i < before_.size(); ++i) {
    RowSet& set = phase_.sets()[i];
    set = problem.sets()[i];
    const double least = scale * restitution[i] * compression_[i];
    if (set.kind == SetKind::half_line && least > 0.0) {
      set.kind = SetKind::interval;
      set.lower = least;
      set.upper = unbounded;
    } else if (set.kind == SetKind::interval) {
      set.lower = std::min(set.lower - compression_[i], 0.0);
      set.upper = std::max(set.upper - compression_[i], 0.0);
    } else if (given_back_[i] != 0) {
      set.coefficient = 0.0;  // of what is beyond S
      for (std::size_t row = 0; row < before_.size(); ++row) {
        phase_.vector()[row] += phase_.w(static_cast<int>(row), static_cast<int>(i)) * stored_[i];
      }
    }
  }
  phase_.group();
}

bool ImpactSolver::expand(const ContactProblem& problem, std::span<const double> restitution, double scale,
                          SolverChain& chain, ContactReport& report) {
  const std::size_t n = before_.size();
  stored_.assign(n, 0.0);
  given_back_.assign(n, 0);
  const double negligible = rounding * largest(compression_);
  for (std::size_t i = 0; i < n; ++i) {
    const RowSet& set = problem.sets()[i];
    if (set.kind != SetKind::bounded_interval) continue;
    const auto normal = static_cast<std::size_t>(set.bound);
    const double stored = scale * restitution[normal] * restitution[i] * compression_[i];
    if (std::abs(stored) > negligible) stored_[i] = stored;
  }
  // Every row is taken in once and let go once at most.
  for (std::size_t round = 0; round <= 2 * n; ++round) {
    set_expansion(problem, restitution, scale);
    const double before = report.residual;
    report = chain.solve(phase_, expansion_);
    report.residual = std::max(report.residual, before);
    if (!report.usable()) return false;
    for (std::size_t i = 0; i < n; ++i) {
      if (given_back_[i] != 0) expansion_[i] = stored_[i];
    }
    find_velocities(problem, expansion_, compressed_, expanded_);
    if (!give_back(problem)) return true;
  }
  report.outcome = Outcome::not_solved;
  report.reason = "tangential impulses that are given back do not settle";
  return false;
}

/// Takes tangential rows that give back less than they stored, and lets go of those that would rather stick.
/// True if there were any.
bool ImpactSolver::give_back(const ContactProblem& problem) {
  bool changed = false;
  const double slow = rounding * largest(problem.vector());
  for (std::size_t i = 0; i < stored_.size(); ++i) {
    const double stored = stored_[i];
    if (stored == 0.0) continue;
    const double along = std::copysign(1.0, stored);
    if (given_back_[i] == 0) {
      if (!(along * expansion_[i] < std::abs(stored) * (1.0 - rounding))) continue;
      given_back_[i] = 1;
      changed = true;
    } else if (along * expanded_[i] < -slow) {
      given_back_[i] = 0;
      stored_[i] = 0.0;
      changed = true;
    }
  }
  return changed;
}

/// Work of the normal impulses of the expansion [J].
double ImpactSolver::work_of_expansion() const {
  double work = 0.0;
  for (const RowGroup& group : phase_.groups()) {
    const auto row = static_cast<std::size_t>(group.first);
    if (compression_[row] <= 0.0 && expansion_[row] <= 0.0) continue;
    if (phase_.sets()[row].kind == SetKind::interval && phase_.sets()[row].upper < unbounded) continue;
    work += 0.5 * expansion_[row] * (compressed_[row] + expanded_[row]);
  }
  return work;
}

bool ImpactSolver::expand_energetically(const ContactProblem& problem, std::span<const double> restitution,
                                        SolverChain& chain, ContactReport& report) {
  double taken = 0.0, magnitude = 0.0, weighted = 0.0;
  for (const RowGroup& group : problem.groups()) {
    const auto row = static_cast<std::size_t>(group.first);
    if (problem.sets()[row].kind != SetKind::half_line) continue;
    const double work = 0.5 * compression_[row] * (before_[row] + compressed_[row]);
    taken -= work;
    magnitude += std::abs(work);
    weighted += std::abs(work) * restitution[row] * restitution[row];
  }
  const double wanted = magnitude > 0.0 ? taken * (weighted / magnitude) : 0.0;
  const double size = std::max(std::abs(wanted), rounding * largest(compression_) * largest(before_));
  const auto excess = [&](double scale, double& value) {
    if (!expand(problem, restitution, scale, chain, report)) return false;
    value = work_of_expansion() - wanted;
    return true;
  };
  double low = 0.0, high = 1.0, at_low = 0.0, at_high = 0.0;
  if (!(wanted > 0.0)) return excess(0.0, at_low);
  if (!excess(high, at_high)) return false;
  if (std::abs(at_high) <= 4.0 * rounding * size) return true;
  at_low = -wanted;
  for (int i = 0; at_high < 0.0; ++i) {
    if (i == 60) {
      report.outcome = Outcome::no_solution;
      report.reason = "no expansion gives back the energy";
      return false;
    }
    low = high, at_low = at_high, high *= 2.0;
    if (!excess(high, at_high)) return false;
  }
  int side = 0;
  for (int i = 0; i < most_scalings; ++i) {
    const double middle = (low * at_high - high * at_low) / (at_high - at_low);
    if (!(middle > low && middle < high)) break;
    double value = 0.0;
    if (!excess(middle, value)) return false;
    if (std::abs(value) <= 0.01 * rounding * size) break;
    if (value < 0.0) {
      low = middle, at_low = value;
      if (side < 0) at_high *= 0.5;
      side = -1;
    } else {
      high = middle, at_high = value;
      if (side > 0) at_low *= 0.5;
      side = 1;
    }
  }
  return true;
}

}  // namespace carom
