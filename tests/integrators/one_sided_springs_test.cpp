// Cables and bumpers that are entered and left within long steps: the event-driven mode misses none. Random
// scenes are judged by time stepping, which looks at every spring in every one of its small steps.

#include "tests/integrators/one_sided_scenes.h"
#include "tests/shares.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <exception>
#include <numbers>
#include <string>
#include <vector>

namespace {

using namespace one_sided_scenes;

constexpr double gravity = 9.81;

/// Largest difference of the coordinates.
double difference(const State& a, const State& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.q.size(); ++i) largest = std::max(largest, std::abs(a.q[i] - b.q[i]));
  return largest;
}

/// Passages of the springs of a scene, as time stepping sees them.
class PassageCounter {
public:
  PassageCounter(const Scene& scene, Simulation& stepping) : scene_(&scene), sides_(scene.lines.size(), 0) {
    stepping.observe([this](const Simulation& now) { look(now.state()); });
  }
  /// A spring came out on the other side, by more than `depth`, between two times.
  struct Passage {
    std::size_t line;
    double after, before;
  };
  [[nodiscard]] const std::vector<Passage>& passages() const { return passages_; }
  static constexpr double depth = 1e-4;  // some 100 errors of the steps below [m]

private:
  void look(const State& state) {
    left_.resize(sides_.size(), state.time);
    for (std::size_t i = 0; i < sides_.size(); ++i) {
      const double excess = scene_->lines[i].excess(state);
      if (std::abs(excess) < depth) continue;
      const int side = excess > 0.0 ? 1 : -1;
      if (sides_[i] == -side) passages_.push_back({i, left_[i], state.time});
      sides_[i] = side;
      left_[i] = state.time;
    }
  }
  const Scene* scene_;
  std::vector<int> sides_;
  std::vector<double> left_;  // when a spring was last seen on its side
  std::vector<Passage> passages_;
};

/// A comparison: up to when, and where the modes differed first, empty if they did not.
struct Comparison {
  double compared = 0.0;  // [s]
  std::string difference;
};

/// Both modes from the same start. Steps h and h/2 say how exact time stepping is: errors fall by 4 in smooth
/// motion, by 2 where springs are passed at the worst place of a step, so that the error of h/2 is at most
/// their difference, but for chance. They are compared up to the time at which that difference is 1e-4 m, for
/// behind it motion amplifies everything.
Comparison compare(const Scene& scene, double end, double step) {
  constexpr double chance = 4.0, small = 1e-6, amplified = 1e-4;
  constexpr int looks = 24;
  Simulation events(scene.system, EventDriven{});
  Simulation coarse(scene.system, TimeStepping{.step = step});
  Simulation fine(scene.system, TimeStepping{.step = 0.5 * step});
  const PassageCounter counter(scene, fine);
  Comparison result;
  double largest = 0.0;
  for (int look = 1; look <= looks; ++look) {
    const double time = end * look / looks;
    for (Simulation* one : {&events, &coarse, &fine}) one->run_until(time);
    largest = std::max(largest, difference(coarse.state(), fine.state()));
    if (largest > amplified) break;
    const double off = difference(events.state(), fine.state());
    if (off > chance * largest + small && result.difference.empty()) {
      result.difference = "places differ by " + std::to_string(off) + " m at " + std::to_string(time) + " s";
    }
    result.compared = time;
  }
  // Every passage that time stepping saw is an event, at its time.
  const double late = 20.0 * step;
  for (const PassageCounter::Passage& passage : counter.passages()) {
    if (passage.before > result.compared) break;
    const bool found =
        std::any_of(events.events().begin(), events.events().end(), [&](const EventRecord& event) {
          return event.element == scene.lines[passage.line].element && event.time > passage.after - late &&
                 event.time < passage.before + late;
        });
    if (!found && result.difference.empty()) {
      result.difference = "no event of spring " + std::to_string(passage.line) + " at " +
                          std::to_string(passage.before) + " s";
    }
  }
  return result;
}

/// Chance (errors of h and h/2 that are equal) does not come back with other steps; an event that is missed
/// does. Returns up to when the modes were compared [s].
double expect_same_motion(const Scene& scene, double end) {
  constexpr double step = 2e-4, other = 0.23;
  constexpr int most = 3;
  Comparison result = compare(scene, end, step);
  for (int again = 1; again < most && !result.difference.empty(); ++again) {
    result = compare(scene, end, step * std::pow(other, again));
  }
  EXPECT_EQ(result.difference, "");
  return result.compared;
}

