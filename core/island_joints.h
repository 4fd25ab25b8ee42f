#pragma once

/// \file
/// The joints of one island as constraints on all its bodies at once (docs/method.md, section 8). With the
/// rows G of its joints and the masses M, numbers x of the bodies (accelerations, velocities, displacements)
/// are made to obey  G x + c = 0  by the smallest change in the sense of the masses,
///
///     x' = x + M^-1 G^T l,   (G M^-1 G^T) l = -(G x + c).
///
/// The matrix is sparse; its pattern is analysed once.

#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/core/joint_kind.h>
#include <carom/core/sparse_factors.h>

#include <span>
#include <vector>

namespace carom {

/// What numbers of the bodies are, and with that the constant c that goes with them.
enum class JointLevel : std::uint8_t {
  displacement,  ///< c the gaps
  velocity,      ///< c the rates of rows that depend on time
  acceleration,  ///< c the drifts
  change         ///< c zero: changes of velocities or accelerations
};

/// Constraints of one island. Owns workspaces and multipliers.
class CAROM_API IslandJoints {
public:
  /// Of no island: empty.
  IslandJoints() = default;
  /// Analyses the pattern.
  IslandJoints(const Assembly& assembly, Index island);

  [[nodiscard]] bool empty() const { return rows_.empty(); }  ///< true if there are no joints
  /// Number of rows.
  [[nodiscard]] std::size_t size() const { return rows_.size(); }
  /// True if a row depends on time.
  [[nodiscard]] bool depends_on_time() const { return depends_on_time_; }

  /// Writes the rows at a configuration. Sized as rows().
  void evaluate(const JointView& at, std::vector<JointRow>& out) const;
  /// Takes the body with these velocities as too heavy to move.
  void hold_still(Range velocities);
  /// Brings rows() to a configuration and factorises.
  void locate(const JointView& at);
  /// Rows at the configuration last located.
  [[nodiscard]] const std::vector<JointRow>& rows() const { return rows_; }

  /// Makes x obey the constraints. \param x an array over all velocities \param multipliers out: l, sized as
  /// rows(); may be null
  void hold(JointLevel level, double* x, double* multipliers = nullptr);
  /// r becomes -(G M^-1 G^T)^-1 r, zero in rows that follow from others.
  void solve(double* r);
  /// x += M^-1 G^T l.
  void add_response(const double* multipliers, double* x) const;
  /// x becomes M^-1 x over the island.
  void apply_inverse_mass(double* x) const;
  /// Impulses or forces x of the bodies become what they do, with the joints' answer: M^-1 x, held.
  void respond(double* x);
  /// Velocities of the island.
  [[nodiscard]] Range velocities() const { return v_; }

  /// G x + c of a row.
  [[nodiscard]] static double residual(JointLevel level, const JointRow& row, const double* x) {
    const double sum = row.times(x);
    switch (level) {
      case JointLevel::displacement:
        return sum + row.gap;
      case JointLevel::velocity:
        return sum + row.rate;
      case JointLevel::acceleration:
        return sum + row.drift;
      case JointLevel::change:
        break;
    }
    return sum;
  }

  /// The joint of a row.
  [[nodiscard]] JointId joint(std::size_t row) const { return joints_[row]; }
  /// First of the rows of each joint, in order; behind the last the number of rows.
  [[nodiscard]] std::span<const Index> first_rows() const { return first_row_; }
  /// The factors of G M^-1 G^T.
  [[nodiscard]] const SparseFactors& factors() const { return factors_; }
  [[nodiscard]] SparseFactors& factors() { return factors_; }

private:
  // A product of two blocks that belongs to an entry of the matrix.
  struct Product {
    Index row, other;             // rows
    std::uint8_t block, against;  // blocks in them
    Index entry;                  // place in the matrix's numbers
  };

  const Assembly* assembly_ = nullptr;
  Index island_ = 0;
  Range v_;
  bool depends_on_time_ = false;
  std::vector<JointRow> rows_;
  std::vector<JointId> joints_;  // by row
  std::vector<Index> first_row_;
  std::vector<double> inverse_mass_;  // over v_: masses are diagonal
  std::vector<Product> products_;
  SparseFactors factors_;
  std::vector<double> right_;
};

}  // namespace carom
