// Contacts that stiff or strained springs press and open alternately: time stepping adds no energy there.

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace {

using namespace carom;
using namespace carom::planar;

constexpr double gravity = 9.81, radius = 0.1, height = 1.0;

System falling(double restitution) {
  System system;
  system.add(Gravity{{0.0, -gravity}});
  system.set_default_law(Surface{.friction = 0.3, .normal_restitution = restitution});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, "floor");
  return system;
}

BodyId add_disc(System& system, const Vec<2>& at, const Vec<2>& velocity = Vec<2>::Zero()) {
  const BodyId body = system.add(RigidBody{.mass = disc(1.0, radius), .position = at, .velocity = velocity});
  system.add(Disc{.body = body, .radius = radius});
  return body;
}

/// Three discs that springs draw against each other: h^2 k/(4 m) is 5 of a pair at 1 ms.
System triangle(double restitution, double stiffness) {
  System system = falling(restitution);
  const BodyId a = add_disc(system, {0.0, height}), b = add_disc(system, {2.0 * radius, height}),
               c = add_disc(system, {radius, height + radius * std::sqrt(3.0)});
  for (const auto& [from, to] : {std::pair(a, b), std::pair(a, c), std::pair(c, b)}) {
    system.add(
        SpringDamper{.from = from, .to = to, .stiffness = stiffness, .free_length = 2.0 * radius - 1e-4});
  }
  return system;
}

/// Two discs that part against a spring strained by force: it turns them round within a step.
System strained(double restitution) {
  constexpr double force = 5e4, stiffness = 1e8;
  System system = falling(restitution);
  const BodyId a = add_disc(system, {0.0, height}, {-3.0, 0.0}), b = add_disc(system, {2.0 * radius, height});
  system.add(SpringDamper{
      .from = a, .to = b, .stiffness = stiffness, .free_length = 2.0 * radius - force / stiffness});
  return system;
}

/// Largest T + V of a run beyond that at its start, by its size.
double most_gained(const System& system, const TimeStepping& options, double end) {
  Simulation simulation(system, options);
  const double start = simulation.energy().total();
  double most = 0.0;
  while (simulation.time() < end) {
    simulation.step();
    most = std::max(most, simulation.energy().total() / start - 1.0);
  }
  EXPECT_LE(std::abs(simulation.energy().residual()), 1e-12 * simulation.energy().scale());
  return most;
}

TEST(ReturningContacts, OfStiffSpringsAddNoEnergy) {
  for (const double restitution : {0.0, 0.3, 0.5, 0.9}) {
    for (const double stiffness : {1e6, 1e7}) {
      // Friction that sticks while springs turn the slip round may add, at most mu of what presses: 0.1 %
      // here, where normal impulses would add 1e9 times the energy.
      EXPECT_LT(most_gained(triangle(restitution, stiffness), TimeStepping{.step = 1e-3}, 1.0), 2e-3)
          << restitution << ' ' << stiffness;
    }
  }
}

TEST(ReturningContacts, OfStrainedSpringsAddNoEnergy) {
  // The rest is the spring's own error of a step (coupling_discretisation), and rounding.
  for (const double restitution : {0.0, 0.5, 0.9}) {
    EXPECT_LT(most_gained(strained(restitution), TimeStepping{.step = 1e-3}, 0.3), 1e-3) << restitution;
  }
}

TEST(ReturningContacts, ComeBackAsFastAsTheyLeft) {
  Simulation simulation(strained(0.5), TimeStepping{.step = 1e-3});
  bool seen = false;
  for (int i = 0; i < 20; ++i) {
    for (const ContactRecord& contact : simulation.step().contacts) {
      if (!(contact.impulse[0] > 0.0 && contact.velocity_before[0] > 1e-2)) continue;
      seen = true;
      EXPECT_NEAR(contact.velocity_after[0], -contact.velocity_before[0],
                  1e-9 * contact.velocity_before[0]);  // the iteration ends at 1e-12 m of 1e-3 m/s
    }
  }
  EXPECT_TRUE(seen);
}

}  // namespace
