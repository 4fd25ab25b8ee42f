// Polynomials over a step: they have the values that made them, and their first fall through zero is found
// against dense sampling, with double roots, roots at the ends, and none where there is none.

#include "tests/random.h"

#include <carom/core/numerics/step_polynomial.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace {

using carom::StepPolynomial;
using carom_test::Random;
using End = StepPolynomial::End;

constexpr double never = std::numeric_limits<double>::infinity();
constexpr double eps = std::numeric_limits<double>::epsilon();

/// sum a_i tau^i with its derivatives.
struct Powers {
  std::vector<double> a;

  double value(double tau) const {
    double sum = 0.0;
    for (std::size_t i = a.size(); i-- > 0;) sum = sum * tau + a[i];
    return sum;
  }
  Powers derivative() const {
    Powers d;
    for (std::size_t i = 1; i < a.size(); ++i) d.a.push_back(static_cast<double>(i) * a[i]);
    if (d.a.empty()) d.a.push_back(0.0);
    return d;
  }
  End at(double tau) const {
    return {value(tau), derivative().value(tau), derivative().derivative().value(tau)};
  }
  double size() const {
    double sum = 0.0;
    for (const double c : a) sum += std::abs(c);
    return sum;
  }
  StepPolynomial quintic() const { return StepPolynomial::quintic(at(0.0), at(1.0)); }
  StepPolynomial cubic() const { return StepPolynomial::cubic(at(0.0), at(1.0)); }
  StepPolynomial through() const {
    std::array<double, 5> values{};
    for (std::size_t i = 0; i < 5; ++i) values[i] = value(static_cast<double>(i) / 4.0);
    return StepPolynomial::through(values);
  }
};

/// Product of (tau - root) with a sign.
Powers with_roots(const std::vector<double>& roots, double factor) {
  Powers p{{factor}};
  for (const double root : roots) {
    std::vector<double> next(p.a.size() + 1, 0.0);
    for (std::size_t i = 0; i < p.a.size(); ++i) {
      next[i + 1] += p.a[i];
      next[i] -= root * p.a[i];
    }
    p.a = next;
  }
  return p;
}

Powers random_powers(Random& random, std::size_t degree) {
  Powers p;
  for (std::size_t i = 0; i <= degree; ++i) p.a.push_back(random.uniform(-1.0, 1.0));
  return p;
}

TEST(StepPolynomial, HasTheValuesOfWhatMadeIt) {
  Random random(1);
  for (int n = 0; n < 1000; ++n) {
    const Powers three = random_powers(random, 3), four = random_powers(random, 4),
                 five = random_powers(random, 5);
    for (int i = 0; i <= 20; ++i) {
      const double tau = i / 20.0;
      // Coefficients are sums of derivatives up to 20 times the sizes.
      EXPECT_NEAR(three.cubic().value(tau), three.value(tau), 100.0 * eps * three.size());
      EXPECT_NEAR(four.through().value(tau), four.value(tau), 200.0 * eps * four.size());
      EXPECT_NEAR(five.quintic().value(tau), five.value(tau), 100.0 * eps * five.size());
      EXPECT_NEAR(five.quintic().raised(0.5).value(tau), five.value(tau) + 0.5,
                  100.0 * eps * (five.size() + 0.5));
    }
  }
}

TEST(StepPolynomial, LiesBetweenItsLeastAndItsMost) {
  Random random(2);
  for (int n = 0; n < 1000; ++n) {
    const Powers five = random_powers(random, 5);
    const StepPolynomial p = five.quintic();
    for (int i = 0; i <= 20; ++i) {
      EXPECT_GE(p.value(i / 20.0), p.least() - 10.0 * eps * five.size());
      EXPECT_LE(p.value(i / 20.0), p.most() + 10.0 * eps * five.size());
    }
  }
}

TEST(StepPolynomial, FallOfALine) {
  EXPECT_NEAR(StepPolynomial::cubic({1.0, -2.0, 0.0}, {-1.0, -2.0, 0.0}).first_fall(), 0.5, eps);
  EXPECT_NEAR(StepPolynomial::quintic({1.0, -4.0, 0.0}, {-3.0, -4.0, 0.0}).first_fall(), 0.25, eps);
  const std::array<double, 5> line{3.0, 2.0, 1.0, 0.0, -1.0};
  EXPECT_NEAR(StepPolynomial::through(line).first_fall(), 0.75, 4.0 * eps);
  // One that rises never falls, even from zero.
  EXPECT_EQ(StepPolynomial::cubic({0.0, 1.0, 0.0}, {1.0, 1.0, 0.0}).first_fall(), never);
  EXPECT_EQ(StepPolynomial::cubic({1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}).first_fall(), never);
  EXPECT_EQ(StepPolynomial::quintic({0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}).first_fall(), never);
}

// A bounce of a fast ball in a long step: the value it begins with is nothing against that at the end. The
// fall was found where the ball had just left.
TEST(StepPolynomial, FallsFromNextToNothingFarBelowZero) {
  for (const double far : {1e2, 1e4, 1e8, 1e12}) {
    for (const double fall : {0.9, 1e-3, 1e-6}) {
      // raise + far tau (fall - tau)
      const Powers bounce{{1e-14, far * fall, -far}};
      const double root = 0.5 * (fall + std::sqrt(fall * fall + 4e-14 / far));
      // Where it falls, values are rounding of coefficients up to the size of the fall, and the slope is
      // that.
      EXPECT_NEAR(bounce.quintic().first_fall(), root, 8.0 * eps) << far << " " << fall;
      EXPECT_NEAR(bounce.cubic().first_fall(), root, 8.0 * eps) << far << " " << fall;
      // The same seen from the end: it falls from far above to next to nothing below.
      const Powers late{
          {far * (1.0 - fall) - 1e-14, far * (fall - 2.0), far}};  // its mirror image, turned round
      EXPECT_NEAR(late.quintic().first_fall(), 1.0 - root, 8.0 * eps / fall) << far << " " << fall;
    }
  }
}

