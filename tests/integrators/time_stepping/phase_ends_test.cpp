// Ends of phases: a gap that is known where phases have ended only, and may jump.

#include <carom/integrators/time_stepping/phase_ends.h>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace {

using namespace carom;

constexpr double rounding = 1e-12;  // gap at which a contact takes part [m]

/// Heads for a closing from 0 to 1 s. \param gap over the end of the phase \param rate that is seen there
/// Returns the end at which a phase stays; -1 if none does in 100 tries. \param tries out
double end_of(const std::function<double(double)>& gap, const std::function<double(double)>& rate,
              double first, int& tries) {
  PhaseEnds ends(0.0, 1.0);
  StepClosing found;
  found.deep = -rounding;
  double end = ends.between(first);
  for (tries = 1; tries <= 100; ++tries) {
    found.gap = gap(end);
    found.rate = rate(end);
    const bool is_late = found.gap < found.deep && found.rate < 0.0;
    ends.take({{}, end, found.gap, found.rate}, end, is_late);
    const bool is_near = ends.are_as_near_as_can_be(found);
    if (is_near && is_late) return end;
    if (!is_late && found.is_reached()) return end;
    end = is_near ? ends.closed() : ends.next(found, found.time_by_rate(end));
  }
  return -1.0;
}

TEST(PhaseEnds, ReachTheRootOfAGapInFewTries) {
  // A fall of 4 m/s^2 from 0.5 m, reached at 0.5 s.
  const auto gap = [](double t) { return 0.5 - 2.0 * t * t; };
  const auto rate = [](double t) { return -4.0 * t; };
  int tries = 0;
  EXPECT_NEAR(end_of(gap, rate, 0.45, tries), 0.5, rounding);
  EXPECT_LE(tries, 5);
}

TEST(PhaseEnds, SecantsMakeUpForRatesThatAreWrong) {
  const auto gap = [](double t) { return 0.5 - t - 0.3 * t * t; };
  int tries = 0;
  // Newton's method alone would lead to and fro, or by a factor of ten in each try.
  for (const double wrong : {0.4, 0.9, 3.0}) {
    const auto rate = [&](double t) { return -wrong * (1.0 + 0.6 * t); };
    const double end = end_of(gap, rate, 0.3, tries);
    EXPECT_NEAR(gap(end), 0.0, rounding) << wrong;
    EXPECT_LE(tries, 9) << wrong;
  }
}

TEST(PhaseEnds, OfAGapThatJumpsEndBehindTheJump) {
  for (const double jump : {1e-9, 1e-7, 1e-5}) {
    const auto gap = [&](double t) { return 1e-4 * (0.6257 - t) + (t < 0.6257 ? 0.3 : -0.7) * jump; };
    const auto rate = [](double) { return -1e-4; };
    int tries = 0;
    const double end = end_of(gap, rate, 0.9, tries);
    EXPECT_GE(end, 0.6257) << jump;
    // Not deeper than the jump, but for a tenth of it.
    EXPECT_GT(gap(end), -0.81 * jump) << jump;
    EXPECT_LE(tries, 30) << jump;
  }
}

TEST(PhaseEnds, OfAGapThatIsClosedAllTheTimeAreNotHalvedForEver) {
  // It grows before a jump, and falls behind it.
  const auto gap = [](double t) { return t < 0.665 ? -1.5e-7 : -2.9e-7; };
  const auto rate = [](double t) { return t < 0.665 ? 1.5e-4 : -5.7e-5; };
  int tries = 0;
  const double end = end_of(gap, rate, 0.67, tries);
  EXPECT_GE(end, 0.665);
  EXPECT_LE(tries, 5);
}

TEST(PhaseEnds, ThatAreClosedButMuchDeeperLaterGoOn) {
  // Open to rounding, then a closing of its own at 0.5 s.
  const auto gap = [](double t) { return t < 0.5 ? -1e-13 + t * (0.5 - t) : 2.0 * (0.5 - t); };
  const auto rate = [](double t) { return t < 0.5 ? 0.5 - 2.0 * t : -2.0; };
  int tries = 0;
  const double end = end_of(gap, rate, 0.8, tries);
  EXPECT_NEAR(end, 0.5, rounding);
  EXPECT_LE(tries, 60);
}

}  // namespace
