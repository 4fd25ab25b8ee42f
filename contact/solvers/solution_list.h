#pragma once

/// \file
/// All solutions of a small planar problem: how many are there, and which? Too slow for a step (4^n and more
/// linear systems), made for proofs, reports and tests.

#include <carom/contact/solvers/contact_problem.h>
#include <carom/contact/solvers/contact_solver.h>
#include <carom/core/export.h>
#include <carom/core/owner.h>

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace carom {

/// Most groups (contacts, stops, limits) that are enumerated.
inline constexpr int enumeration_groups = 3;

/// A candidate whose residual (residual.h) is up to this is a solution. Candidates come from direct solves.
inline constexpr double listed_residual = 1e-11;

/// Solutions nearer than this part of P* (impulses, and velocities times rho) are one.
inline constexpr double listed_distance = 1e-9;

/// Without any candidate of a residual up to this, "no solution" is taken as proved.
inline constexpr double refuted_residual = 1e-7;

/// Lists the solutions of a problem with up to three groups of at most two friction rows each, none a disc:
/// contacts that may stick or slip, with rolling resistance or without, contacts that slip or roll in a known
/// direction (proportional rows), lone rows, in any mixture.
///
/// Every combination of modes (open, stick, slip+, slip- for a contact; open or sliding for one that slips in
/// a known direction; at a bound or moving for a lone row) is one linear system; where it is regular it gives
/// a candidate, and the shared residual decides. Where a system is singular but consistent, its solutions
/// form a polyhedron in the cone of impulses; its extreme points are the solutions of the same systems with
/// equations of the mode's boundary added (touching: P = 0 and xi_n = 0; friction exhausted: |P_t| = mu P_n
/// and xi_t = 0), and its unbounded directions are null vectors of these. Solutions are counted in (P,
/// gamma^+).
///
/// Limits: solutions nearer than listed_distance are one; a system whose pivots differ by more than 1e11
/// counts as singular, so that a solution with impulses that large against the others (W_nn - s mu W_nt
/// almost zero) can be missed in a problem of several contacts; sets of solutions are told by extreme points
/// and unbounded(), and rays that are solutions are not listed.
class CAROM_API SolutionList {
public:
  SolutionList();
  ~SolutionList();
  SolutionList(SolutionList&&) noexcept;
  SolutionList& operator=(SolutionList&&) noexcept;

  /// Enumerates. Outcomes: solved (one), several_solutions (several end velocities), forces_not_unique
  /// (several impulses or an unbounded set of them, one end velocity), no_solution, not_solved (not
  /// applicable, or a near miss that is neither a solution nor a refutation).
  Outcome enumerate(const ContactProblem& problem);

  /// Whether the last problem was of the sort that can be enumerated.
  [[nodiscard]] bool applicable() const { return applicable_; }

  /// Number of solutions found: isolated ones and extreme points of sets of solutions.
  [[nodiscard]] std::size_t size() const { return count_; }

  /// Number of different end velocities among the solutions.
  [[nodiscard]] std::size_t end_velocities() const { return end_velocities_; }

  /// Whether impulses of a solution can be increased without bound (jammed contacts).
  [[nodiscard]] bool unbounded() const { return unbounded_; }

  /// Impulses [N s] of solution `index`, in the order of increasing sum of normal impulses.
  [[nodiscard]] std::span<const double> impulse(std::size_t index) const;

  /// Scaled mean velocities xi [m/s] of solution `index`.
  [[nodiscard]] std::span<const double> velocity(std::size_t index) const;

private:
  struct Workspace;
  void visit(const ContactProblem& problem, std::span<const std::size_t> choice, bool rays);
  void visit_all(const ContactProblem& problem, bool pure_only, bool rays);
  void consider(const ContactProblem& problem);
  void follow(const ContactProblem& problem);
  [[nodiscard]] bool same(std::span<const double> impulse, std::span<const double> xi, std::size_t index,
                          bool velocities_only) const;
  void set_scales(const ContactProblem& problem);
  Outcome conclude();

  Owner<Workspace> work_;
  std::vector<double> impulses_, velocities_, rho_;
  std::vector<std::size_t> order_;
  std::size_t rows_ = 0, count_ = 0, end_velocities_ = 0;
  double scale_ = 0.0, least_residual_ = std::numeric_limits<double>::infinity();
  bool applicable_ = false, singular_ = false, unbounded_ = false, velocity_varies_ = false;
};

}  // namespace carom
