// Ends of accumulations of impacts from the times of the latest ones.

#include <carom/core/constraint_set.h>
#include <carom/integrators/event_driven/accumulation.h>

#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>
#include <vector>

namespace {

using namespace carom;

ConstraintKey contact(Index serial) {
  ConstraintKey key;
  key.a.serial = serial;
  return key;
}

/// Remembers impacts on contacts in turn, whose rounds end at times 1 - ratio^k.
Accumulation rounds(int count, double ratio, std::initializer_list<Index> contacts) {
  Accumulation impacts;
  for (int k = 1; k <= count; ++k) {
    double time = 1.0 - std::pow(ratio, k);
    for (const Index at : contacts) {
      impacts.remember(time, contact(at));
      time += 0.1 * std::pow(ratio, k) * (1.0 - ratio);
    }
  }
  return impacts;
}

TEST(Accumulation, EndOfIntervalsThatShrinkInOneRatio) {
  for (const double ratio : {0.2, 0.5, 0.9}) {
    const Accumulation impacts = rounds(6, ratio, {0});
    EXPECT_NEAR(impacts.end(1.0 - std::pow(ratio, 7)), 1.0, 1e-12) << ratio;
  }
}

TEST(Accumulation, PatternsOfSeveralContacts) {
  const double ratio = 0.6;
  for (const auto& contacts : {std::initializer_list<Index>{0, 1}, {0, 1, 2}, {0, 1, 0, 2}}) {
    EXPECT_NEAR(rounds(6, ratio, contacts).end(1.0 - std::pow(ratio, 7)), 1.0, 1e-12) << contacts.size();
  }
}

TEST(Accumulation, UnrelatedImpactsInBetween) {
  const double ratio = 0.5;
  Accumulation impacts;
  for (int k = 1; k <= 6; ++k) {
    impacts.remember(1.0 - std::pow(ratio, k), contact(0));
    // Of another contact, at times that follow no rule.
    for (int i = 0; i < k % 3; ++i) impacts.remember(1.0 - (0.9 - 0.1 * i) * std::pow(ratio, k), contact(1));
  }
  ConstraintSet closing;
  closing.add();
  closing[0].key = contact(0);
  const double now = 1.0 - std::pow(ratio, 7);
  EXPECT_TRUE(std::isnan(impacts.end(now)));
  EXPECT_NEAR(impacts.end(now, closing), 1.0, 1e-12);
  closing[0].key = contact(1);
  EXPECT_TRUE(std::isnan(impacts.end(now, closing)));
}

TEST(Accumulation, NoEndIsKnown) {
  EXPECT_TRUE(std::isnan(Accumulation().end(1.0)));
  EXPECT_TRUE(std::isnan(rounds(3, 0.5, {0}).end(1.0 - std::pow(0.5, 4)))) << "too few";
  Accumulation even, changing;
  for (int k = 0; k < 8; ++k) {
    even.remember(k, contact(0));
    changing.remember(1.0 - 1.0 / (k + 1.0), contact(0));
  }
  EXPECT_TRUE(std::isnan(even.end(8.0))) << "intervals do not shrink";
  EXPECT_TRUE(std::isnan(changing.end(1.0 - 1.0 / 9.0))) << "their ratio changes";
}

TEST(Accumulation, RepeatedImpactsOfOneInstantCountOnce) {
  Accumulation impacts;
  for (int k = 1; k <= 6; ++k) {
    for (int again = 0; again < 3; ++again) impacts.remember(1.0 - std::pow(0.5, k), contact(0));
  }
  EXPECT_NEAR(impacts.end(1.0 - std::pow(0.5, 7)), 1.0, 1e-12);
  impacts.clear();
  EXPECT_TRUE(std::isnan(impacts.end(1.0)));
}

TEST(Accumulation, ContactsOfLongAgoAreForgotten) {
  const double ratio = 0.5;
  Accumulation impacts;
  Index other = 1;
  for (; other <= 200; ++other) impacts.remember(1e-3 * other, contact(other));
  for (int k = 1; k <= 6; ++k) {
    const double time = 2.0 - std::pow(ratio, k);
    impacts.remember(time, contact(0));
    for (int i = 1; i <= 4; ++i) impacts.remember(time + 0.01 * i * std::pow(ratio, k), contact(++other));
  }
  ConstraintSet closing;
  closing.add();
  closing[0].key = contact(0);
  const double now = 2.0 - std::pow(ratio, 7);
  EXPECT_TRUE(std::isnan(impacts.end(now)));
  EXPECT_NEAR(impacts.end(now, closing), 2.0, 1e-12);
  // Others that had as many at the same times.
  Accumulation together;
  for (Index i = 1; i <= 40; ++i) together.remember(0.01 * i, contact(1000 + i));
  together.take(impacts);
  EXPECT_NEAR(together.end(now, closing), 2.0, 1e-12);
}

}  // namespace
