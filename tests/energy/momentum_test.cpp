// Momentum without obstacles.
//
// Linear momentum: couplings push both ends alike, so the sum of M v changes by rounding alone.
//
// Angular momentum L = sum (q x m v + I w), with F and t the resultant force and torque on each body and '
// for the end of a step. The bilinear identity q' x v' - q x v = (q' - q) x (v + v')/2 + (q + q')/2 x (v' -
// v), the rule q' - q = h (v + v')/2, m (v' - v) = h (F + F')/2, I (w' - w) = h (t + t')/2 and the balance of
// internal forces, sum (q x F + t) = 0 at both ends, give
//     L' - L = -(h/4) sum (q' - q) x (F' - F) = -(h^2/8) sum (v + v') x (F' - F),
// while (h^2/4) sum v x F changes by
//     (h^2/4) sum [(v' - v) x (F + F')/2 + (v + v')/2 x (F' - F)],  of which the first part vanishes,
// so L + (h^2/4) sum v x F is kept. Torques drop out: it holds for springs fixed off the centres of rigid
// bodies as for particles, with F and v those of the centres of mass; and for dashpots, once F is the force
// at the end of the step. The converged iteration is as good as rounding.

#include "tests/energy/ledger_check.h"

#include <carom/carom.h>
#include <carom/core/assembly.h>
#include <carom/testing/matchers.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace {

using namespace carom;
using namespace carom::planar;

using namespace carom::energy_test;
using carom_test::round_off;  // over 10,000 steps

/// L + (h^2/4) sum v x F.
double corrected_momentum(const Simulation& simulation, double step) {
  const Assembly& assembly = simulation.assembly();
  const State& state = simulation.state();
  Evaluation evaluation = make_evaluation(assembly);
  for (Index component = 0; component < assembly.components().size(); ++component)
    evaluate(assembly, component, state.view(), evaluation);
  double sum = total_momentum(assembly, state).angular[2];
  for (const BodySlot& slot : assembly.layout()->bodies()) {
    const double* v = state.v.data() + slot.v;
    const double* f = evaluation.force.data() + slot.v;
    sum += 0.25 * step * step * (v[0] * f[1] - v[1] * f[0]);
  }
  return sum;
}

void add_particles(System& system, double damping) {
  const BodyId a = system.add(Particle{.mass = 1.0, .position = {0.0, 0.0}, .velocity = {1.0, 3.0}});
  const BodyId b = system.add(Particle{.mass = 0.3, .position = {1.2, 0.1}, .velocity = {-1.0, -2.0}});
  const BodyId c = system.add(Particle{.mass = 2.0, .position = {0.4, 1.1}, .velocity = {0.5, 0.0}});
  system.add(SpringDamper{.from = a, .to = b, .stiffness = 200.0, .damping = damping, .free_length = 1.0});
  system.add(SpringDamper{.from = b, .to = c, .stiffness = 100.0, .damping = damping, .free_length = 1.2});
  system.add(SpringDamper{.from = c, .to = a, .stiffness = 300.0, .damping = damping, .free_length = 1.0});
}

void add_bodies(System& system, double damping) {
  const BodyId a = system.add(RigidBody{
      .mass = rod(1.0, 1.0), .position = {0.0, 0.0}, .angle = 0.3, .velocity = {1.0, 2.0}, .spin = 5.0});
  const BodyId b = system.add(
      RigidBody{.mass = disc(0.5, 0.4), .position = {1.5, 0.2}, .velocity = {-1.0, -1.0}, .spin = -3.0});
  const BodyId c = system.add(Particle{.mass = 0.7, .position = {0.5, 1.4}, .velocity = {0.0, 1.0}});
  system.add(SpringDamper{.from = {a, {0.5, 0.0}},
                          .to = {b, {-0.4, 0.1}},
                          .stiffness = 150.0,
                          .damping = damping,
                          .free_length = 0.6});
  system.add(SpringDamper{
      .from = {b, {0.0, 0.4}}, .to = c, .stiffness = 100.0, .damping = damping, .free_length = 1.0});
  system.add(SpringDamper{
      .from = c, .to = {a, {-0.5, 0.0}}, .stiffness = 120.0, .damping = damping, .free_length = 1.5});
}

void expect_kept(const System& system) {
  constexpr double step = 2e-3;
  Simulation simulation(system, TimeStepping{.step = step, .tolerance = 0.0});
  const EnergyRecorder recorder(simulation);
  const double start = corrected_momentum(simulation, step);
  double drift = 0.0;
  for (int i = 0; i < 10000; ++i) {
    simulation.step();
    drift = std::max(drift, std::abs(corrected_momentum(simulation, step) - start));
  }
  const EnergyTrace& trace = recorder.trace();
  EXPECT_THAT(trace, ledger_closes_within(round_off));
  EXPECT_THAT(trace, momentum_is_conserved_in({1.0, 0.0}, round_off));
  EXPECT_THAT(trace, momentum_is_conserved_in({0.0, 1.0}, round_off));
  EXPECT_LE(drift, round_off * trace.rows().back().angular_momentum_scale);
  // L itself is not kept: otherwise the correction would not be needed and the test would prove nothing.
  EXPECT_THAT(trace, testing::Not(angular_momentum_is_conserved_about({0.0, 0.0}, 1e3 * round_off)));
}

TEST(Momentum, ParticlesOnSprings) {
  System system;
  add_particles(system, 0.0);
  expect_kept(system);
}

TEST(Momentum, RigidBodiesOnOffCentreSprings) {
  System system;
  add_bodies(system, 0.0);
  expect_kept(system);
}

TEST(Momentum, RigidBodiesOnSpringsAndDashpots) {
  System system;
  add_bodies(system, 0.2);
  expect_kept(system);
}

TEST(Momentum, GravityAddsItsImpulse) {
  // Linear momentum changes by m g t: exactly but for round-off.
  System system;
  add_bodies(system, 0.1);
  system.add(Gravity{{0.3, -9.81}});
  Simulation simulation(std::move(system), TimeStepping{.step = 2e-3, .tolerance = 0.0});
  const auto momentum = [&] { return total_momentum(simulation.assembly(), simulation.state()); };
  const TotalMomentum start = momentum();
  for (int i = 0; i < 10000; ++i) simulation.step();
  const TotalMomentum now = momentum();
  const double gained = 2.2 * 20.0;  // kg s
  EXPECT_NEAR(now.linear[0], start.linear[0] + gained * 0.3, round_off * now.linear_scale);
  EXPECT_NEAR(now.linear[1], start.linear[1] - gained * 9.81, round_off * now.linear_scale);
}

}  // namespace
