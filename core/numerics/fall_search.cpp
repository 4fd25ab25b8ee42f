// Problem: the first fall of a quantity through zero, with a polynomial whose error is bounded or measured.

#include <carom/core/numerics/fall_search.h>

#include <carom/core/numerics/never.h>

#include <algorithm>
#include <cmath>

namespace carom {

namespace {

// Error of the quintic over its sixth derivative: 1/(6! 2^6).
constexpr double of_sixth = 1.0 / 46080.0;

// Errors of polynomials over what a look in the middle shows of them.
constexpr double of_middle = 4.0;

// Error of a quartic through five values over their fourth difference. Of a motion that turns by x between
// two values it is 0.03 x.
constexpr double of_fourth_difference = 0.125;

}  // namespace

double FallSearch::first(const QuantityLook& from, const QuantityLook& to) {
  if (rule_.derivatives > 0) return between(from, to, 0);
  const QuantityLook half = middle(from, to);
  return within({from, middle(from, half), half, middle(half, to), to}, 0);
}

QuantityLook FallSearch::middle(const QuantityLook& from, const QuantityLook& to) {
  return quantity_->look(from.time + 0.5 * (to.time - from.time));
}

/// True if the polynomial falls so steeply that what it interpolates does so once: its error is smooth, and
/// its rate at most some ten times error over length.
bool FallSearch::falls_clearly(const StepPolynomial& polynomial, double error) const {
  constexpr double steep = 0.05;
  if (!rule_.clear_falls) return false;
  const double latest = polynomial.lowered(-error).raised(rule_.raise).first_fall();
  return latest < never && latest - polynomial.lowered(error).raised(rule_.raise).first_fall() <= steep;
}

double FallSearch::between(const QuantityLook& from, const QuantityLook& to, int depth) {
  if (!(from.time < until_)) return never;
  const double length = to.time - from.time;
  if (0.5 * (from.at.value + to.at.value - rule_.fastest * length) + rule_.raise > 0.0) return never;
  const auto scaled = [length](StepPolynomial::End end) {
    end.first *= length;
    end.second *= length * length;
    return end;
  };
  const bool quintic = rule_.derivatives == 2;
  const StepPolynomial polynomial = quintic ? StepPolynomial::quintic(scaled(from.at), scaled(to.at))
                                            : StepPolynomial::cubic(scaled(from.at), scaled(to.at));
  const double turning = std::max(from.sixth, to.sixth);
  double error = turning > 0.0 ? std::pow(length, 6) * turning * of_sixth : 0.0;
  const bool deep = depth >= rule_.least_depth;
  // Far away against all that it does.
  if (deep && polynomial.least() > std::max(error, polynomial.most() - polynomial.least())) return never;
  QuantityLook half{};
  if (rule_.measured) {
    half = middle(from, to);
    error += of_middle * std::abs(polynomial.value(0.5) - half.at.value);
  }
  if (deep && !polynomial.lowered(error).raised(rule_.raise).falls()) return never;
  const bool small = error <= rule_.fine || !std::isfinite(error);
  if ((deep && (small || falls_clearly(polynomial, error))) || depth == rule_.deepest) {
    const double tau = polynomial.raised(rule_.raise).first_fall();
    return tau < never ? from.time + tau * length : never;
  }
  if (!rule_.measured) half = middle(from, to);
  const double first = between(from, half, depth + 1);
  return first < never ? first : between(half, to, depth + 1);
}

double FallSearch::within(const Five& looks, int depth) {
  if (!(looks.front().time < until_)) return never;
  std::array<double, 5> f{};
  for (std::size_t i = 0; i < f.size(); ++i) f[i] = looks[i].at.value;
  const StepPolynomial polynomial = StepPolynomial::through(f);
  const double error = of_fourth_difference * std::abs(f[0] - 4.0 * f[1] + 6.0 * f[2] - 4.0 * f[3] + f[4]);
  // Where a value is not a number, at a pole, the parts beside it are looked at.
  const bool known = std::isfinite(error);
  if (known && !polynomial.lowered(error).raised(rule_.raise).falls()) return never;
  const bool small = error <= rule_.fine;
  if (small || (known && falls_clearly(polynomial, error)) || depth == rule_.deepest) {
    const double tau = polynomial.raised(rule_.raise).first_fall();
    return tau < never ? looks.front().time + tau * (looks.back().time - looks.front().time) : never;
  }
  const double first = within(
      {looks[0], middle(looks[0], looks[1]), looks[1], middle(looks[1], looks[2]), looks[2]}, depth + 1);
  if (first < never) return first;
  return within({looks[2], middle(looks[2], looks[3]), looks[3], middle(looks[3], looks[4]), looks[4]},
                depth + 1);
}

}  // namespace carom
