#pragma once

/// \file
/// When does a quantity known at a few times of a step fall through zero first? The polynomial through what
/// is known, in Bernstein's form: it lies between the least and the largest of its coefficients, so that
/// positive ones prove that there is no root, and halving the interval finds the first one for certain.

#include <carom/core/export.h>

#include <array>
#include <span>

namespace carom {

/// A polynomial over the step, tau in [0, 1].
class CAROM_API StepPolynomial {
public:
  /// A quantity at one end of a step: its value and derivatives with respect to tau.
  struct End {
    double value = 0.0, first = 0.0, second = 0.0;
  };
  /// Degree 3, from values and first derivatives.
  [[nodiscard]] static StepPolynomial cubic(const End& start, const End& end);
  /// Degree 5, from values, first and second derivatives.
  [[nodiscard]] static StepPolynomial quintic(const End& start, const End& end);
  /// Degree 4, through five values at equal distances.
  [[nodiscard]] static StepPolynomial through(std::span<const double, 5> values);

  /// Numbers that it stays between: the least and the largest of its coefficients.
  [[nodiscard]] double least() const;
  [[nodiscard]] double most() const;
  /// Value of the polynomial at tau in [0, 1].
  [[nodiscard]] double value(double tau) const;
  /// The polynomial plus a constant.
  [[nodiscard]] StepPolynomial raised(double constant) const;
  /// A lower bound of a quantity that this interpolates with an error of at most `error`, which vanishes
  /// where the polynomial was given: of cubic() and quintic() like (tau (1 - tau))^2 and ^3, greatest in the
  /// middle; of through() it vanishes at both ends. With error < 0 an upper bound. Not for a polynomial that
  /// is one.
  [[nodiscard]] StepPolynomial lowered(double error) const;
  /// The first tau at which it falls below zero, infinity if it does not; 0 if it starts there.
  [[nodiscard]] double first_fall() const;
  /// True if the polynomial falls below zero within the step; costs much less than first_fall().
  [[nodiscard]] bool falls() const;

private:
  static constexpr int most_degree = 6;
  [[nodiscard]] StepPolynomial elevated() const;

  std::array<double, most_degree + 1> b_{};
  int degree_ = 0;
};

}  // namespace carom