void compare_all(const carom_test::SeedRange& seeds, double end) {
  double sum = 0.0;
  for (std::uint64_t seed = seeds.first; seed < seeds.last; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    try {
      sum += expect_same_motion(random_scene(seed), end);
    } catch (const std::exception& error) {
      ADD_FAILURE() << error.what();
    }
  }
  // Motion that amplifies errors is rare: most of the time is compared.
  EXPECT_GT(sum, 0.7 * end * seeds.count());
}

class EveryMethod : public testing::TestWithParam<FlowMethod> {};

// A particle falls onto a bumper of 0.2 m about the origin and is thrown back; it was in and out again
// between the looks of one step of free flight.
TEST_P(EveryMethod, FindsABumperWithinOneStep) {
  constexpr double stiffness = 1000.0, reach = 0.2, height = 1.0, speed = 0.5;
  System system;
  system.add(Gravity{{0.0, -gravity}});
  const BodyId dot = system.add(Particle{.mass = 1.0, .position = {0.0, height}, .velocity = {0.0, -speed}});
  system.add(Bumper{.from = ground, .to = dot, .stiffness = stiffness, .free_length = reach});
  Simulation simulation(system, EventDriven{.method = GetParam()});
  simulation.run_until(1.0);
  // y'' = -g down to y = 0.2, then about its equilibrium y0 = 0.2 - g/k until it is at 0.2 again, as fast.
  const double in = (-speed + std::sqrt(speed * speed + 2.0 * gravity * (height - reach))) / gravity;
  const double fast = speed + gravity * in, omega = std::sqrt(stiffness);
  const double sag = gravity / stiffness;
  const double inside = 2.0 * (std::numbers::pi / 2.0 + std::atan(sag * omega / fast)) / omega;
  const double rest = 1.0 - in - inside;
  // A hundred steps, each off by 1e-9 of the largest numbers.
  EXPECT_NEAR(simulation.state().position(dot)[1], reach + fast * rest - 0.5 * gravity * rest * rest, 1e-7);
  ASSERT_EQ(simulation.events().size(), 2U);
  EXPECT_NEAR(simulation.events()[0].time, in, 1e-9);
  EXPECT_NEAR(simulation.events()[1].time, in + inside, 1e-8);
}

INSTANTIATE_TEST_SUITE_P(OneSidedSprings, EveryMethod,
                         testing::Values(FlowMethod::explicit_runge_kutta, FlowMethod::one_step,
                                         FlowMethod::adams, FlowMethod::bdf));

// A particle that flies past a bumper's reach touches it or does not: by 1e-8 m, on a path of 10 m.
TEST(OneSidedSprings, GrazeIsFoundToTheDepthOfTheTolerance) {
  for (const double depth : {1e-4, 1e-8, 1e-10, -1e-10, -1e-8, -1e-4}) {
    System system;
    const BodyId dot = system.add(Particle{.mass = 1.0, .position = {-3.7, 0.5}, .velocity = {10.0, 0.0}});
    system.add(Bumper{.from = ground, .to = dot, .stiffness = 10.0, .free_length = 0.5 + depth});
    Simulation simulation(system, EventDriven{});
    simulation.run_until(1.0);
    EXPECT_EQ(simulation.events().size(), depth > 0.0 ? 2U : 0U) << depth;
  }
}

// Straight through the bumper's point: entered, turned through zero length, left.
TEST(OneSidedSprings, EndsPassThroughEachOther) {
  System system;
  const BodyId dot = system.add(Particle{.mass = 1.0, .position = {0.0, 1.0}, .velocity = {1e-3, -40.0}});
  system.add(Bumper{.from = ground, .to = dot, .stiffness = 1000.0, .free_length = 0.2});
  Simulation simulation(system, EventDriven{});
  simulation.run_until(0.5);
  ASSERT_EQ(simulation.events().size(), 2U);
  EXPECT_NEAR(simulation.events()[0].time, 0.8 / 40.0, 1e-6);
  EXPECT_LT(simulation.state().position(dot)[1], -10.0);
  EXPECT_NEAR(simulation.energy().residual(), 0.0, 1e-6);
}

// A bar of 1 m that turns at 300 rad/s in free flight, 48 times within a step: its end stretches a
// cable by 1 mm once in each.
TEST(OneSidedSprings, TurningIsBoundedOverAnyStep) {
  System system;
  const BodyId bar = system.add(RigidBody{.mass = rod(1.0, 1.0), .angle = 1.0, .spin = 300.0});
  system.add(
      Cable{.from = {ground, {1.0, 0.0}}, .to = {bar, {0.5, 0.0}}, .stiffness = 1e-9, .free_length = 1.499});
  Simulation simulation(system, EventDriven{});
  simulation.run_until(1.0);
  // Taut about the angles pi + 2 pi n between 1 and 301 rad, n up to 47: in and out.
  EXPECT_EQ(simulation.events().size(), 2U * 48U);
}

