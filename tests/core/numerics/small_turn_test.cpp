#include <carom/core/numerics/small_turn.h>

#include "tests/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace {

using namespace carom;
using carom_test::Random;

// Rounding of cos a and sin a, of the sum, and of the products, which are a tenth at most.
constexpr double few_roundings = 1.5 * std::numeric_limits<double>::epsilon();

TEST(SmallTurn, MeetsTheFunctionsOfTheSum) {
  Random random(7);
  for (int i = 0; i < 20000; ++i) {
    const double angle = random.uniform(-4.0, 4.0);
    const double d = (i % 2 == 0 ? 1.0 : 1e-3) * random.uniform(-largest_small_turn, largest_small_turn);
    // The sum has a rounding of its own: the turn that counts is what is left of it.
    const double sum = angle + d, turn = sum - angle;
    const Pair turned = small_turn(Pair{std::cos(angle), std::sin(angle)}, turn);
    EXPECT_NEAR(turned[0], std::cos(sum), few_roundings) << angle << " " << d;
    EXPECT_NEAR(turned[1], std::sin(sum), few_roundings) << angle << " " << d;
  }
}

TEST(SmallTurn, NoTurnChangesNothing) {
  const Pair known{std::cos(0.7), std::sin(0.7)};
  const Pair turned = small_turn(known, 0.0);
  EXPECT_EQ(turned[0], known[0]);
  EXPECT_EQ(turned[1], known[1]);
}

}  // namespace