TEST(StepPolynomial, StartsAtZero) {
  // A ball that has just hit: from zero upwards and back at 3/4.
  const Powers bounce = with_roots({0.0, 0.75}, -1.0);
  EXPECT_NEAR(bounce.quintic().first_fall(), 0.75, 4.0 * eps);
  // From zero downwards.
  EXPECT_NEAR(StepPolynomial::quintic({0.0, -1.0, 0.0}, {-1.0, -1.0, 0.0}).first_fall(), 0.0, 4.0 * eps);
  // Below zero, though it rises.
  EXPECT_EQ(StepPolynomial::quintic({-1e-300, 1.0, 0.0}, {1.0, 1.0, 0.0}).first_fall(), 0.0);
  // A value that is not a number is an event at once, rather than none.
  EXPECT_EQ(StepPolynomial::cubic({std::nan(""), 1.0, 0.0}, {1.0, 1.0, 0.0}).first_fall(), 0.0);
}

TEST(StepPolynomial, EndsAtZero) {
  // Not below zero within the step: the next one will see.
  const double at_end = with_roots({1.0, 2.0}, 1.0).quintic().first_fall();
  EXPECT_TRUE(at_end == never || at_end >= 1.0 - 8.0 * eps) << at_end;
}

TEST(StepPolynomial, TouchesAndDips) {
  // (tau - 1/3)^2 + depth: what only touches may or may not be found, what stays above may not.
  for (const double height : {1e-3, 1e-6, 1e-9, 1e-12}) {
    Powers above = with_roots({1.0 / 3.0, 1.0 / 3.0}, 1.0);
    above.a[0] += height;
    EXPECT_EQ(above.quintic().first_fall(), never) << height;
    EXPECT_EQ(above.cubic().first_fall(), never) << height;
    Powers below = with_roots({1.0 / 3.0, 1.0 / 3.0}, 1.0);
    below.a[0] -= height;
    // The root moves by rounding over twice the slope there.
    const double root = 1.0 / 3.0 - std::sqrt(height), noise = 10.0 * eps / (2.0 * std::sqrt(height));
    EXPECT_NEAR(below.quintic().first_fall(), root, noise) << height;
    EXPECT_NEAR(below.cubic().first_fall(), root, noise) << height;
    EXPECT_NEAR(below.through().first_fall(), root, 10.0 * noise) << height;
  }
}

TEST(StepPolynomial, TheFirstOfSeveralFalls) {
  // Falls at 0.1, rises at 0.1 + 1e-6, falls at 0.9.
  const Powers three = with_roots({0.1, 0.1 + 1e-6, 0.9}, -1.0);
  EXPECT_NEAR(three.quintic().first_fall(), 0.1, 1e-9);  // rounding over a slope of 1e-6
  const Powers five = with_roots({0.1, 0.3, 0.5, 0.7, 0.9}, -1.0);
  EXPECT_NEAR(five.quintic().first_fall(), 0.1, 1e-12);
  // Rises first: starts below.
  EXPECT_EQ(with_roots({0.1, 0.3, 0.5, 0.7, 0.9}, 1.0).quintic().first_fall(), 0.0);
}

// Random polynomials against dense sampling: no fall before the one that is found, one there, none found
// where samples and a margin show none.
TEST(StepPolynomial, RandomOnesAgainstDenseSampling) {
  Random random(3);
  int with = 0, without = 0;
  for (int n = 0; n < 4000; ++n) {
    Powers p;
    if (random.below(2) == 0) {
      p = random_powers(random, 5);
      p.a[0] = std::abs(p.a[0]);
    } else {
      // Several roots in the interval, some of them close together.
      std::vector<double> roots{random.uniform(0.0, 1.0)};
      for (int i = 0; i < 4; ++i) {
        const bool close = random.below(2) == 0;
        roots.push_back(close ? roots.back() + std::pow(10.0, random.uniform(-5.0, -1.0))
                              : random.uniform(-1.0, 2.0));
      }
      p = with_roots(roots, random.below(2) == 0 ? 1.0 : -1.0);
      if (p.a[0] < 0.0) {
        for (double& c : p.a) c = -c;
      }
    }
    const double noise = 200.0 * eps * p.size();
    const double fall = p.quintic().first_fall();
    for (const StepPolynomial& known : {p.quintic(), p.cubic(), p.through(), p.quintic().lowered(0.1)}) {
      EXPECT_EQ(known.falls(), known.first_fall() < never) << n;
    }
    constexpr int samples = 2000;
    for (int i = 0; i <= samples; ++i) {
      const double tau = static_cast<double>(i) / samples;
      if (tau >= fall) break;
      EXPECT_GE(p.value(tau), -noise) << n << " before the fall at " << fall;
    }
    if (fall == never) {
      ++without;
      continue;
    }
    ++with;
    EXPECT_NEAR(p.value(fall), 0.0, noise) << n;
    // It goes below just behind, by more than rounding or up to the next rise.
    const double slope = p.derivative().value(fall);
    EXPECT_LE(slope, std::sqrt(noise) * 10.0) << n;
  }
  EXPECT_GE(with, 1000);
  EXPECT_GE(without, 500);
}

}  // namespace
