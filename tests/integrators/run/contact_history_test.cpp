// Where sweeps over contacts start: from the impulses of the step before, or from those of rest.

#include <carom/integrators/run/contact_history.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace {

using carom::next_start;
using carom::SweepStart;

// One velocity that impulses P change by w (P - p) in a step, p those of rest. Impulses that miss p are kept
// for `kept` steps; then a step makes the velocity zero.
struct Drift {
  double w = 0.5, p = 3.0;  // [1/kg], [N s]
  double velocity = 0.0;    // [m/s]
  SweepStart start;

  void keep() {
    velocity += w * (start.impulse[0] - p);
    start = next_start(start, start.impulse);
  }
  void correct() {
    const double found = p - velocity / w;
    velocity = 0.0;
    start = next_start(start, {found, 0.25 * found});
  }
};

TEST(NextStart, IsThatOfRestAfterImpulsesThatWereKept) {
  for (const int kept : {1, 2, 5, 100}) {
    Drift drift{.start = {{3.0 + 1e-3, 0.25 * (3.0 + 1e-3)}, 0}};
    for (int step = 0; step < kept; ++step) drift.keep();
    EXPECT_EQ(drift.start.kept, kept);
    drift.correct();
    EXPECT_NEAR(drift.start.impulse[0], drift.p, 1e-14 * kept);  // rounding of the drift, and of its undoing
    EXPECT_NEAR(drift.start.impulse[1], 0.25 * drift.p, 1e-14 * kept);
    EXPECT_EQ(drift.start.kept, 0);
    drift.keep();
    EXPECT_NEAR(drift.velocity, 0.0, 1e-14 * kept);
  }
}

TEST(NextStart, IsTheAnswerWhereNothingWasKept) {
  EXPECT_EQ(next_start({{1.0, 0.5}, 0}, {2.0, -0.5}), (SweepStart{{2.0, -0.5}, 0}));
}

TEST(NextStart, LiesInTheConeBetweenTwoOfIt) {
  const SweepStart start = next_start({{1.0, 0.5}, 3}, {5.0, -2.5});
  EXPECT_EQ(start, (SweepStart{{2.0, -0.25}, 0}));
}

TEST(NextStart, CountsNoFartherThanAMillionSteps) {
  const SweepStart full{{1.0, 0.5}, SweepStart::most_kept};
  EXPECT_EQ(next_start(full, full.impulse), full);
}

TEST(NextStart, AnOpenContactKeepsNothing) {
  const SweepStart open = next_start({{0.0, 0.0}, 0}, {0.0, 0.0});
  EXPECT_EQ(open.kept, 0);
  EXPECT_EQ(next_start(open, {1.0, 0.5}), (SweepStart{{1.0, 0.5}, 0}));
  EXPECT_EQ(next_start({{1.0, 0.5}, 7}, {0.0, 0.0}), (SweepStart{{0.0, 0.0}, 0}));
}

}  // namespace
