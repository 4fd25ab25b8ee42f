#include <carom/carom.h>
#include <carom/testing/matchers.h>

#include <gtest/gtest.h>

using namespace carom;
using namespace carom::planar;
using namespace carom::energy_test;

// Two masses on a spring with a dashpot, thrown onto a floor; the trace of a second, every 20 ms.
EnergyTrace hop(double friction) {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.set_default_law(
      Surface{.friction = friction, .normal_restitution = 0.5, .tangential_restitution = 0.5});
  system.add(HalfPlane{.point = {0.0, 0.0}, .normal = {0.0, 1.0}}, "floor");
  const BodyId foot =
      system.add(Particle{.mass = 1.0, .position = {0.0, 0.5}, .velocity = {2.0, 0.0}}, "foot");
  const BodyId head =
      system.add(Particle{.mass = 3.0, .position = {0.0, 1.5}, .velocity = {2.0, 0.0}}, "head");
  system.add(SpringDamper{.from = foot, .to = head, .stiffness = 500.0, .damping = 2.0, .free_length = 1.0});

  Simulation simulation(system, TimeStepping{.step = 1e-3});
  EnergyRecorder recorder(simulation, {.interval = 0.02});
  simulation.run_until(1.0);
  return recorder.trace();
}

// Whatever acted is booked: what is left is rounding.
TEST(Hopper, LedgerCloses) { EXPECT_THAT(hop(0.3), ledger_closes_within(1e-12)); }

// The spring is integrated with an error of order h^2; at this step it stays below a millijoule, of 60 J.
TEST(Hopper, EnergyNeverRises) { EXPECT_THAT(hop(0.3), energy_never_rises(1e-3)); }

// The run does what it did. Compilers round differently, which the thousand steps carry on.
TEST(Hopper, MatchesStoredTrace) {
  EXPECT_THAT(hop(0.3), matches_stored_trace(STORED "hopper.csv", {.relative = 1e-10}));
}

// On ice nothing pushes sideways.
TEST(Hopper, KeepsItsMomentumOnIce) { EXPECT_THAT(hop(0.0), momentum_is_conserved_in({1.0, 0.0}, 1e-12)); }

// An impact is noticed up to one step late: (3 - e)/2 h v, here at 4 m/s.
TEST(Hopper, DoesNotSinkIn) { EXPECT_THAT(hop(0.3), constraints_hold_within(5e-3)); }
