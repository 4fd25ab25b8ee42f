#pragma once

/// \file
/// The joints of one component as constraints on all its bodies at once (docs/method.md, section 8). With the
/// rows G of its joints and the masses M, numbers x of the bodies (accelerations, velocities, displacements)
/// are made to obey  G x + c = 0  by the smallest change in the sense of the masses,
///
///     x' = x + M^-1 G^T l,   (G M^-1 G^T) l = -(G x + c).
///
/// The matrix is sparse; its pattern is analysed once.

#include <carom/core/assembly.h>
#include <carom/core/dynamics/joint_factors.h>
#include <carom/core/dynamics/joint_pattern.h>
#include <carom/core/export.h>
#include <carom/core/joint_kind.h>

#include <memory>
#include <span>
#include <vector>

namespace carom {

/// Meaning of numbers of the bodies, and with that the constant c that goes with them.
enum class JointLevel : std::uint8_t {
  displacement,  ///< c the gaps
  velocity,      ///< c the rates of rows that depend on time
  acceleration,  ///< c the drifts
  change         ///< c zero: changes of velocities or accelerations
};

/// G x + c of a row.
[[nodiscard]] inline double residual(JointLevel level, const JointRow& row, const double* x) {
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

/// Constraints of one component. Owns workspaces and multipliers. Copies share what does not change.
class CAROM_API JointConstraints {
public:
  /// Of no component: empty.
  JointConstraints() = default;
  /// Analyses the pattern.
  JointConstraints(const Assembly& assembly, Index component);

  [[nodiscard]] bool empty() const { return gap_.empty(); }  ///< true if there are no joints
  /// Number of rows.
  [[nodiscard]] std::size_t size() const { return gap_.size(); }
  /// True if a row depends on time.
  [[nodiscard]] bool depends_on_time() const { return !rate_.empty(); }

  /// Takes the body with these velocities as too heavy to move.
  void fix(Range velocities);
  /// Brings the rows to a configuration and factorises.
  void update_and_factor(const JointView& at);
  /// Brings the rows to a configuration, but for drifts: those of JointLevel::acceleration are void. Until
  /// factor(), the factors are those of another one.
  void update(const JointView& at);
  /// Factorises with the rows as they are.
  void factor();
  /// Brings gaps() alone to a configuration.
  void update_gaps(const JointView& at);

  /// A row at the configuration where it was brought last.
  [[nodiscard]] JointRow row(std::size_t row) const;
  /// Gaps of all rows.
  [[nodiscard]] const std::vector<double>& gaps() const { return gap_; }
  /// Rate of a row.
  [[nodiscard]] double rate(std::size_t row) const { return rate_.empty() ? 0.0 : rate_[row]; }
  /// Writes G x + c of all rows.
  void residuals(JointLevel level, const double* x, double* out) const;
  /// Writes G x + rate of all rows, and beside it the sum of the magnitudes that it is made of.
  void residuals_and_sizes(const double* x, double* out, double* sizes) const;
  /// x += G^T l.
  void add_transposed(const double* multipliers, double* x) const;

  /// Makes x obey the constraints. \param x an array over all velocities \param multipliers out: l, sized as
  /// the rows; may be null
  void project(JointLevel level, double* x, double* multipliers = nullptr);
  /// r becomes -(G M^-1 G^T)^-1 r, zero in rows that follow from others.
  void solve(double* r);
  /// x += M^-1 G^T l.
  void add_response(const double* multipliers, double* x) const;
  /// x becomes M^-1 x over the component.
  void apply_inverse_mass(double* x) const;
  /// Velocities of the component.
  [[nodiscard]] Range velocities() const { return v_; }

  /// Joints with rows, and places of these.
  [[nodiscard]] const JointPattern& pattern() const { return *pattern_; }
  /// The joint of a row.
  [[nodiscard]] JointId joint(std::size_t row) const { return pattern_->id(pattern_->joint_of(row)); }
  /// The factors of G M^-1 G^T.
  [[nodiscard]] const JointFactors& factors() const { return factors_; }
  [[nodiscard]] JointFactors& factors() { return factors_; }

private:
  Range v_;
  std::shared_ptr<const JointPattern> pattern_ = JointPattern::empty();
  std::vector<double> jacobian_;            // row by row
  std::vector<double> gap_, rate_, drift_;  // by row; rate_ is empty if nothing depends on time
  std::vector<double> inverse_mass_;        // over v_: masses are diagonal
  JointFactors factors_;
  std::vector<double> right_;
  std::vector<double> given_, answer_;  // where factors are inexact: by row; over v_
};

}  // namespace carom
