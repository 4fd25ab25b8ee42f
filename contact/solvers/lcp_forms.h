#pragma once

/// \file
/// Two ways to read a contact problem as a linear complementarity problem, and the way back.
///
/// Both work on the problem scaled group by group, P = s P', xi = xi' / s with s a power of two near
/// 1 / sqrt(trace W_ii): all entries of W' are then of order one whatever the masses, and nothing is rounded.
/// A proportional row has no variable and no condition: what it does goes into the column of the row that it
/// follows, W_.n + coefficient * W_.t, and the matrices are then neither symmetric nor copositive.
/// Restitution is in b, and xi = (1 + e) (mean velocity): the matrices do not depend on e.

#include <carom/contact/solvers/contact_problem.h>
#include <carom/core/export.h>
#include <carom/core/numerics/lcp.h>
#include <carom/core/numerics/rank_revealing_qr.h>

#include <cstddef>
#include <span>
#include <vector>

namespace carom {

/// A tangential block whose reciprocal condition is below this is not eliminated (PaperForm): each digit of
/// condition costs a digit of the result, and the other form has no such loss.
inline constexpr double elimination_threshold = 1e-8;

/// The paper's form (Johansson 1999, equations 12 and 13) for any number of contacts:
///
///     z = (P_n, chi1, chi2),  w = (xi_n, psi1, psi2),   psi1 = mu P_n - P_t,  psi2 = mu P_n + P_t,
///     xi_t = chi2 - chi1,     P_T = W_TT^-1 (xi_T - W_TN P_N - b_T)
///
/// with the tangential impulses of all contacts eliminated together. A two-sided interval [lo, hi] is
/// eliminated like friction, psi1 = hi - P, psi2 = P - lo (a side at infinity has no variable); a one-sided
/// one is treated like a normal row. Not applicable for discs and for singular W_TT.
class CAROM_API PaperForm {
public:
  /// Fills `lcp`; false where the form does not exist.
  [[nodiscard]] bool build(const ContactProblem& problem, Lcp& lcp);

  /// Impulses [N s] of a solution z of the LCP built last.
  void impulses(const ContactProblem& problem, std::span<const double> z, std::span<double> impulse);

private:
  struct Row {
    bool eliminated = false;
    double sign = 1.0;  // P' = offset + sign z of a normal row
    double offset = 0.0;
    int normal = -1;        // variable of a normal row
    int upper = -1;         // chi1, complement of  hi - P
    int lower = -1;         // chi2, complement of  P - lo
    std::size_t place = 0;  // among the normal or among the eliminated rows
  };
  bool classify(const ContactProblem& problem);
  bool eliminate(const ContactProblem& problem);
  void fill_normal_rows(const ContactProblem& problem, Lcp& lcp);
  void fill_friction_rows(const ContactProblem& problem, Lcp& lcp);

  [[nodiscard]] double w(std::size_t row, std::size_t column) const {
    return coupled_[row * scale_.size() + column];
  }

  std::vector<double> scale_;
  std::vector<double> coupled_;
  std::vector<Row> rows_;
  std::vector<std::size_t> normal_, eliminated_;  // rows of the problem
  std::vector<double> block_, rhs_;
  std::vector<double> inverse_;   // W_TT^-1
  std::vector<double> transfer_;  // W_TT^-1 W_TN, eliminated x normal
  std::vector<double> shift_;     // W_TT^-1 (b_T + W_TN offset_N)
  RankRevealingQr qr_;
  int variables_ = 0;
};

/// The form without an inverse (docs/method.md section 3): z = (P_n, beta+, beta-, sigma) with P_t = beta+ -
/// beta-,
///
///     xi_n >= 0  _|_  P_n,    +-xi_t + sigma >= 0  _|_  beta+-,    mu P_n - beta+ - beta- >= 0  _|_  sigma.
///
/// Copositive for W >= 0 without proportional rows. A two-sided interval has P = lo + u with xi + s >= 0 _|_
/// u and hi - lo - u >= 0 _|_ s, a one-sided one a single variable, a free row P = u+ - u-. Exists for every
/// problem without discs.
class CAROM_API CopositiveForm {
public:
  /// Fills `lcp`; false where the problem has a disc.
  [[nodiscard]] bool build(const ContactProblem& problem, Lcp& lcp);

  /// Impulses [N s] of a solution z of the LCP built last.
  void impulses(const ContactProblem& problem, std::span<const double> z, std::span<double> impulse) const;

private:
  struct Row {
    double offset = 0.0;  // P' = offset + z[plus] - z[minus]
    int plus = -1;
    int minus = -1;
    int slack = -1;  // sigma, or the multiplier of the upper bound
  };
  bool classify(const ContactProblem& problem);

  std::vector<double> scale_;
  std::vector<double> coupled_;
  std::vector<Row> rows_;
  int variables_ = 0;
};

/// Scale s of each row (see the top of the file): a power of two near 1 / sqrt(trace W_ii) of its group, 1
/// for a group without mobility. `scale` is resized to rows().
CAROM_API void group_scales(const ContactProblem& problem, std::vector<double>& scale);

/// W' of the scaled problem, row-major, with `coefficient` times the column of every proportional row added
/// to the column of the row that it follows. `coupled` is resized to rows() x rows().
CAROM_API void couple_columns(const ContactProblem& problem, std::span<const double> scale,
                              std::vector<double>& coupled);

}  // namespace carom
