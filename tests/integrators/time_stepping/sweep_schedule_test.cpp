// The order of stages and blocks: staged and streamed sweeps give the same bits, two fused ones the same to
// rounding; threads change nothing.

#include <carom/carom.h>
#include <carom/core/assembly.h>
#include <carom/integrators/time_stepping/step_batches.h>
#include <carom/integrators/time_stepping/step_constraints.h>
#include <carom/integrators/time_stepping/sweep_schedule.h>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

/// A net of particles, of several blocks and runs, whose lowest row touches the floor.
System net() {
  constexpr int columns = 60, rows = 60;
  System system;
  system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.4, .normal_restitution = 0.3});
  system.add(Gravity{.acceleration = {0.0, -9.81}});
  std::vector<BodyId> bodies;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const double x = 0.1 * column + 0.003 * std::sin(1.3 * row), y = 0.1 * row - (row == 0 ? 1e-4 : 0.0);
      bodies.push_back(system.add(Particle{.mass = 0.1 + 0.01 * (column % 3),
                                           .position = {x, y},
                                           .velocity = {0.2 * std::cos(0.7 * column), -0.5},
                                           .contact = true}));
    }
  }
  const auto tie = [&](int a, int b) {
    system.add(SpringDamper{.from = bodies[static_cast<std::size_t>(a)],
                            .to = bodies[static_cast<std::size_t>(b)],
                            .stiffness = 300.0,
                            .damping = 0.1});
  };
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const int at = row * columns + column;
      if (column + 1 < columns) tie(at, at + 1);
      if (row + 1 < rows) tie(at, at + columns);
    }
  }
  return system;
}

/// A step of the net that begins at rest of its history.
class Sweeps {
public:
  explicit Sweeps(int threads = 1)
      : assembly_(net()),
        options_{.step = 1e-3, .threads = threads},
        constraints_(assembly_, options_),
        contacts_(assembly_, {}),
        trial_(assembly_, step_needs(assembly_, constraints_.detector(), false)),
        batches_(assembly_, options_, trial_.needs.load_rotations),
        schedule_(assembly_, options_, batches_.any_iterated()),
        state_(assembly_.initial_state()) {
    const std::size_t size = state_.v.size();
    companion_.rounding.assign(size, 0.0F);
    companion_.loads.total.assign(size, 0.0);
    companion_.loads.dissipative.assign(size, 0.0);
    Evaluation evaluation = make_evaluation(assembly_);
    evaluate_loads(
        assembly_, 0, state_.view(), evaluation,
        {companion_.loads.total.data(), companion_.loads.dissipative.data(), companion_.loads.total.data()});
    for (std::size_t i = 0; i < size; ++i) companion_.loads.total[i] += companion_.loads.dissipative[i];
    trial_.begin(in_, companion_.history);
    constraints_.find(in_, batches_.all(), trial_);
    contacts_.state_problems(in_, constraints_.islands().front(), false, trial_);
  }
  [[nodiscard]] SweepStages stages() { return {in_, rule_, 0, contacts_, trial_}; }
  void stream(bool guessing) { schedule_.stream(stages(), guessing, LoadsKnown::by_cause); }
  void stage(bool guessing) {
    if (guessing) schedule_.guess(stages());
    ASSERT_EQ(contacts_.solve(in_, rule_, trial_), nullptr);
    schedule_.move(stages());
    schedule_.evaluate(stages(), LoadsKnown::by_cause, true);
  }

  Assembly assembly_;
  TimeStepping options_;
  StepConstraints constraints_;
  ContactStage contacts_;
  StepRule rule_{ForceRule::trapezoidal};
  StepTrial trial_;
  StepBatches batches_;
  SweepSchedule schedule_;
  State state_;
  Companion companion_;
  StepInput in_{assembly_, state_, companion_, 1e-3, 1e-3};
};

void expect_same_bits(Sweeps& a, Sweeps& b) {
  EXPECT_EQ(a.trial_.end.q, b.trial_.end.q);
  EXPECT_EQ(a.trial_.end.v, b.trial_.end.v);
  EXPECT_EQ(a.trial_.rounding, b.trial_.rounding);
  EXPECT_EQ(a.trial_.loads_end.total, b.trial_.loads_end.total);
  EXPECT_EQ(a.trial_.loads_end.dissipative, b.trial_.loads_end.dissipative);
  EXPECT_EQ(a.trial_.account.potentials.values, b.trial_.account.potentials.values);
  EXPECT_EQ(a.schedule_.change(a.stages()).change, b.schedule_.change(b.stages()).change);
}

TEST(SweepSchedule, StagedAndStreamedSweepsGiveTheSameBits) {
  Sweeps streamed, staged;
  ASSERT_GT(streamed.stages().blocks().size(), 4u);
  ASSERT_GT(streamed.contacts_.problems().size(), 10u);
  ASSERT_TRUE(streamed.contacts_.by_block());
  streamed.stream(true);
  staged.stage(true);
  expect_same_bits(streamed, staged);
  for (Sweeps* const each : {&streamed, &staged}) each->schedule_.improve(each->stages());
  streamed.stream(false);
  staged.stage(false);
  expect_same_bits(streamed, staged);
}

TEST(SweepSchedule, ThreadsChangeNothing) {
  if (!Workers::several_available()) GTEST_SKIP() << "the library was built without threads";
  Sweeps one, two(2);
  one.stream(true);
  two.stream(true);
  expect_same_bits(one, two);
}

TEST(SweepSchedule, TwoFusedSweepsAreTheSameToRounding) {
  Sweeps streamed, fused;
  streamed.stream(true);
  const double earlier = streamed.schedule_.change(streamed.stages()).change;
  streamed.schedule_.improve(streamed.stages());
  streamed.stream(false);
  fused.schedule_.fuse(fused.stages(), true);
  // Sums of the loads of four springs in another order: a few roundings of forces of some 10 N.
  EXPECT_NEAR(fused.schedule_.earlier_change(fused.stages()).change, earlier, 1e-15);
  for (std::size_t i = 0; i < streamed.trial_.end.q.size(); ++i) {
    ASSERT_NEAR(fused.trial_.end.q[i], streamed.trial_.end.q[i], 1e-14);
    ASSERT_NEAR(fused.trial_.loads_end.total[i], streamed.trial_.loads_end.total[i], 1e-11);
  }
}

}  // namespace