// Particles at the free length of the bumpers between them, to rounding: nothing enters or leaves.
TEST(OneSidedSprings, AtRestOnTheirSwitchingPointsMakeNoEvents) {
  for (const double scale : {0.01, 1.0, 100.0}) {
    System system;
    std::vector<BodyId> bodies;
    for (int i = 0; i < 5; ++i)
      bodies.push_back(system.add(Particle{.mass = 1.0, .position = {0.2 * scale * i, 0.0}}));
    for (std::size_t i = 0; i < 4; ++i) {
      system.add(
          Bumper{.from = bodies[i], .to = bodies[i + 1], .stiffness = 1000.0, .free_length = 0.2 * scale});
    }
    Simulation simulation(system, EventDriven{});
    simulation.run_until(10.0);
    EXPECT_TRUE(simulation.events().empty());
  }
}

// More events than event_limit, in a model where nothing touches: the error names the spring.
TEST(OneSidedSprings, TooManyEventsNameTheSpring) {
  System system;
  const BodyId dot = system.add(Particle{.mass = 1.0, .position = {0.0, 0.5}, .velocity = {0.0, 1.0}});
  system.add(Bumper{.from = ground, .to = dot, .stiffness = 1e4, .free_length = 0.4}, "below");
  system.add(Bumper{.from = {ground, {0.0, 1.0}}, .to = dot, .stiffness = 1e4, .free_length = 0.4});
  Simulation simulation(system, EventDriven{.event_limit = 1.0});
  try {
    simulation.run_until(1e3);
    ADD_FAILURE() << "not refused";
  } catch (const SolverError& error) {
    const std::string what = error.what();
    EXPECT_NE(what.find("event_limit"), std::string::npos) << what;
    EXPECT_NE(what.find("bumper"), std::string::npos) << what;
    ASSERT_EQ(error.failure().parts.size(), 1U);
    EXPECT_NE(error.failure().parts.front().find("bumper"), std::string::npos);
    // With the limit that it names as allowed the run goes on for as long again.
    const std::size_t at = what.find("allowed: ");
    ASSERT_NE(at, std::string::npos) << what;
    Simulation longer(system, EventDriven{.event_limit = std::stod(what.substr(at + 9))});
    EXPECT_NO_THROW(longer.run_until(2.0 * error.failure().time + 1.0)) << what;
  }
}

// A net of cables between two held corners falls from above until it hangs and swings.
TEST(OneSidedSprings, NetFallsAlikeInBothModes) {
  constexpr int wide = 5, high = 3;
  constexpr double cell = 0.2;
  Scene scene;
  scene.system.add(Gravity{{0.0, -gravity}});
  std::vector<BodyId> knots;
  for (int j = 0; j < high; ++j) {
    for (int i = 0; i < wide; ++i) {
      // Not quite symmetric, a little slack.
      knots.push_back(scene.system.add(Particle{
          .mass = 0.1,
          .position = {0.93 * cell * i + 0.01 * j, -0.9 * cell * j + 0.02 * ((i * 7 + j * 3) % 5)}}));
    }
  }
  const auto tie = [&](const End<2>& from, const End<2>& to) {
    add_line(scene, true, from, to, 500.0, 0.5, cell);
  };
  for (int j = 0; j < high; ++j) {
    for (int i = 0; i < wide; ++i) {
      const BodyId knot = knots[static_cast<std::size_t>(j * wide + i)];
      if (i + 1 < wide) tie(knot, knots[static_cast<std::size_t>(j * wide + i + 1)]);
      if (j + 1 < high) tie(knot, knots[static_cast<std::size_t>((j + 1) * wide + i)]);
    }
  }
  tie({ground, {-0.05, 0.15}}, knots.front());
  tie({ground, {0.85, 0.15}}, knots[wide - 1]);
  EXPECT_GT(expect_same_motion(scene, 0.5), 0.4);
}

TEST(OneSidedSprings, RandomScenesAgreeInBothModes) { compare_all({0, 6}, 0.5); }

// Steps whose interpolation, or a stage without weight, was alone in meeting the spring of a scene.
TEST(OneSidedSprings, StepsThatLeapOverSpringsAreMadeAnew) {
  for (const std::uint64_t seed : {std::uint64_t{555}, std::uint64_t{9855}})
    compare_all({seed, seed + 1}, 0.5);
}

// All seeds (shares.h) take some ten minutes.
TEST(OneSidedSpringsLong, RandomScenesAgreeInBothModes) {
  compare_all(carom_test::seeds_from(6, 394, 9994), 0.5);
}

}  // namespace
