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

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace {

using namespace carom;
using namespace carom::planar;

constexpr double eps = std::numeric_limits<double>::epsilon();

struct Momenta {
  Vec<2> linear = Vec<2>::Zero();
  double angular = 0.0;       // L
  double corrected = 0.0;     // L + (h^2/4) sum v x F
  double linear_scale = 0.0;  // largest terms
  double angular_scale = 0.0;
};

Momenta momenta(const Simulation& simulation, double step) {
  const Assembly& assembly = simulation.assembly();
  const State& state = simulation.state();
  Evaluation evaluation = make_evaluation(assembly);
  for (Index island = 0; island < assembly.islands().size(); ++island)
    evaluate(assembly, island, state.view(), evaluation);
  Momenta sum;
  std::vector<double> momentum(state.v.size());
  for (Index island = 0; island < assembly.islands().size(); ++island) {
    assembly.for_bodies(island, [&](const BodyKind& kind, Range slots, Index, Index v, Index) {
      kind.apply_mass(slots, state.v.data() + v, momentum.data() + v);
    });
  }
  for (const BodySlot& slot : assembly.layout()->bodies()) {
    const double* x = state.q.data() + slot.q;
    const double* v = state.v.data() + slot.v;
    const double* p = momentum.data() + slot.v;
    const double* f = evaluation.force.data() + slot.v;
    sum.linear += Vec<2>(p[0], p[1]);
    const double orbital = x[0] * p[1] - x[1] * p[0];
    const double spin = slot.v_size == 3 ? p[2] : 0.0;
    sum.angular += orbital + spin;
    sum.corrected += orbital + spin + 0.25 * step * step * (v[0] * f[1] - v[1] * f[0]);
    sum.linear_scale = std::max({sum.linear_scale, std::abs(p[0]), std::abs(p[1])});
    sum.angular_scale =
        std::max({sum.angular_scale, std::abs(x[0] * p[1]), std::abs(x[1] * p[0]), std::abs(spin)});
  }
  return sum;
}

struct Drift {
  double linear = 0.0, angular = 0.0, corrected = 0.0;  // largest changes, relative to the largest terms
};
Drift drift(const System& system, double step, int steps) {
  Simulation simulation(system, TimeStepping{.step = step, .tolerance = 0.0});
  const Momenta start = momenta(simulation, step);
  double linear = 0.0, angular = 0.0, corrected = 0.0;
  double linear_scale = start.linear_scale, angular_scale = start.angular_scale;
  for (int i = 0; i < steps; ++i) {
    simulation.step();
    const Momenta now = momenta(simulation, step);
    linear = std::max(linear, (now.linear - start.linear).cwiseAbs().maxCoeff());
    angular = std::max(angular, std::abs(now.angular - start.angular));
    corrected = std::max(corrected, std::abs(now.corrected - start.corrected));
    linear_scale = std::max(linear_scale, now.linear_scale);
    angular_scale = std::max(angular_scale, now.angular_scale);
  }
  EXPECT_TRUE(carom_test::ledger_closes(simulation.energy()));
  return {linear / linear_scale, angular / angular_scale, corrected / angular_scale};
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

// Round-off: 1e3 eps of the largest term, over 10,000 steps.
constexpr double round_off = 1e3 * eps;

void expect_kept(const System& system) {
  const Drift found = drift(system, 2e-3, 10000);
  EXPECT_LE(found.linear, round_off);
  EXPECT_LE(found.corrected, round_off);
  // L itself is not kept: otherwise the correction would not be needed and the test would prove nothing.
  EXPECT_GE(found.angular, 1e3 * round_off);
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
  const Momenta start = momenta(simulation, 2e-3);
  for (int i = 0; i < 10000; ++i) simulation.step();
  const Momenta now = momenta(simulation, 2e-3);
  const Vec<2> expected = start.linear + 2.2 * 20.0 * Vec<2>(0.3, -9.81);
  EXPECT_LE((now.linear - expected).cwiseAbs().maxCoeff(), round_off * now.linear_scale);
}

}  // namespace
