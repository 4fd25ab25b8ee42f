// Problem: tell impulses that bodies give each other from those that a law demands of a trifle.

#include <carom/contact/plastic_jams.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace carom {

namespace {

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
  const bool had_answer = at.answer.report.usable();
  if (had_answer && !(by_newton && at.problem.groups().size() > 1 && adds_energy(at))) return;
  if (had_answer) keep(at);
  if (!remove_restitution(at)) return;
  // Those of a jam have grown without bound.
  std::fill(at.answer.impulse.begin(), at.answer.impulse.end(), 0.0);
  at.answer.known = false;
  chain.solve(at.problem, at.answer);
  found_ = !had_answer || (at.answer.report.usable() && were_without_measure(at));
  if (!found_) restore(at);
}

// With xi = W P + b the energy is P.(b + xi)/2 - P.E gamma^-. Of an answer P.xi <= 0, and W is not negative:
// without the last part there is no gain.
bool PlasticJam::adds_energy(const AnsweredProblem& at) {
  constexpr double rounding = 1e-9;  // of the works: an answer has some
  const std::vector<double>& impulse = at.answer.impulse;
  double given_back = 0.0;
  for (std::size_t row = 0; row < impulse.size(); ++row)
    given_back -= at.restitution[row] * at.before[row] * impulse[row];
  if (!(given_back > 0.0)) return false;
  xi_.resize(impulse.size());
  at.problem.velocities(impulse, xi_);
  double gain = given_back, works = given_back;
  for (std::size_t row = 0; row < impulse.size(); ++row) {
    const double work = 0.5 * impulse[row] * (at.problem.vector()[row] + xi_[row]);
    gain += work;
    works += std::abs(work);
  }
  return gain > rounding * works;
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

// Against those of the answer without restitution, and those that change free velocities where no other
// contact acts. Newton's law gains up to some hundred times the energy with impulses of a few hundred times
// those.
bool PlasticJam::were_without_measure(const AnsweredProblem& at) const {
  constexpr double without_measure = 1e4;
  double usual = 0.0, kept = 0.0;
  for (const RowGroup& group : at.problem.groups()) {
    const double trace = group_trace(at.problem, group);
    const auto first = static_cast<std::size_t>(group.first);
    for (std::size_t row = first; row < first + static_cast<std::size_t>(group.size); ++row) {
      kept = std::max(kept, std::abs(answer_.impulse[row]));
      usual = std::max(usual, std::abs(at.answer.impulse[row]));
      if (!(trace > 0.0)) continue;
      usual = std::max({usual, std::abs(b_[row]) / trace, std::abs(at.problem.vector()[row]) / trace});
    }
  }
  return kept > without_measure * usual;
}

}  // namespace carom
