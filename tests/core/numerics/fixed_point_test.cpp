// When is a fixed-point iteration finished?

#include <carom/core/numerics/fixed_point.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace {

using carom::FixedPointJudge;
using Verdict = FixedPointJudge::Verdict;

TEST(FixedPoint, EndsBelowTolerance) {
  FixedPointJudge judge(1e-6, 100);
  EXPECT_EQ(judge.judge(1e-2, 1.0), Verdict::go_on);
  EXPECT_EQ(judge.judge(1e-4, 1.0), Verdict::go_on);
  EXPECT_DOUBLE_EQ(judge.contraction(), 1e-2);
  EXPECT_EQ(judge.judge(1e-6, 1.0), Verdict::converged);
  EXPECT_EQ(judge.sweeps(), 3);
  EXPECT_EQ(judge.change(), 1e-6);
}

TEST(FixedPoint, AheadItAsksForWhatTheForgoneSweepWouldLeave) {
  FixedPointJudge judge(1e-6, 100);
  EXPECT_EQ(judge.judge_ahead(9e-7, 1.0), Verdict::go_on);      // no contraction seen: 1e-11 is asked for
  EXPECT_EQ(judge.judge_ahead(9e-8, 1.0), Verdict::converged);  // 0.1 seen: 1e-7
  EXPECT_EQ(FixedPointJudge(1e-6, 100).judge_ahead(1e-11, 1.0), Verdict::converged);
  FixedPointJudge growing(1e-6, 100);
  (void)growing.judge_ahead(1e-8, 1.0);
  EXPECT_EQ(growing.judge_ahead(1e-7, 1.0), Verdict::converged);  // never asks for more than the tolerance
}

TEST(FixedPoint, AtToleranceZeroGoesOnUntilTheChangeStopsShrinking) {
  FixedPointJudge judge(0.0, 1000);
  double change = 1.0;
  Verdict verdict = Verdict::go_on;
  while (verdict == Verdict::go_on) {
    verdict = judge.judge(change, 1.0);
    change = std::max(0.1 * change, 3e-16);  // rounding leaves a rest that no longer shrinks
  }
  EXPECT_EQ(verdict, Verdict::converged);
  EXPECT_EQ(judge.sweeps(), 18);  // 1, 1e-1, ..., 1e-15, 3e-16, 3e-16
  EXPECT_EQ(FixedPointJudge(0.0, 1000).judge(0.0, 1.0), Verdict::converged);
}

TEST(FixedPoint, RoundingIsMeasuredBySize) {
  // 1e-13 that no longer shrinks is rounding of numbers of size 1e3, but not of numbers of size 1.
  FixedPointJudge large(0.0, 10), small(0.0, 10);
  EXPECT_EQ(large.judge(1e-13, 1e3), Verdict::go_on);
  EXPECT_EQ(large.judge(1e-13, 1e3), Verdict::converged);
  EXPECT_EQ(small.judge(1e-13, 1.0), Verdict::go_on);
  EXPECT_EQ(small.judge(1e-13, 1.0), Verdict::go_on);
}

TEST(FixedPoint, ContractionIsNotReadFromRounding) {
  FixedPointJudge judge(0.0, 100);
  (void)judge.judge(1.0, 1.0);
  (void)judge.judge(0.1, 1.0);
  (void)judge.judge(1e-15, 1.0);  // below the floor of 64 eps
  EXPECT_DOUBLE_EQ(judge.contraction(), 0.1);
}

TEST(FixedPoint, FailsWhenSweepsAreUsedUp) {
  FixedPointJudge judge(1e-6, 3);
  EXPECT_EQ(judge.judge(1.0, 1.0), Verdict::go_on);
  EXPECT_EQ(judge.judge(0.9, 1.0), Verdict::go_on);
  EXPECT_EQ(judge.judge(0.81, 1.0), Verdict::failed);
}

TEST(FixedPoint, NumbersThatHaveGrownBeyondReasonAreNoAnswerWhereTheySettle) {
  FixedPointJudge lost(1e-6, 100), at_rest(1e-6, 100);
  for (int sweep = 0; sweep < 3; ++sweep) EXPECT_EQ(lost.judge(1e-2, 1.0), Verdict::go_on);
  EXPECT_EQ(lost.judge(0.0, 1e9), Verdict::failed);
  // Nothing is known of the size of what has not moved yet.
  for (int sweep = 0; sweep < 3; ++sweep) (void)at_rest.judge(0.0, 0.0);
  EXPECT_EQ(at_rest.judge(0.0, 1e9), Verdict::converged);
}

TEST(FixedPoint, FailsWhenItDiverges) {
  FixedPointJudge judge(1e-6, 1000000);
  double change = 1.0;
  Verdict verdict = Verdict::go_on;
  while (verdict == Verdict::go_on) verdict = judge.judge(change *= 2.0, 1.0);
  EXPECT_EQ(verdict, Verdict::failed);
  EXPECT_LE(judge.sweeps(), 40);  // long before it overflows
}

TEST(FixedPoint, FailsAtANumberThatIsNone) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    FixedPointJudge judge(1e-6, 100);
    EXPECT_EQ(judge.judge(bad, 1.0), Verdict::failed);
  }
  // A size that is none must not hide a change that is not small.
  FixedPointJudge judge(1e-6, 100);
  (void)judge.judge(1.0, 1.0);
  EXPECT_NE(judge.judge(1.0, std::numeric_limits<double>::quiet_NaN()), Verdict::converged);
}

}  // namespace
