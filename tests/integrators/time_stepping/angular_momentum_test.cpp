// Angular momentum of two bodies that collide in a step. Theirs are the only forces, so that their sum is to
// stay. An impact at the start of a step acts at the places there, while the bodies move on by the means of
// their velocities: the sum changes by h/2 (v_A - v_B) x P, of the velocities before and the impulse on A
// (docs/two_modes.md). Located impacts keep it.

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace {

using namespace carom;
using namespace carom::planar;

constexpr double radius = 0.1;

double cross(const Vec<2>& a, const Vec<2>& b) { return a[0] * b[1] - a[1] * b[0]; }

struct Collision {
  System system;
  std::array<BodyId, 2> discs;
  std::array<double, 2> masses;

  [[nodiscard]] double angular_momentum(const State& state) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < discs.size(); ++i) {
      const Vec<2> position = state.position(discs[i]), velocity = state.velocity(discs[i]);
      sum += masses[i] * (cross(position, velocity) + 0.5 * radius * radius * state.spin(discs[i]));
    }
    return sum;
  }
};

/// Two discs that meet within 0.3 s, off their centres, spinning.
Collision random_collision(unsigned seed) {
  std::mt19937 random(seed);
  const auto number = [&](double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random);
  };
  Collision made;
  made.system.set_default_law({.friction = number(0.0, 0.8), .normal_restitution = number(0.0, 1.0)});
  made.masses = {number(0.5, 5.0), number(0.5, 5.0)};
  const Vec<2> apart(number(0.25, 0.35), number(-0.1, 0.1));
  const std::array<Vec<2>, 2> places{Vec<2>(0.0, 0.0), apart};
  const std::array<Vec<2>, 2> velocities{Vec<2>(1.0, 0.0), Vec<2>(number(-0.5, 0.2), number(-0.1, 0.1))};
  for (std::size_t i = 0; i < 2; ++i) {
    made.discs[i] = made.system.add(RigidBody{.mass = disc(made.masses[i], radius),
                                              .position = places[i],
                                              .velocity = velocities[i],
                                              .spin = number(-5.0, 5.0)});
    made.system.add(Disc{.body = made.discs[i], .radius = radius});
  }
  return made;
}

TEST(AngularMomentum, ChangesByHalfAStepOfTheVelocityWhereImpactsActAtStepStart) {
  constexpr double step = 1e-3, end = 0.3;
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Collision made = random_collision(seed);
    Simulation simulation(made.system, TimeStepping{.step = step});
    const double start = made.angular_momentum(simulation.state());
    double expected = 0.0;
    int impacts = 0;
    while (simulation.state().time < end - 0.5 * step) {
      const State before = simulation.state();
      for (const ContactRecord& contact : simulation.step().contacts) {
        const Vec<2> relative = before.velocity(made.discs[0]) - before.velocity(made.discs[1]);
        const Vec<2> on_a =
            (simulation.state().velocity(made.discs[0]) - before.velocity(made.discs[0])) * made.masses[0];
        expected += 0.5 * step * cross(relative, on_a);
        impacts += contact.impulse[0] > 0.0 ? 1 : 0;
      }
    }
    ASSERT_GT(impacts, 0) << seed;
    ASSERT_GT(std::abs(expected), 1e-7) << seed;
    // Rounding of a few hundred steps.
    EXPECT_NEAR(made.angular_momentum(simulation.state()) - start, expected, 1e-13) << seed;
  }
}

TEST(AngularMomentum, IsKeptWhereImpactsAreLocated) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    for (const double step : {1e-2, 1e-3}) {
      const Collision made = random_collision(seed);
      Simulation simulation(made.system, TimeStepping{.step = step, .impacts = ImpactTimes::located});
      const double start = made.angular_momentum(simulation.state());
      simulation.run_until(0.3);
      ASSERT_FALSE(simulation.state().velocity(made.discs[0]).isApprox(Vec<2>(1.0, 0.0))) << seed;
      // Rounding of a few hundred steps.
      EXPECT_NEAR(made.angular_momentum(simulation.state()), start, 1e-13) << seed << " " << step;
    }
  }
}

}  // namespace
