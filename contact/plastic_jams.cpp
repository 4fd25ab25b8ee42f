// Problem: tell impulses that bodies give each other from those that a law demands of a trifle.

#include <carom/contact/plastic_jams.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace carom {

namespace {

/// Against impulses that change free velocities where no other contact acts. Newton's law gains up to some
/// hundred times the energy with impulses of a few hundred times those.
constexpr double without_measure = 1e4;

/// Whether impulses are far larger than those that change velocities where no other contact acts, and than
/// those of another answer, if there is one.
bool is_without_measure(const ContactProblem& problem, std::span<const double> impulse,
                        std::span<const double> other = {}) {
  if (problem.groups().size() < 2) return false;
  double usual = 0.0, largest = 0.0;
  for (const double value : impulse) largest = std::max(largest, std::abs(value));
  for (const double value : other) usual = std::max(usual, std::abs(value));
  for (const RowGroup& group : problem.groups()) {
    const double trace = group_trace(problem, group);
    if (!(trace > 0.0)) continue;
    const auto first = static_cast<std::size_t>(group.first);
    for (std::size_t row = first; row < first + static_cast<std::size_t>(group.size); ++row) {
      usual = std::max(usual, std::abs(problem.vector()[row]) / trace);
    }
    if (!(largest > without_measure * usual)) return false;  // it only grows
  }
  return largest > without_measure * usual;
}

/// Takes the restitution from a problem. False if it had none.
bool remove_restitution(const AnsweredProblem& at) {
  bool any = false;
  for (std::size_t row = 0; row < at.before.size(); ++row) {
    const double part = std::exchange(at.restitution[row], 0.0) * at.before[row];
    any = any || part != 0.0;
    const bool held = at.problem.diagonal(static_cast<int>(row)) == 0.0;
    if (!held || at.problem.vector()[row] != 0.0) at.problem.vector()[row] -= part;
    if (!at.given.empty()) at.given[row] -= part;
  }
  return any;
}

}  // namespace

void PlasticJam::resolve(const AnsweredProblem& at, bool by_newton, SolverChain& chain) {
  const auto unmeasured = [&] {
    return by_newton && at.answer.report.usable() && is_without_measure(at.problem, at.answer.impulse);
  };
  if (at.answer.report.usable() && !unmeasured()) return;
  if (!at.answer.report.usable() || adds_energy(at)) remove(at, chain);
  if (unmeasured()) give_way(at, chain);
}

// Solves the problem without restitution.
void PlasticJam::remove(const AnsweredProblem& at, SolverChain& chain) {
  const bool had_answer = at.answer.report.usable();
  if (had_answer) keep(at);
  if (!remove_restitution(at)) return;
  // Those of a jam have grown without bound.
  std::fill(at.answer.impulse.begin(), at.answer.impulse.end(), 0.0);
  at.answer.known = false;
  chain.solve(at.problem, at.answer);
  found_ = !had_answer ||
           (at.answer.report.usable() && is_without_measure(at.problem, answer_.impulse, at.answer.impulse));
  if (!found_) restore(at);
}

// With xi = W P + b the energy is P.(b + xi)/2 - P.E gamma^-. Of an answer P.xi <= 0 but for its rounding,
// and W is not negative: what restitution gives back, and what rounding does to impulses without measure,
// adds.
bool PlasticJam::adds_energy(const AnsweredProblem& at) {
  constexpr double rounding = 1e-9;  // of the works: an answer has some
  const std::vector<double>& impulse = at.answer.impulse;
  xi_.resize(impulse.size());
  at.problem.velocities(impulse, xi_);
  double gain = 0.0, works = 0.0;
  for (std::size_t row = 0; row < impulse.size(); ++row) {
    const double given_back = -at.restitution[row] * at.before[row] * impulse[row];
    const double work = 0.5 * impulse[row] * (at.problem.vector()[row] + xi_[row]);
    gain += work + given_back;
    works += std::abs(work) + std::abs(given_back);
  }
  return gain > rounding * works;
}

// The answer of W + s D and b, with D the traces of the groups: its impulses are bounded by b/(s D), and over
// ground at rest it adds no energy, since P.xi is negative by P.s D P at least.
void PlasticJam::give_way(const AnsweredProblem& at, SolverChain& chain) {
  constexpr double softness = 1e-6, nearly = 1e-4;  // of W, of the velocities
  if (at.problem.is_factored()) return;
  yielding_ = at.problem;
  for (const RowGroup& group : yielding_.groups()) {
    const double added = softness * group_trace(at.problem, group);
    for (int i = group.first; i < group.first + group.size; ++i) yielding_.w(i, i) += added;
  }
  answer_ = at.answer;
  std::fill(answer_.impulse.begin(), answer_.impulse.end(), 0.0);
  answer_.known = false;
  chain.solve(yielding_, answer_);
  if (!answer_.report.usable()) return;
  xi_.resize(answer_.impulse.size());
  at.problem.velocities(answer_.impulse, xi_);
  if (!(residual_of_velocities(at.problem, answer_.impulse, xi_) <= nearly)) return;
  const Residual found = residual(at.problem, answer_.impulse, xi_);
  answer_.report.residual = found.value;
  answer_.report.worst_group = found.group;
  answer_.report.outcome = Outcome::accepted_at_cap;
  std::swap(at.answer, answer_);
}

void PlasticJam::keep(const AnsweredProblem& at) {
  b_.assign(at.problem.vector().begin(), at.problem.vector().end());
  restitution_.assign(at.restitution.begin(), at.restitution.end());
  given_.assign(at.given.begin(), at.given.end());
  answer_ = at.answer;
}

void PlasticJam::restore(const AnsweredProblem& at) const {
  std::copy(b_.begin(), b_.end(), at.problem.vector().begin());
  std::copy(restitution_.begin(), restitution_.end(), at.restitution.begin());
  std::copy(given_.begin(), given_.end(), at.given.begin());
  at.answer = answer_;
}

}  // namespace carom
