#pragma once

/// \file
/// Contacts that jam, and what becomes of them. Contacts jam where impulses P in their cones cancel each
/// other, H^T P = 0. Then P.b = P.(E gamma^-), over ground at rest; an answer demands that it is not
/// negative, and where e differ it may be. Where they cancel but for a trifle (two corners that lie in each
/// other) there is an answer whose impulses are without measure, as any velocity that the law demands has to
/// come from the trifle: bodies are shot away. Without restitution P.b is 0, there is an answer (the matrix
/// of the complementarity problem is copositive: Cottle, Pang and Stone 1992, theorem 3.8.6), and it adds no
/// energy in an impact. Where the trifle is rounding, a solver may end without measure all the same: then
/// contacts are solved that give way a little.

#include <carom/contact/solvers/contact_problem.h>
#include <carom/contact/solvers/solver_chain.h>

#include <span>
#include <vector>

namespace carom {

/// A problem with its answer.
struct AnsweredProblem {
  ContactProblem& problem;
  std::span<const double> before;  ///< gamma^-, by row [m/s]
  std::span<double> restitution;   ///< e, by row
  std::span<double> given;  ///< part of b without velocities at the end, of a problem in factors; else empty
  ContactSolution& answer;
};

/// Looks at answers, and solves jams without restitution. Keeps memory.
class PlasticJam {
public:
  /// The next problem.
  void begin() { found_ = false; }
  /// True if restitution was taken from the problem.
  [[nodiscard]] bool found() const { return found_; }
  /// Solves a problem without an answer, and one of Newton's law whose answer adds energy by impulses without
  /// measure, without restitution, where all laws are one. An answer whose impulses are without measure even
  /// then is replaced by that of contacts that give way by a millionth, where it obeys the law nearly.
  /// \param by_newton the answer is that of Newton's law
  void resolve(const AnsweredProblem& at, bool by_newton, SolverChain& chain);

private:
  [[nodiscard]] bool adds_energy(const AnsweredProblem& at);
  void remove(const AnsweredProblem& at, SolverChain& chain);
  void give_way(const AnsweredProblem& at, SolverChain& chain);
  void keep(const AnsweredProblem& at);
  void restore(const AnsweredProblem& at) const;

  bool found_ = false;
  std::vector<double> b_, restitution_, given_, xi_;  // of the problem with restitution
  ContactSolution answer_;
  ContactProblem yielding_;
};

}  // namespace carom
