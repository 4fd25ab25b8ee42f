// History of joints over the last steps: a ring of steps of one length, by which the next is guessed.

#include <carom/integrators/run/joint_history.h>

#include <gtest/gtest.h>

#include <vector>

namespace {

using namespace carom;

constexpr double step = 0.25;
constexpr Index component = 1;

/// Numbers of two rows in step n: of degree 5 and 1.
std::vector<double> course(int n) { return {1.0 * n * n * n * n * n, 4.0 - 2.0 * n}; }

TEST(StepCourse, GuessesByTheStepsThatAreRemembered) {
  constexpr int needed = 6;  // by degree 5
  for (const int depth : {needed, needed + 2, static_cast<int>(most_extrapolated)}) {
    const auto steps = static_cast<std::size_t>(depth);
    StepCourse numbers(steps);
    EXPECT_EQ(numbers.depth(), steps);
    for (int n = 0; n <= depth + 3; ++n) {
      numbers.go_on(2);
      numbers.record({0, 2}, course(n).data());
      EXPECT_EQ(numbers.numbers(0), course(n));
      std::vector<double> guess(2);
      if (n >= 1) {
        numbers.guess({0, 2}, 2, guess.data());
        EXPECT_EQ(guess[0], 2.0 * course(n)[0] - course(n - 1)[0]);
        EXPECT_EQ(guess[1], course(n + 1)[1]);
      }
      if (n + 1 < depth) continue;
      EXPECT_EQ(numbers.numbers(steps - 1), course(n + 1 - depth));
      for (std::size_t followed = needed; followed <= steps + 1; ++followed) {  // no more than there are
        numbers.guess({0, 2}, followed, guess.data());
        EXPECT_EQ(guess, course(n + 1)) << n << ", " << followed << " of " << depth;
      }
    }
  }
}

TEST(StepCourse, TellsHowManyStepsGuessBest) {
  StepCourse numbers(8), fewer(4);
  const std::vector<double> weight{1.0, 1.0};
  for (int n = 0; n < 8; ++n) {
    for (StepCourse* const all : {&numbers, &fewer}) {
      all->go_on(2);
      all->record({0, 2}, course(n).data());
    }
  }
  EXPECT_EQ(numbers.best_steps({0, 2}, 8, weight.data()), 6U) << "of degree 5";
  EXPECT_EQ(numbers.best_steps({1, 2}, 8, weight.data()), 2U) << "a line";
  EXPECT_EQ(fewer.best_steps({0, 2}, 8, weight.data()), 3U) << "no more are remembered and can be judged";
}

TEST(StepCourse, OfAnotherSizeBeginsAnew) {
  StepCourse numbers(most_extrapolated);
  numbers.go_on(2);
  numbers.record({0, 2}, course(3).data());
  numbers.go_on(3);
  for (std::size_t ago = 0; ago < most_extrapolated; ++ago) {
    EXPECT_EQ(numbers.numbers(ago), std::vector<double>(3, 0.0));
  }
}

TEST(JointHistory, IsOfStepsOfOneLength) {
  JointHistory history;
  EXPECT_EQ(history.usable(component, 2, step), 0);
  for (int n = 1; n <= 3; ++n) {
    history.go_on(step, 2, 2, 3);
    history.known[component] = n;
    EXPECT_EQ(history.usable(component, 2, step), n);
    EXPECT_EQ(history.usable(0, 2, step), 0) << "not recorded";
    EXPECT_EQ(history.usable(component, 2, 2.0 * step), 0) << "of another length";
    EXPECT_EQ(history.usable(component, 3, step), 0) << "more rows than it has";
    EXPECT_EQ(history.usable(2, 2, step), 0) << "more components than it has";
  }
  history.go_on(2.0 * step, 2, 2, 3);
  EXPECT_EQ(history.usable(component, 2, 2.0 * step), 0) << "nothing is recorded yet";
  history.known[component] = 1;
  EXPECT_EQ(history.usable(component, 2, 2.0 * step), 1);
  history.clear();
  EXPECT_EQ(history.usable(component, 2, 2.0 * step), 0);
}

}  // namespace
