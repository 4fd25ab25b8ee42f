#pragma once

/// \file
/// Impacts by Poisson's and by the energetic law (docs/contact_law.md), from the matrix W, the row sets and
/// the velocities gamma^- alone.
///
/// Two phases (Glocker and Pfeiffer 1995). Compression: P_C from the contact problem with e = 0,
/// gamma_C = gamma^- + W P_C. Expansion: gamma_E = gamma_C + W P_E with
///
///     0 <= P_nE - e_n P_nC  ⊥  gamma_nE >= 0,   |P_tE| <= mu P_nE,   -gamma_tE in the normal cone there,
///
/// where for S = e_n e_t P_tC != 0 the tangential impulse is at least S along S (it is given back).
///
/// Energetic (Stronge 1990), one planar contact: the path over the normal impulse p (Routh),
/// dgamma_n/dp = W_nn + W_nt k, dgamma_t/dp = W_tn + W_tt k, with k = -mu sign(gamma_t) in slip, and the k
/// that keeps gamma_t = 0, if |k| <= mu, in stick; compression ends at gamma_n = 0, the impact where the work
/// of expansion, the integral of gamma_n over p, is -e_n^2 times that of compression. Several contacts: two
/// phases with P_nE - s e_n P_nC in place of P_nE - e_n P_nC, the number s such that the normal works of all
/// contacts are, in sum, -e^2 times those of the compression, e^2 the mean of e_n^2 weighted by the
/// magnitudes of these.

#include <carom/contact/solvers/contact_problem.h>
#include <carom/contact/solvers/solver_chain.h>
#include <carom/core/export.h>
#include <carom/core/surface.h>

#include <span>
#include <vector>

namespace carom {

/// Solves impacts by one law other than Newton's. Keeps memory only.
class CAROM_API ImpactSolver {
public:
  /// Writes the impulses of an impact, its modes and its report. \param law poisson or energetic
  /// \param problem with b = (1 + e) gamma^-; joint friction as intervals, of which both phases together have
  /// one width \param restitution e by row
  void solve(ImpactLaw law, const ContactProblem& problem, std::span<const double> restitution,
             SolverChain& chain, ContactSolution& answer);

private:
  bool compress(const ContactProblem& problem, SolverChain& chain, ContactReport& report);
  bool expand(const ContactProblem& problem, std::span<const double> restitution, double scale,
              SolverChain& chain, ContactReport& report);
  bool expand_energetically(const ContactProblem& problem, std::span<const double> restitution,
                            SolverChain& chain, ContactReport& report);
  void set_expansion(const ContactProblem& problem, std::span<const double> restitution, double scale);
  bool give_back(const ContactProblem& problem);
  [[nodiscard]] double work_of_expansion() const;
  void find_velocities(const ContactProblem& problem, std::span<const double> impulse,
                       std::span<const double> start, std::vector<double>& end) const;

  ContactProblem phase_;
  std::vector<double> before_, compressed_, expanded_;  // gamma^-, gamma_C, gamma_E
  std::vector<double> compression_, expansion_;         // P_C, P_E
  std::vector<double> stored_;                          // S, by row
  std::vector<char> given_back_;                        // rows of which P_tE = S
};

}  // namespace carom
