#include <carom/joints/gravity.h>
#include <carom/joints/one_sided_spring.h>
#include <carom/testing/loaded_model.h>

#include "tests/joints/element_pairs.h"
#include "tests/model_error.h"

#include <numbers>

namespace {

using namespace carom;
using namespace carom::planar;
using namespace carom_test;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// A dot at x, moving with v along x; the other end is the origin.
System on_a_line(double x, double v, BodyId& dot) {
  System system;
  dot = system.add(Particle{.mass = 1.0, .position = {x, 0}, .velocity = {v, 0}}, "dot");
  return system;
}

// Loads on the dot: of the spring, of the dashpot; the potential.
template <class Part>
std::array<double, 3> at(double x, double v, double damping) {
  BodyId dot;
  System system = on_a_line(x, v, dot);
  system.add(Part{.from = ground, .to = dot, .stiffness = 10.0, .damping = damping, .free_length = 2.0});
  LoadedModel model(system);
  return {model.conservative[0], model.dissipative[0], model.energies()[StoredEnergy::elastic]};
}

TEST(OneSidedSpring, ACablePullsOrIsSlack) {
  using Numbers = std::array<double, 3>;
  EXPECT_EQ((at<Cable>(1.5, 3.0, 4.0)), (Numbers{0, 0, 0}));
  EXPECT_EQ((at<Cable>(2.0, 3.0, 4.0)), (Numbers{0, 0, 0}));
  EXPECT_EQ((at<Cable>(2.5, 0.5, 4.0)), (Numbers{-5, -2, 1.25}));
  EXPECT_EQ((at<Cable>(2.5, -0.5, 4.0)), (Numbers{-5, 2, 1.25}));
  EXPECT_EQ((at<Cable>(2.5, -3.0, 4.0)), (Numbers{-5, 5, 1.25}));  // would push
  EXPECT_EQ((at<Cable>(2.5, 3.0, 4.0)), (Numbers{-5, -5, 1.25}));  // at most the spring again
}

TEST(OneSidedSpring, ABumperPushesOrIsApart) {
  using Numbers = std::array<double, 3>;
  EXPECT_EQ((at<Bumper>(2.5, -3.0, 4.0)), (Numbers{0, 0, 0}));
  EXPECT_EQ((at<Bumper>(1.5, -0.5, 4.0)), (Numbers{5, 2, 1.25}));
  EXPECT_EQ((at<Bumper>(1.5, 0.5, 4.0)), (Numbers{5, -2, 1.25}));
  EXPECT_EQ((at<Bumper>(1.5, 3.0, 4.0)), (Numbers{5, -5, 1.25}));  // would pull
  EXPECT_EQ((at<Bumper>(1.5, -3.0, 4.0)), (Numbers{5, 5, 1.25}));
}

template <class Part>
void check_laws(std::uint64_t seed) {
  Random random(seed);
  int slack = 0, clipped = 0;
  for (int repeat = 0; repeat < 40; ++repeat) {
    const Bodies bodies(random);
    for (const auto& [from, to] : pairs_of_ends(bodies, random)) {
      System system = bodies.system;
      system.add(Part{.from = from,
                      .to = to,
                      .stiffness = random.uniform(0.5, 5.0),
                      .damping = random.uniform(0.0, 5.0),
                      .free_length = random.uniform(1.0, 5.0)});
      LoadedModel model(system);
      // Differences across the edge of slackness are wrong by the stiffness times their step.
      const double margin = model.energies().potential() < 1e-4 ? 1e-2 : 1e-9;
      expect_near(model.conservative, model.minus_gradient(), margin);
      EXPECT_LE(model.power(model.dissipative), 0.0);
      EXPECT_LE(largest(model.dissipative), largest(model.conservative) * (1.0 + 1e-12));
      if (from.body != ground && to.body != ground) expect_action_is_reaction(model);
      slack += largest(model.conservative) == 0.0;
      clipped += largest(model.dissipative) >= largest(model.conservative) * (1.0 - 1e-12);
    }
  }
  EXPECT_GT(slack, 20);
  EXPECT_GT(clipped, slack + 20);
  EXPECT_LT(clipped, 240);
}

TEST(OneSidedSpring, ACableObeysTheLawsOfElements) { check_laws<Cable>(201); }
TEST(OneSidedSpring, ABumperObeysTheLawsOfElements) { check_laws<Bumper>(202); }

TEST(OneSidedSpring, InSpace) {
  System system;
  const BodyId a = system.add(spatial::Particle{.mass = 1.0, .position = {0, 0, 0}});
  const BodyId b = system.add(spatial::Particle{.mass = 1.0, .position = {2, 4, 4}, .velocity = {1, 2, 2}});
  system.add(spatial::Cable{.from = a, .to = b, .stiffness = 3.0, .damping = 0.5, .free_length = 5.0});
  system.add(spatial::Bumper{.from = a, .to = b, .stiffness = 6.0, .damping = 0.5, .free_length = 7.0});
  LoadedModel model(system);
  // Length 6, rate 3: the cable pulls 3 N and 1.5 N, the bumper pushes 6 N less 1.5 N.
  expect_near(model.conservative, {-1, -2, -2, 1, 2, 2}, 1e-14);
  expect_near(model.dissipative, {1, 2, 2, -1, -2, -2}, 1e-14);
  expect_near(model.conservative, model.minus_gradient(), 1e-10);
}

TEST(OneSidedSpring, OneHalfWaveOnABumper) {
  // A mass meets an undamped bumper at 1 m/s, stays for half a period and leaves as fast as it came.
  BodyId dot;
  System system = on_a_line(2.1, -1.0, dot);
  system.add(Bumper{.from = ground, .to = dot, .stiffness = 400.0, .free_length = 2.0});
  const double after = 0.1 + std::numbers::pi / 20.0 + 0.2;
  const double order = measured_order(system, after, 4e-3, [&](const Simulation& now) {
    return std::abs(now.state().position(dot)[0] - 2.2);
  });
  EXPECT_GT(order, 1.6);  // the kink of the force at the ends of the contact costs some of the order
  Simulation simulation(system, TimeStepping{.step = 1e-3});
  simulation.run_until(after);
  EXPECT_NEAR(simulation.state().position(dot)[0], 2.2, 1e-3);
  EXPECT_NEAR(simulation.energy().kinetic(), 0.5, 1e-3);
}

TEST(OneSidedSpring, RunsCloseTheirAccount) {
  // A ball on a bumper and under a cable: it falls, bounces, is caught.
  System system;
  system.add(Gravity{{0, -9.81}});
  const BodyId ball = system.add(Particle{.mass = 1.0, .position = {0, 2.5}, .velocity = {0, 3}});
  system.add(Cable{.from = ground, .to = ball, .stiffness = 300.0, .damping = 5.0, .free_length = 2.6});
  system.add(Bumper{.from = ground, .to = ball, .stiffness = 500.0, .damping = 5.0, .free_length = 1.0});
  expect_ledger_closes(system, 4.0);
  Simulation simulation(system, TimeStepping{.step = 1e-3});
  double lost = 0.0;
  simulation.observe([&](const Simulation& now) {
    EXPECT_GE(now.energy().flow(EnergyFlow::dashpot), lost * (1.0 - 1e-12));
    lost = now.energy().flow(EnergyFlow::dashpot);
  });
  simulation.run_until(4.0);
  EXPECT_GT(lost, 1.0);
}

TEST(OneSidedSpring, EveryWayToGoTautHasAnImplicitStep) {
  // Strong dashpots, met at all phases of the grid: with a jump of the force some of these steps would have
  // no solution, and the iteration would not end.
  for (int i = 0; i < 1000; ++i) {
    BodyId dot;
    System system = on_a_line(2.0 + 1e-5 * i, -1.0, dot);
    system.add(Bumper{.from = ground, .to = dot, .stiffness = 400.0, .damping = 100.0, .free_length = 2.0});
    Simulation simulation(system, TimeStepping{.step = 1e-3});
    ASSERT_NO_THROW(simulation.run_until(0.02)) << i;
  }
}

template <class Part>
void check_refusals(const std::string& part) {
  BodyId dot;
  System system = on_a_line(1.0, 0.0, dot);
  const auto made = [&](double k, double c, double l) {
    return Part{.from = ground, .to = dot, .stiffness = k, .damping = c, .free_length = l};
  };
  EXPECT_MODEL_ERROR(system.add(Part{.to = dot}), part + " #0", "from is not given");
  EXPECT_MODEL_ERROR(system.add(Part{.from = dot, .to = dot}), part + " #0", "as from");
  EXPECT_MODEL_ERROR(system.add(made(-1, 0, 1), "rope"), part + " 'rope'", "stiffness is -1 N/m", "> 0");
  EXPECT_MODEL_ERROR(system.add(made(0, 0, 1)), part + " #0", "stiffness is 0 N/m");
  EXPECT_MODEL_ERROR(system.add(made(nan, 0, 1)), part + " #0", "stiffness is nan N/m");
  EXPECT_MODEL_ERROR(system.add(made(1, -2, 1)), part + " #0", "damping is -2 N s/m");
  EXPECT_MODEL_ERROR(system.add(made(1, 0, -3)), part + " #0", "free_length is -3 m");
  EXPECT_TRUE(system.elements().empty());
}

TEST(OneSidedSpring, ImpossibleParametersAreRefusedByName) {
  check_refusals<Cable>("cable");
  check_refusals<Bumper>("bumper");
  BodyId dot;
  System system = on_a_line(1.0, 0.0, dot);
  EXPECT_MODEL_ERROR(system.add(Bumper{.from = ground, .to = dot, .stiffness = 1.0}), "bumper #0",
                     "free_length is 0 m");
}

TEST(OneSidedSpring, TheFingerprintTellsParameters) {
  const auto print = [](double stiffness, double damping, double length) {
    BodyId dot;
    System system = on_a_line(1.0, 0.0, dot);
    system.add(
        Cable{.from = ground, .to = dot, .stiffness = stiffness, .damping = damping, .free_length = length});
    return system.fingerprint();
  };
  EXPECT_EQ(print(1, 2, 3), print(1, 2, 3));
  EXPECT_NE(print(1, 2, 3), print(4, 2, 3));
  EXPECT_NE(print(1, 2, 3), print(1, 4, 3));
  EXPECT_NE(print(1, 2, 3), print(1, 2, 4));
}

}  // namespace
