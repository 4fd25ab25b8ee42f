#pragma once

/// \file
/// From a nearly right answer to one right to rounding: the equations of the modes it stands in, solved.

#include <carom/contact/solvers/contact_problem.h>
#include <carom/contact/solvers/residual.h>
#include <carom/core/export.h>
#include <carom/core/numerics/rank_revealing_qr.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace carom {

/// The equations of the modes of an answer, factored: of rows whose velocity is zero, and of discs. The other
/// rows stand at bounds, and follow.
struct ModeEquations {
  /// Linear pieces of the natural map of a row.
  enum class Piece : std::uint8_t {
    given,  ///< a share of another row's impulse
    free,   ///< inside its set: its velocity is zero
    lower,  ///< at the lower bound
    upper,  ///< at the upper bound
    disc    ///< of a disc: no piece
  };
  std::vector<Piece> pieces;      ///< by row; empty: no equations
  std::vector<std::size_t> rows;  ///< of the equations, and of their unknowns
  RankRevealingQr factors;        ///< of their matrix

  /// True of the equations of a problem of as many rows.
  [[nodiscard]] bool are_of(const ContactProblem& problem) const {
    return !pieces.empty() && pieces.size() == static_cast<std::size_t>(problem.rows());
  }
};

/// Newton's method on the natural map F(P) = P - proj_C(P - rho xi) of the certificate (residual.h). Each
/// row's linear piece is its present mode (zero, at a bound, free; a sliding disc has a curved one), so that
/// one step solves the system of the modes and further steps change modes. Rows at bounds are eliminated.
/// Singular systems (forces not unique) get a basic correction, which keeps the answer near the given one.
class CAROM_API NewtonPolish {
public:
  /// A residual at rounding: further steps only move noise.
  static constexpr double round_off = 1e-16;

  /// Improves `impulse` [N s] by at most `most_steps` steps, fewer where several in a row do not halve the
  /// residual; keeps the best point met, never a worse one.
  /// Returns its residual. `problem` is grouped, `impulse` has size rows().
  Residual improve(const ContactProblem& problem, std::span<double> impulse, int most_steps);
  /// Swaps the equations of the last step of the last improve(), none if it made no step, for others.
  void swap_equations(ModeEquations& other) { std::swap(equations_, other); }
  /// Improves an answer by steps with the equations of a problem of the same rows, whose W and b were a
  /// little different: a step costs no more than a product with W. Ends where the residual is that of
  /// rounding; false, with the impulses as they were, where a step does not halve it, or a row comes to
  /// another mode. `problem` is grouped, and may be in factors. \param equations of as many rows \param found
  /// out: residual of the answer
  [[nodiscard]] bool refine(const ContactProblem& problem, ModeEquations& equations,
                            std::span<double> impulse, Residual& found);

private:
  using Piece = ModeEquations::Piece;
  struct RowMap {
    Piece piece;
    double value;  // of the map [N s]
    double slope;  // of the bound by another row's impulse; 0: none
  };
  [[nodiscard]] RowMap map_of(const ContactProblem& problem, std::size_t row, double rho) const;
  [[nodiscard]] bool keeps_pieces(const ContactProblem& problem, std::span<const Piece> pieces);
  void find_pieces(const ContactProblem& problem);
  void linearise(const ContactProblem& problem);
  void linearise_disc(const ContactProblem& problem, std::size_t row, std::size_t tangent, double rho);
  void add_row(const ContactProblem& problem);
  void step_by(const ContactProblem& problem, ModeEquations& equations, bool by_factors);
  void restore_sets(const ContactProblem& problem, std::span<const Piece> pieces);
  Residual judge(const ContactProblem& problem, std::span<const double> impulse);

  std::vector<double> trial_, best_, xi_, map_, slot_velocity_;
  std::vector<double> row_, slopes_;               // of one row, of all rows that follow a bound
  std::vector<double> jacobian_, of_rows_, step_;  // of the equations
  ModeEquations equations_;
};

}  // namespace carom
