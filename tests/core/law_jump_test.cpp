// Jumps of prescribed displacements are found where they are, and are not seen in what is continuous.

#include "tests/random.h"

#include <carom/core/law_jump.h>
#include <carom/core/numerics/time_difference.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <vector>

namespace {

using namespace carom;
using Function = std::function<double(double)>;

/// A law of one coordinate; its rate by differences where none is given.
struct Law {
  Function place, rate;
  std::vector<double> breaks{};
  mutable int looks = 0;

  LawPoint operator()(double time) const {
    ++looks;
    LawPoint point{.time = time};
    point.place[0] = place(time);
    point.velocity[0] = rate ? rate(time) : TimeDifference(time, 1, breaks)(place);
    return point;
  }
  /// Jump that a run with steps of this length would notice from `begin` to `end`.
  [[nodiscard]] std::optional<LawJump> first_jump(double begin, double end, double step) const {
    const auto steps = static_cast<int>(std::ceil((end - begin) / step));
    LawPoint last = (*this)(begin);
    for (int i = 1; i <= steps; ++i) {
      const LawPoint now = (*this)(begin + i * step);
      if (!looks_smooth(last, now)) {
        if (const auto jump = find_jump(*this, last, now)) return jump;
      }
      last = now;
    }
    return std::nullopt;
  }
};

/// A sum of three sines and a ramp, with its rate if asked for.
Law smooth_law(carom_test::Random& random, double fastest, bool with_rate) {
  std::vector<std::array<double, 3>> parts;
  for (int i = 0; i < 3; ++i) {
    parts.push_back(
        {std::pow(10.0, random.uniform(-4.0, 1.0)), random.uniform(0.1, fastest), random.uniform(0.0, 6.0)});
  }
  const double ramp = random.uniform(-3.0, 3.0), offset = random.uniform(-5.0, 5.0);
  Law law;
  law.place = [=](double t) {
    double sum = offset + ramp * t;
    for (const auto& [a, w, phase] : parts) sum += a * std::sin(w * t + phase);
    return sum;
  };
  if (with_rate) {
    law.rate = [=](double t) {
      double sum = ramp;
      for (const auto& [a, w, phase] : parts) sum += a * w * std::cos(w * t + phase);
      return sum;
    };
  }
  return law;
}

TEST(LawJump, ContinuousLawsHaveNone) {
  carom_test::Random random(1701);
  for (int repeat = 0; repeat < 200; ++repeat) {
    const bool with_rate = random.below(2) == 0;
    // Differences follow some 300 rad/s; with rates the frequency may be far beyond what steps resolve.
    const Law law = smooth_law(random, with_rate ? 3e3 : 300.0, with_rate);
    const double step = std::pow(10.0, random.uniform(-4.0, -1.0)), begin = random.uniform(0.0, 100.0);
    EXPECT_FALSE(law.first_jump(begin, begin + 30.0 * step, step)) << repeat;
  }
}

TEST(LawJump, KinksAndSteepRampsAreNone) {
  carom_test::Random random(1702);
  for (int repeat = 0; repeat < 200; ++repeat) {
    const double at = random.uniform(0.1, 0.9), height = std::pow(10.0, random.uniform(-6.0, 0.0)),
                 width = std::pow(10.0, random.uniform(-9.0, -1.0));
    Law law;
    law.place = [=](double t) { return 2.0 + height * std::clamp((t - at) / width, 0.0, 1.0); };
    if (random.below(2) == 0) {
      law.rate = [=](double t) { return t > at && t < at + width ? height / width : 0.0; };
    }
    if (random.below(2) == 0) law.breaks = {at, at + width};
    const double step = std::pow(10.0, random.uniform(-3.0, -1.0));
    EXPECT_FALSE(law.first_jump(0.0, 1.0 + step, step))
        << repeat << ": " << height << " m in " << width << " s";
  }
}

TEST(LawJump, TablesAreNone) {
  // Places and rates of a table, both interpolated: between its rows they do not fit each other.
  carom_test::Random random(1703);
  for (int repeat = 0; repeat < 2; ++repeat) {
    constexpr double row = 0.05;
    std::vector<double> places, rates;
    for (int i = 0; i < 40; ++i) {
      places.push_back(random.uniform(-1.0, 1.0));
      rates.push_back(random.uniform(-20.0, 20.0));
    }
    const auto interpolated = [=](const std::vector<double>& of) {
      return [=](double t) {
        const double at = std::clamp(t / row, 0.0, static_cast<double>(of.size()) - 1.001);
        const auto i = static_cast<std::size_t>(at);
        const double part = at - static_cast<double>(i);
        return (1.0 - part) * of[i] + part * of[i + 1];
      };
    };
    Law law;
    law.place = interpolated(places);
    law.rate = interpolated(rates);
    EXPECT_FALSE(law.first_jump(0.0, 0.5, 1e-3));
    // A misfit costs looks, but no more than these for each step.
    EXPECT_LE(law.looks, 500 * 300);
  }
}

TEST(LawJump, IsFoundWhereItIs) {
  carom_test::Random random(1704);
  for (int repeat = 0; repeat < 300; ++repeat) {
    const bool with_rate = random.below(2) == 0;
    const Law around = smooth_law(random, 30.0, with_rate);
    const double at = random.uniform(1.0, 2.0), step = std::pow(10.0, random.uniform(-4.0, -2.0));
    // Larger than the way of the motion in a step.
    double fastest = 0.0;
    const Function rate = with_rate ? around.rate : [&](double t) {
      return (around.place(t + 1e-5) - around.place(t - 1e-5)) / 2e-5;
    };
    for (double t = at - 2.0 * step; t < at + 2.0 * step; t += 0.1 * step)
      fastest = std::max(fastest, std::abs(rate(t)));
    const double size = std::copysign(std::max(1e-6, 2.0 * fastest * step), random.uniform(-1.0, 1.0));
    Law law = around;
    law.place = [=](double t) { return around.place(t) + (t > at ? size : 0.0); };
    if (random.below(2) == 0) law.breaks = {std::nextafter(at, 2.0)};
    const double begin = at - random.uniform(1.0, 10.0) * step;
    const auto jump = law.first_jump(begin, begin + 12.0 * step, step);
    ASSERT_TRUE(jump.has_value()) << repeat << ": " << size << " m, steps of " << step << " s";
    EXPECT_NEAR(jump->time, at, 4e-16 * at);
    EXPECT_NEAR(jump->size, std::abs(size), 1e-9 * (std::abs(size) + std::abs(around.place(at))));
    EXPECT_FALSE(jump->of_angle);
  }
}

// A rate that is given may be none of its place: of the wrong sign, of another law, or nothing.
TEST(LawJump, FalseRatesAreTold) {
  carom_test::Random random(1708);
  int told_of = 0;
  for (int repeat = 0; repeat < 200; ++repeat) {
    const Law right = smooth_law(random, 30.0, true);
    const double begin = random.uniform(0.0, 10.0), length = std::pow(10.0, random.uniform(-4.0, -1.0));
    for (const double factor : {1.0, -1.0, 0.0, 2.0, 0.5}) {
      const auto law = [&](double t) {
        LawPoint point{.time = t, .velocity_given = true};
        point.place[0] = right.place(t);
        point.velocity[0] = factor * right.rate(t);
        return point;
      };
      const auto found = find_false_rate(law, law(begin), law(begin + length));
      if (factor == 1.0) {
        EXPECT_FALSE(found.has_value()) << repeat;
        continue;
      }
      // Where the law turns back, or is at rest, nothing is seen at one of the times.
      if (!found) continue;
      ++told_of;
      // Told is the mean over a way of at most an eighth of the interval: as much as the rate changes there,
      // and what rounding of 1e-15 max|x| makes of the shortest way.
      const double rate = right.rate(found->time);
      double change = 0.0;
      for (int i = 1; i <= 16; ++i) {
        change = std::max(change, std::abs(right.rate(found->time + i * length / 128.0) - rate));
      }
      EXPECT_NEAR(found->off, std::abs((factor - 1.0) * rate), 2.0 * change + 1e-5) << factor;
    }
  }
  EXPECT_GE(told_of, 760);  // 95 % of 800: few laws turn back or rest at one of five times
  const auto still = [](double t) { return LawPoint{.time = t, .place = {t, 0.0, 0.0}}; };
  EXPECT_FALSE(find_false_rate(still, still(0.0), still(0.1)));  // not given
  auto told = [](double t) { return LawPoint{.time = t, .place = {t, 0.0, 0.0}, .velocity_given = true}; };
  ASSERT_TRUE(find_false_rate(told, told(0.0), told(0.1)));
  EXPECT_NEAR(find_false_rate(told, told(0.0), told(0.1))->off, 1.0, 1e-9);
}

// Near its zero a law has the rounding of what it is computed from.
TEST(LawJump, RoundingOfLawsThatComeToZeroIsNone) {
  // Down to zero at 1.2 s and up again, in steps one of which is as short as times can be.
  const double turn = 6 * 0.2;
  Law law;
  law.place = [=](double t) { return t < turn ? 0.2 - (t - 1.0) : t - turn; };
  law.rate = [=](double t) { return t < turn ? -1.0 : 1.0; };
  const double before = 1.2;
  ASSERT_LT(before, turn);
  ASSERT_NE(law.place(before), law.place(turn));
  EXPECT_FALSE(find_jump(law, law(before), law(turn)));
}

TEST(LawJump, BeforeTheStartAndBeyondTheEnd) {
  // Differences feel a jump that lies a little outside of a step.
  for (const double at : {-1e-4, 0.0, 0.1 + 1e-4, 0.1 + 6e-4}) {
    Law law;
    law.place = [=](double t) { return t > at ? 0.01 : 0.0; };
    const auto jump = law.first_jump(0.0, 0.1, 0.1);
    ASSERT_TRUE(jump.has_value()) << at;
    EXPECT_NEAR(jump->time, at, 1e-15);
  }
}

TEST(LawJump, WholeTurnsOfAnglesCountWhereRatesAreDifferences) {
  constexpr double turn = 2.0 * std::numbers::pi, rate = 3.0;
  const auto first_jump = [&](bool with_rate, double size) {
    const auto angle = [=](double t) { return rate * t - (t > 0.5 ? size : 0.0); };
    auto law = [=](double t) {
      LawPoint point{.time = t};
      point.angle = angle(t);
      point.spin = with_rate ? rate : TimeDifference(t, 1, {})(angle);
      return point;
    };
    std::optional<LawJump> found;
    for (int i = 0; i < 100 && !found; ++i) {
      const LawPoint from = law(0.01 * i), to = law(0.01 * (i + 1));
      if (!looks_smooth(from, to)) found = find_jump(law, from, to);
    }
    return found;
  };
  EXPECT_FALSE(first_jump(true, turn));  // the place is the same, and so is the spin
  for (const auto& jump : {first_jump(false, turn), first_jump(false, 0.1), first_jump(true, 0.1)}) {
    ASSERT_TRUE(jump.has_value());
    EXPECT_TRUE(jump->of_angle);
    EXPECT_NEAR(jump->time, 0.5, 1e-15);
  }
}

}  // namespace
