#pragma once

/// \file
/// The contact problem: matrix, vector and one set per row, nothing else (docs/method.md,
/// section 3; Johansson 1999, equations 4 to 13).
///
/// Find impulses P with scaled mean velocities  xi = W P + b  such that for every row set C
///     P in C(P),   -xi in the normal cone of C(P) at P.
/// Restitution is in b:  b = gamma_f + E gamma^-,  gamma_f the velocity without contact impulses,
/// E = diag(e). The end velocities are  gamma^+ = gamma_f + W P = xi - E gamma^-.

#include <carom/contact/solvers/response_factors.h>
#include <carom/core/export.h>
#include <carom/core/row_set.h>

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace carom {

/// Consecutive rows that are judged together: a normal row with its friction rows, or one lone row.
struct RowGroup {
  int first = 0;  ///< first row (the normal row of a contact)
  int size = 1;   ///< number of rows
};

/// Place of an entry of a matrix that is stored row by row.
[[nodiscard]] inline std::size_t entry_place(int row, int column, int columns) {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
}

/// Symmetric positive semidefinite matrix W, vector b and row sets. W is dense (row-major), or left as its
/// factors H M^-1 H^T where it would be too large (response_factors.h): is_factored(). The sets, the law and
/// the residual that judges answers are the same.
///
/// Rows of one contact are consecutive: the normal row (half_line) first, then its friction rows, whose
/// `bound` is the normal row. A contact that slips in a known direction keeps both rows, the second one
/// proportional: W stays symmetric, and no condition on xi_t is left. Reset and refill to reuse the memory.
class CAROM_API ContactProblem {
public:
  /// Empties the problem and sizes it for `rows` rows, all entries zero, all sets P >= 0.
  void reset(int rows);

  /// Empties the problem and sizes it for `rows` rows with W in factors of `slots` slots: all numbers zero,
  /// all sets P >= 0. No disc may be among its sets.
  void reset_factors(int rows, int slots);

  /// Sizes the problem for `rows` rows with W in factors, without slots. Vector, sets and rows of the factors
  /// keep what was there, and are to be written.
  void resize_factors(int rows);

  /// Whether W is given by factors().
  [[nodiscard]] bool is_factored() const { return factored_; }

  /// Factors of W; empty of a dense problem. Call group() after they are filled.
  [[nodiscard]] const ResponseFactors& factors() const { return factors_; }
  [[nodiscard]] ResponseFactors& factors() { return factors_; }

  /// A copy of this problem with W as a dense matrix.
  [[nodiscard]] ContactProblem dense() const;

  /// Number of rows.
  [[nodiscard]] int rows() const { return rows_; }

  /// Entry of W on its diagonal.
  [[nodiscard]] double diagonal(int row) const {
    return factored_ ? diagonal_[static_cast<std::size_t>(row)] : w(row, row);
  }

  /// Entry of W [1/kg, 1/(kg m), ...: velocity per impulse]. Of a dense problem only.
  [[nodiscard]] double w(int row, int column) const { return w_[entry_place(row, column, rows_)]; }
  [[nodiscard]] double& w(int row, int column) { return w_[entry_place(row, column, rows_)]; }

  /// W, row-major, rows() x rows(); empty of a problem in factors.
  [[nodiscard]] std::span<const double> matrix() const;
  [[nodiscard]] std::span<double> matrix();

  /// b = gamma_f + E gamma^- [m/s].
  [[nodiscard]] std::span<const double> vector() const;
  [[nodiscard]] std::span<double> vector();

  /// Set of each row.
  [[nodiscard]] std::span<const RowSet> sets() const;
  [[nodiscard]] std::span<RowSet> sets();

  /// Groups of rows judged together, derived from the sets; call after the sets are filled.
  /// Throws std::invalid_argument when friction rows do not follow their normal row, or when the factors of
  /// rows of one group are not those of the same slots.
  void group();

  /// Groups found by group().
  [[nodiscard]] std::span<const RowGroup> groups() const;
  /// True if group() found one contact in the plane, with friction, and W is dense: nearly all problems.
  [[nodiscard]] bool is_one_planar_contact() const { return one_planar_contact_; }

  /// xi = W P + b, each entry summed in twice the precision and rounded once: large impulses of contacts that
  /// share a body cancel in it. With factors plainly, by way of the velocities M^-1 H^T P.
  void velocities(std::span<const double> impulse, std::span<double> xi) const;

  /// xi = W P + b, by way of the velocities M^-1 H^T P where the problem is in factors, with memory to reuse.
  /// \param velocity out: M^-1 H^T P, three a slot; left alone by a dense problem
  void velocities(std::span<const double> impulse, std::span<double> xi, std::vector<double>& velocity) const;

  /// Writes the problem to a file in JSON (docs/contact_problems.md), every number exactly; what is said
  /// beside it is in problem_file.h. Throws FileError, also where the library was built without JSON.
  void save(const std::string& path) const;

  /// Reads what save() wrote, or what somebody wrote by hand, and groups it. Throws FileError naming the
  /// file, the field, its value and what is allowed.
  [[nodiscard]] static ContactProblem load(const std::string& path);

private:
  void group_factors();

  int rows_ = 0;
  bool factored_ = false;
  bool one_planar_contact_ = false;  // since group()
  std::vector<double> w_, b_;
  ResponseFactors factors_;
  std::vector<double> diagonal_;  // of W, by row, of a problem in factors
  std::vector<RowSet> sets_;
  std::vector<RowGroup> groups_;
};

/// True of a problem in which friction of some contact lies in a disc.
[[nodiscard]] CAROM_API bool has_discs(const ContactProblem& problem);

}  // namespace carom
