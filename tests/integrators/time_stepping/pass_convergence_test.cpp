// When passes over a step have converged: on made-up ends of passes.

#include <carom/carom.h>
#include <carom/core/assembly.h>
#include <carom/integrators/time_stepping/pass_convergence.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

/// One disc of radius 1 m, whose velocity along x is that of the passes. Its length scale is 1 for that.
System one_disc() {
  System system;
  const BodyId body = system.add(RigidBody{.mass = disc(1.0, 1.0)});
  system.add(Disc{.body = body, .radius = 1.0});
  return system;
}

class PassConvergence : public testing::Test {
protected:
  PassConvergence() : trial_(assembly_, StepNeeds{}), passes_(assembly_) { passes_.begin(); }

  /// The next pass ends at a velocity.
  bool ends_at(double velocity, double tolerance, double residual = 0.0) {
    trial_.end.v[0] = velocity;
    return passes_.has_converged(trial_, tolerance, residual);
  }

  const System system_ = one_disc();
  const Assembly assembly_{system_};
  StepTrial trial_;
  carom::PassConvergence passes_;
};

TEST_F(PassConvergence, EndsWhereWhatIsLeftIsBelowTheTolerance) {
  // v_k = 1 + 0.01^k: changes shrink by a hundred, and 1e-2 of the last one, over 1 - 0.01, is left.
  constexpr double tolerance = 1e-9;
  int made = 0;
  double velocity = 0.0;
  for (bool ends = false; !ends; ++made) {
    velocity = 1.0 + std::pow(0.01, made);
    ends = ends_at(velocity, tolerance);
  }
  EXPECT_LE(velocity - 1.0, tolerance);
  EXPECT_GT(100.0 * (velocity - 1.0), tolerance);  // the pass before was not as near
  EXPECT_EQ(made, 6);
}

TEST_F(PassConvergence, TakesTheLargestRatioOfChangesThatItHasSeen) {
  // Ratios 0.5, then 1e-3: after the third change 1e-3 of it seems to be left, but a half may be.
  EXPECT_FALSE(ends_at(0.0, 1e-4));
  EXPECT_FALSE(ends_at(1.0, 1e-4));
  EXPECT_FALSE(ends_at(1.5, 1e-4));
  EXPECT_FALSE(ends_at(1.5005, 1e-4));
  EXPECT_TRUE(ends_at(1.50055, 1e-4));
}

TEST_F(PassConvergence, OneChangeAloneSaysNothingOfTheNext) {
  EXPECT_FALSE(ends_at(0.0, 1e-6));
  EXPECT_FALSE(ends_at(2e-6, 1e-6));  // above the tolerance: it may be the first of many
  passes_.begin();
  EXPECT_FALSE(ends_at(0.0, 1e-6));
  EXPECT_TRUE(ends_at(0.9e-6, 1e-6));
}

TEST_F(PassConvergence, EndsWhereChangesGrowOrAreErrorsOfTheAnswers) {
  EXPECT_FALSE(ends_at(1.0, 0.0));
  EXPECT_FALSE(ends_at(2.0, 0.0));
  EXPECT_TRUE(ends_at(3.5, 0.0));
  passes_.begin();
  EXPECT_FALSE(ends_at(1.0, 0.0, 1e-3));
  EXPECT_TRUE(ends_at(1.0 + 0.9e-3, 0.0, 1e-3));
}

TEST_F(PassConvergence, EndsAtRoundingWithoutATolerance) {
  int made = 0;
  while (!ends_at(1.0 + std::pow(0.01, made), 0.0)) ++made;
  EXPECT_EQ(made, 8);  // a change of 1e-12 is none of rounding, one of 1e-14 is
  EXPECT_NEAR(passes_.noise(), 1e-14, 1e-16);
}

TEST_F(PassConvergence, GivesUpAfterTwentyPasses) {
  double velocity = 0.0, change = 1.0;
  int made = 0;
  for (; !ends_at(velocity, 0.0); ++made) velocity += change *= 0.99;
  EXPECT_EQ(made, 20);
  EXPECT_EQ(passes_.passes(), 20);
}

/// A disc rolls down on another one that turns in a bearing: its normal turns in every step.
System rolling() {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.set_default_law({.friction = 0.5, .normal_restitution = 0.0});
  const BodyId below = system.add(RigidBody{.mass = disc(4.0, 0.5)});
  system.add(Disc{.body = below, .radius = 0.5});
  system.add(Revolute{.from = ground, .to = below});
  const BodyId above =
      system.add(RigidBody{.mass = disc(1.0, 0.2), .position = {0.7 * std::sin(0.1), 0.7 * std::cos(0.1)}});
  system.add(Disc{.body = above, .radius = 0.2});
  return system;
}

// A looser tolerance takes fewer passes, and moves the end by no more than the steps' tolerances together,
// times what the motion makes of a deviation: exp(t sqrt(g / 0.7 m)) of a disc that rolls off another one.
TEST(PassesOfSteps, AreAsExactAsTheTolerance) {
  constexpr double end = 0.5, step = 1e-3;
  const auto run = [&](double tolerance, std::int64_t& made) {
    TimeStepping options{.step = step, .tolerance = tolerance};
    options.impacts = ImpactTimes::located;
    Simulation simulation(rolling(), options);
    while (simulation.time() < end - 0.5 * step) made += simulation.step().steps_made;
    return simulation.state().q;
  };
  std::int64_t to_rounding = 0, usual = 0, loose = 0;
  const std::vector<double> exact = run(0.0, to_rounding), near = run(1e-12, usual), far = run(1e-9, loose);
  EXPECT_LT(usual, to_rounding);
  EXPECT_LT(loose, usual);
  const double grows = std::exp(end * std::sqrt(9.81 / 0.7)) * end / step;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    EXPECT_NEAR(near[i], exact[i], 1e-12 * grows);
    EXPECT_NEAR(far[i], exact[i], 1e-9 * grows);
  }
}

}  // namespace
