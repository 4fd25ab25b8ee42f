#pragma once

/// \file
/// One contact, solved exactly: all its modes in closed form. The hot path of impacts.

#include <carom/contact/solvers/contact_problem.h>
#include <carom/contact/solvers/contact_solver.h>
#include <carom/core/export.h>

#include <array>
#include <span>

namespace carom {

/// An answer whose mode stands by a relative margin below this at a boundary between modes is `degenerate`.
inline constexpr double degenerate_margin = 1e-10;

/// det W below this part of W_nn W_tt is taken for zero: what is left is the rounding of W's entries.
inline constexpr double singular_determinant = 1e-14;

/// For singular W, -b counts as lying in the range of W (so that sticking is possible) where it misses by
/// less than this part of its terms; b carries the rounding of the velocities it was made of.
inline constexpr double range_margin = 1e-12;

/// One planar contact: W [1/kg], b [m/s], coefficient of friction.
struct PlanarContact {
  double w_nn = 0.0;
  double w_nt = 0.0;
  double w_tt = 0.0;
  double b_n = 0.0;
  double b_t = 0.0;
  double friction = 0.0;
};

/// One solution of a planar contact: impulses [N s] and the mode they belong to.
struct PlanarImpulse {
  double normal = 0.0;
  double tangential = 0.0;
  ContactMode mode = ContactMode::open;
};

/// All solutions of a planar contact, the one with the smallest normal impulse first: no impulse arises
/// where none is needed.
struct PlanarSolutions {
  std::array<PlanarImpulse, 4> list{};
  int count = 0;
  Outcome outcome = Outcome::not_solved;
  bool degenerate = false;
};

/// Lists all solutions in (P, gamma^+) by trying the four modes; equal ones at a common boundary count once.
///
/// With p+- = W_nn -+ mu W_nt and
///     S+ = b_n (W_nt - mu W_tt) - b_t p+,     S- = b_t p- - b_n (W_nt + mu W_tt)
/// the modes are possible where (p- belongs to slip in the negative direction)
///     open     b_n >= 0
///     stick    S+ >= 0 and S- >= 0                            P = -W^-1 b
///     slip+    b_n <= 0, S+ <= 0 (p+ > 0);  b_n >= 0, S+ >= 0 (p+ < 0)     P_n = -b_n / p+, P_t = -mu P_n
///     slip-    b_n <= 0, S- <= 0 (p- > 0);  b_n >= 0, S- >= 0 (p- < 0)     P_n = -b_n / p-, P_t = +mu P_n
/// All modes are judged by the same four numbers, so rounding cannot open a gap between two of them: for
/// positive definite W a solution is always found. Stick is solved with twofold products where they
/// cancel (error of a few roundings whatever the condition of W).
///
/// Margins, all relative: b_n to max(|b_n|, |b_t|); p to W_nn + mu |W_nt|; S to |b_t| (W_nn + mu |W_nt|) +
/// |b_n| (|W_nt| + mu W_tt); det W to W_nn W_tt (stick only). `degenerate` where one of those that decide on
/// the answer, or on the presence of another one, is below degenerate_margin.
///
/// Singular W (by singular_determinant): the sticking impulse nearest to the origin is taken and reported as
/// forces_not_unique; without any solution (jammed: docs/method.md section 3) the outcome is no_solution.
[[nodiscard]] CAROM_API PlanarSolutions solve_planar_contact(const PlanarContact& contact);

/// A solution of a planar contact together with its certificate.
struct CertifiedImpulse {
  PlanarImpulse impulse{};                ///< the solution; its mode is the one that was solved for
  double xi_n = 0.0, xi_t = 0.0;          ///< xi = W P + b [m/s]
  double residual = 0.0;                  ///< planar_residual (planar_certificate.h)
  ContactMode mode = ContactMode::open;   ///< by the rule of contact_mode.h
  Outcome outcome = Outcome::not_solved;  ///< what is known of the solutions
  bool degenerate = false;
  bool usable = false;  ///< whether the impulse may be used; see the functions
};

/// One planar contact from its numbers alone, with no memory asked for and no problem laid out: the first of
/// its solutions, certified. `usable` if there is one; it is judged by its residual like any other answer.
/// Its `mode` is the one it was solved for.
[[nodiscard]] CAROM_API CertifiedImpulse solve_certified_contact(const PlanarContact& contact);

/// The hot path: the solution where it is unique and regular (mu |W_nt| < W_nn, det W > 0, b_n not zero),
/// which is nearly every impact, with its certificate; not `usable` otherwise (solve_planar_contact()). The
/// problem has one group, of a normal and a friction row.
[[nodiscard]] CAROM_API CertifiedImpulse solve_regular_contact(const ContactProblem& problem);
/// The solution of one planar contact, given by its numbers, where it is unique and regular
/// (mu |W_nt| < W_nn, det W > 0, b_n not zero), with its certificate; not `usable` otherwise.
[[nodiscard]] CAROM_API CertifiedImpulse solve_regular_contact(const PlanarContact& contact);

/// Exact solver of problems with one contact: one lone row; one normal row with one friction row, of known
/// direction (sliding_contact.h) or not; a normal row with a disc where the normal does not couple with an
/// isotropic tangential block (particle, sphere). Everything else is not_solved ("not applicable"). Allocates
/// nothing.
class CAROM_API SingleContactSolver final : public ContactSolver {
public:
  [[nodiscard]] std::string_view name() const override { return "single contact"; }
  [[nodiscard]] SolverAnswer solve(const ContactProblem& problem, std::span<double> impulse) override;
};

}  // namespace carom
