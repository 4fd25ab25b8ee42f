// Problem: the first root of a polynomial on an interval, found for certain.

#include <carom/core/numerics/step_polynomial.h>

#include <carom/core/numerics/never.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom {

namespace {

// Halvings after which two roots count as one that only touches.
constexpr int most_halvings = 30;

using Coefficients = std::array<double, 7>;

/// A value and its derivative.
struct ValueAndSlope {
  double value, slope;
};

/// By de Casteljau's scheme. The compiler knows the degree and keeps all numbers in registers.
template <std::size_t Degree, std::size_t Whole = Degree>
ValueAndSlope value_of(const std::array<double, Degree + 1>& b, double tau) {
  if constexpr (Degree == 1) {
    const double change = b[1] - b[0];
    return {b[0] + tau * change, static_cast<double>(Whole) * change};
  } else {
    std::array<double, Degree> next;
    for (std::size_t i = 0; i < Degree; ++i) next[i] = b[i] + tau * (b[i + 1] - b[i]);
    return value_of<Degree - 1, Whole>(next, tau);
  }
}

/// The root of a polynomial that falls through zero once: Newton's method within an interval that keeps it,
/// until the root no longer moves; halving where it rises, and where a step would leave the interval or be no
/// shorter than half the step before.
template <std::size_t Degree>
double lone_root(const Coefficients& coefficients) {
  constexpr int most_steps = 150;
  constexpr double still = 0.5 * std::numeric_limits<double>::epsilon();
  std::array<double, Degree + 1> b;
  std::copy_n(coefficients.begin(), Degree + 1, b.begin());
  double low = 0.0, high = 1.0, step = 1.0;
  double root = b[0] / (b[0] - b[Degree]);
  if (!(root >= low && root <= high)) root = 0.5;
  for (int i = 0; i < most_steps; ++i) {
    const auto [value, slope] = value_of<Degree>(b, root);
    (value >= 0.0 ? low : high) = root;
    double next = root - value / slope;
    const bool fits = slope < 0.0 && next >= low && next <= high && 2.0 * std::abs(next - root) <= step;
    if (!fits) next = 0.5 * (low + high);
    step = std::abs(next - root);
    root = next;
    if (step <= still || high - low <= still) break;
  }
  return root;
}

/// The first fall between two times, infinity if there is none. \param root_of root of coefficients that fall
/// through zero once
template <class RootOf>
double fall_within(const Coefficients& b, int degree, double from, double to, int depth,
                   const RootOf& root_of) {
  int changes = 0;
  bool positive = true, any = false;
  for (std::size_t i = 0; i <= static_cast<std::size_t>(degree); ++i) {
    const bool is_positive = b[i] >= 0.0;
    any = any || !is_positive;
    if (i > 0 && is_positive != positive) ++changes;
    positive = is_positive;
  }
  if (!any) return never;
  if (changes == 1) return from + (to - from) * root_of(b);
  if (depth == most_halvings) return never;
  Coefficients left{}, right = b;
  left[0] = right[0];
  for (int level = 1; level <= degree; ++level) {
    for (std::size_t i = 0; i + static_cast<std::size_t>(level) <= static_cast<std::size_t>(degree); ++i) {
      right[i] = 0.5 * (right[i] + right[i + 1]);
    }
    left[static_cast<std::size_t>(level)] = right[0];
  }
  const double middle = 0.5 * (from + to);
  const double first = fall_within(left, degree, from, middle, depth + 1, root_of);
  return first < never ? first : fall_within(right, degree, middle, to, depth + 1, root_of);
}

}  // namespace

StepPolynomial StepPolynomial::cubic(const End& start, const End& end) {
  StepPolynomial p;
  p.degree_ = 3;
  p.b_ = {start.value, start.value + start.first / 3.0, end.value - end.first / 3.0, end.value};
  return p;
}

StepPolynomial StepPolynomial::quintic(const End& start, const End& end) {
  StepPolynomial p;
  p.degree_ = 5;
  p.b_ = {start.value,
          start.value + start.first / 5.0,
          start.value + 2.0 * start.first / 5.0 + start.second / 20.0,
          end.value - 2.0 * end.first / 5.0 + end.second / 20.0,
          end.value - end.first / 5.0,
          end.value};
  return p;
}

StepPolynomial StepPolynomial::through(std::span<const double, 5> f) {
  // The linear map from five values to Bernstein coefficients of degree 4.
  StepPolynomial p;
  p.degree_ = 4;
  p.b_[0] = f[0];
  p.b_[1] = (-13.0 * f[0] + 48.0 * f[1] - 36.0 * f[2] + 16.0 * f[3] - 3.0 * f[4]) / 12.0;
  p.b_[2] = (13.0 * f[0] - 64.0 * f[1] + 120.0 * f[2] - 64.0 * f[3] + 13.0 * f[4]) / 18.0;
  p.b_[3] = (-3.0 * f[0] + 16.0 * f[1] - 36.0 * f[2] + 48.0 * f[3] - 13.0 * f[4]) / 12.0;
  p.b_[4] = f[4];
  return p;
}

double StepPolynomial::least() const { return *std::min_element(b_.begin(), b_.begin() + degree_ + 1); }

double StepPolynomial::most() const { return *std::max_element(b_.begin(), b_.begin() + degree_ + 1); }

double StepPolynomial::value(double tau) const {
  Coefficients work = b_;
  for (int level = degree_; level > 0; --level) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(level); ++i) {
      work[i] += tau * (work[i + 1] - work[i]);
    }
  }
  return work[0];
}

StepPolynomial StepPolynomial::raised(double constant) const {
  StepPolynomial p = *this;
  for (double& b : p.b_) b += constant;
  return p;
}

/// The same, written with one degree more.
StepPolynomial StepPolynomial::elevated() const {
  StepPolynomial p;
  p.degree_ = degree_ + 1;
  const double degree = p.degree_;
  p.b_[0] = b_[0];
  for (int i = 1; i <= degree_; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const double share = i / degree;
    p.b_[at] = share * b_[at - 1] + (1.0 - share) * b_[at];
  }
  p.b_[static_cast<std::size_t>(p.degree_)] = b_[static_cast<std::size_t>(degree_)];
  return p;
}

StepPolynomial StepPolynomial::lowered(double error) const {
  if (degree_ % 2 == 0) {
    StepPolynomial p = *this;
    for (std::size_t i = 1; i < static_cast<std::size_t>(degree_); ++i) p.b_[i] -= error;
    return p;
  }
  // (tau (1 - tau))^m, m half of the degree 2 m, is a single number of Bernstein's form, over binomial(2 m,
  // m).
  const bool of_cubic = degree_ == 3;
  StepPolynomial p = elevated();
  p.b_[of_cubic ? 2 : 3] -= error * (of_cubic ? 16.0 / 6.0 : 64.0 / 20.0);
  return p;
}

double StepPolynomial::first_fall() const {
  if (!(b_[0] >= 0.0)) return 0.0;
  return fall_within(b_, degree_, 0.0, 1.0, 0, [this](const Coefficients& b) {
    switch (degree_) {
      case 3:
        return lone_root<3>(b);
      case 4:
        return lone_root<4>(b);
      case 5:
        return lone_root<5>(b);
      default:
        return lone_root<most_degree>(b);
    }
  });
}

bool StepPolynomial::falls() const {
  if (!(b_[0] >= 0.0)) return true;
  return fall_within(b_, degree_, 0.0, 1.0, 0, [](const Coefficients&) { return 0.0; }) < never;
}

}  // namespace carom
