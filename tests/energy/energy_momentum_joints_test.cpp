// The rule energy_momentum with joints: reactions do no work over a step, so that mechanisms keep energy and
// momentum to rounding; positions obey the joints and are of order two; velocities follow.

#include "tests/analytic/convergence.h"
#include "tests/energy/free_assemblies.h"
#include "tests/energy/ledger_check.h"
#include "tests/integrators/random_mechanisms.h"
#include "tests/integrators/same_run.h"
#include "tests/temporary_folder.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::bits_of;
using carom_test::Departure;
using carom_test::departure;
using carom_test::Invariants;
using carom_test::invariants;
using carom_test::ledger_closes;

TimeStepping rule(double step) {
  return {.step = step, .tolerance = 1e-13, .force_rule = ForceRule::energy_momentum};
}

/// Rods of 1 m and 1 kg, pinned to each other, the first to `from`; springs to points above if asked for.
System chain(int rods, bool hangs, double spring = 0.0) {
  System system;
  if (hangs) system.add(Gravity{{0.0, -9.81}});
  BodyId before = ground;
  for (int i = 0; i < rods; ++i) {
    RigidBody body{.mass = rod(1.0, 1.0), .position = {i + 0.5, 0.0}};
    if (!hangs) body.velocity = {0.3, i % 2 == 0 ? 1.0 : -1.0};
    // The pins of a chain that is thrown have one velocity.
    if (!hangs) body.spin = i % 2 == 0 ? -2.0 : 2.0;
    if (!hangs) body.velocity[1] = 0.0;
    const BodyId id = system.add(body);
    const End<2> end = i == 0 ? End<2>(ground) : End<2>(before, {0.5, 0.0});
    if (i > 0 || hangs) system.add(Revolute{.from = end, .to = {id, {-0.5, 0.0}}});
    if (spring > 0.0) {
      system.add(SpringDamper{
          .from = {ground, {1.0 * i, 2.0}}, .to = {id, {0.2, 0.0}}, .stiffness = spring, .free_length = 1.0});
    }
    before = id;
  }
  return system;
}

/// A crank that turns, a rod, and a slider on a spring.
System slider_crank() {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  const BodyId crank = system.add(RigidBody{.mass = rod(1.0, 0.4), .position = {0.2, 0.0}});
  const BodyId link = system.add(RigidBody{.mass = rod(0.5, 1.0), .position = {0.9, 0.0}});
  const BodyId slider = system.add(RigidBody{.mass = rod(2.0, 0.2), .position = {1.4, 0.0}});
  system.add(Revolute{.from = ground, .to = {crank, {-0.2, 0.0}}});
  system.add(Revolute{.from = {crank, {0.2, 0.0}}, .to = {link, {-0.5, 0.0}}});
  system.add(Revolute{.from = {link, {0.5, 0.0}}, .to = slider});
  system.add(Prismatic{.from = {ground, {1.4, 0.0}}, .to = slider, .axis = {1.0, 0.0}});
  system.add(SpringDamper{.from = {ground, {2.4, 0.3}}, .to = slider, .stiffness = 20.0, .free_length = 0.8});
  system.add(TorsionalSpring{.from = crank, .to = link, .stiffness = 3.0});
  return system;
}

// Every iterate is accepted at 1e-13 of the places of bodies: times the forces in the joints that is the
// departure of a step. Seen: 3e-13 of the energies in it.
TEST(EnergyMomentumJoints, MechanismsKeepTheirEnergy) {
  for (const System& system : {chain(1, true), chain(5, true), chain(4, true, 30.0), slider_crank()}) {
    Simulation simulation(system, rule(2e-3));
    const Departure largest = departure(simulation, 5000);
    EXPECT_LE(largest.energy, 5e-12 * simulation.energy().scale());
    EXPECT_LE(std::abs(simulation.energy().flow(EnergyFlow::coupling_discretisation)),
              5e-12 * simulation.energy().scale());
    EXPECT_EQ(simulation.energy().flow(EnergyFlow::projection), 0.0);
    EXPECT_TRUE(ledger_closes(simulation.energy()));
  }
}

TEST(EnergyMomentumJoints, TheDefaultRuleDoesNot) {
  Simulation simulation(chain(5, true), TimeStepping{.step = 2e-3, .tolerance = 1e-13});
  EXPECT_GT(departure(simulation, 5000).energy, 1e-6 * simulation.energy().scale());
}

TEST(EnergyMomentumJoints, AChainInFreeFlightKeepsItsMomenta) {
  Simulation simulation(chain(5, false), rule(2e-3));
  const Invariants start = invariants(simulation);
  const Departure largest = departure(simulation, 5000);
  EXPECT_LE(largest.energy, 5e-12 * start.energy);
  EXPECT_LE(largest.linear, 1e-12 * 5.0 * 0.3);                     // rounding of 5,000 steps
  EXPECT_LE(largest.angular, 1e-11 * simulation.energy().scale());  // rounding, of numbers about 10
}

/// Largest gap of the pins of a chain, and how fast they open.
struct PinErrors {
  double gap = 0.0, rate = 0.0;
};
PinErrors pins(const Simulation& simulation, int rods) {
  PinErrors out;
  Vec<2> end = Vec<2>::Zero(), speed = Vec<2>::Zero();
  const State& state = simulation.state();
  for (int i = 0; i < rods; ++i) {
    const double *const q = state.q.data() + 3 * i, *const v = state.v.data() + 3 * i;
    const Vec<2> lever(0.5 * std::cos(q[2]), 0.5 * std::sin(q[2])), across(-lever[1], lever[0]);
    const Vec<2> place(q[0], q[1]), velocity(v[0], v[1]);
    out.gap = std::max(out.gap, (place - lever - end).norm());
    out.rate = std::max(out.rate, (velocity - v[2] * across - speed).norm());
    end = place + lever;
    speed = velocity + v[2] * across;
  }
  return out;
}

TEST(EnergyMomentumJoints, PositionsObeyTheJointsAndVelocitiesFollowToSecondOrder) {
  std::vector<double> rates;
  for (const double step : {4e-3, 2e-3, 1e-3}) {
    Simulation simulation(chain(3, true), rule(step));
    double rate = 0.0;
    while (simulation.time() < 1.0) {
      simulation.step();
      const PinErrors errors = pins(simulation, 3);
      ASSERT_LE(errors.gap, 3e-13);  // accepted at 1e-13 of the places, which are up to 3 m
      rate = std::max(rate, errors.rate);
    }
    rates.push_back(rate);
  }
  EXPECT_NEAR(std::log2(rates[0] / rates[1]), 2.0, 0.1);
  EXPECT_NEAR(std::log2(rates[1] / rates[2]), 2.0, 0.1);
}

TEST(EnergyMomentumJoints, PositionsAreOfSecondOrder) {
  for (const System& system : {chain(3, true, 30.0), slider_crank()}) {
    Simulation exact(system, EventDriven{.relative_tolerance = 1e-12, .absolute_tolerance = 1e-13});
    exact.run_until(0.8);
    std::vector<double> errors;
    for (const double step : {4e-3, 2e-3, 1e-3}) {
      Simulation simulation(system, rule(step));
      simulation.run_until(0.8);
      double error = 0.0;
      for (std::size_t i = 0; i < exact.state().q.size(); ++i) {
        error = std::max(error, std::abs(simulation.state().q[i] - exact.state().q[i]));
      }
      errors.push_back(error);
    }
    EXPECT_NEAR(std::log2(errors[0] / errors[1]), 2.0, 0.1);
    EXPECT_NEAR(std::log2(errors[1] / errors[2]), 2.0, 0.1);
  }
}

// Of welds, slides, rods and pins, with springs and motors.
void reactions_of_random_trees_do_no_work(std::uint64_t first, std::uint64_t last) {
  for (std::uint64_t seed = first; seed < last; ++seed) {
    Simulation simulation(joint_scenes::random_tree(seed).system, rule(1e-3));
    simulation.run_until(1.0);
    const EnergyLedger& energy = simulation.energy();
    EXPECT_LE(std::abs(energy.flow(EnergyFlow::coupling_discretisation)), 5e-12 * energy.scale()) << seed;
    EXPECT_TRUE(ledger_closes(energy)) << seed;
  }
}

TEST(EnergyMomentumJoints, ReactionsOfRandomTreesDoNoWork) { reactions_of_random_trees_do_no_work(0, 10); }

TEST(EnergyMomentumJointsLong, ReactionsOfRandomTreesDoNoWork) {
  reactions_of_random_trees_do_no_work(10, 40);
}

TEST(EnergyMomentumJoints, AllIterationsEndAtOneStep) {
  const System system = slider_crank();
  Simulation one(system, rule(2e-3));
  one.run_until(0.5);
  for (const Iteration iteration :
       {Iteration::fixed_point, Iteration::anderson, Iteration::linearly_implicit}) {
    TimeStepping options = rule(2e-3);
    options.iteration = iteration;
    Simulation other(system, options);
    other.run_until(0.5);
    for (std::size_t i = 0; i < one.state().q.size(); ++i) {
      EXPECT_NEAR(other.state().q[i], one.state().q[i], 1e-10);  // 250 steps, each at 1e-13
    }
  }
}

// Contact is answered by the joints as under the other rule, with positions and velocities on them; in the
// air energy is kept again.
TEST(EnergyMomentumJoints, ChainsHitTheGroundAndSwingOn) {
  System system = chain(3, true);
  system.add(HalfPlane{.point = {0.0, -1.5}, .normal = {0.0, 1.0}},
             Surface{.friction = 0.2, .normal_restitution = 0.5, .tangential_restitution = 0.5});
  for (Index i = 0; i < 3; ++i) {
    const auto body = system.bodies()[i];
    system.add(Segment{.body = body, .from = {-0.5, 0.0}, .to = {0.5, 0.0}});
  }
  Simulation simulation(system, rule(1e-3));
  double least = simulation.energy().total();
  std::int64_t kept = 0;
  while (simulation.time() < 3.0) {
    const double before = simulation.energy().total();
    simulation.step();
    ASSERT_TRUE(ledger_closes(simulation.energy()));
    if (!simulation.report().contacts.empty()) continue;
    ++kept;
    ASSERT_NEAR(simulation.energy().total(), before, 1e-12 * simulation.energy().scale());
    least = std::min(least, before);
  }
  EXPECT_GT(simulation.statistics().impacts, 0);
  EXPECT_GT(kept, 200);
}

TEST(EnergyMomentumJoints, GoOnBitForBitAfterACheckpoint) {
  const carom_test::TemporaryFolder folder;
  Simulation whole(slider_crank(), rule(2e-3));
  whole.run_until(0.3);
  whole.save(folder / "run");
  Simulation rest(slider_crank(), rule(2e-3));
  rest.load(folder / "run");
  whole.run_until(0.6);
  rest.run_until(0.6);
  EXPECT_EQ(bits_of(whole), bits_of(rest));
}

// Mean rows give velocities by their mean with those before: behind a jump they would alternate about the
// rate for ever. Breaks within a step and at its end.
TEST(EnergyMomentumJoints, FollowADriverWhoseRateJumps) {
  for (const double jump : {0.5137, 0.5}) {
    const auto rate = [=](double t) { return t < jump ? 3.0 : -2.0; };
    System system;
    const BodyId crank = system.add(RigidBody{.mass = rod(1.0, 0.2), .position = {0.1, 0.0}});
    const JointId pin = system.add(Revolute{.from = ground, .to = {crank, {-0.1, 0.0}}});
    system.add(
        Driver{.joint = pin,
               .position = [=](double t) { return 3.0 * std::min(t, jump) - 2.0 * std::max(t - jump, 0.0); },
               .velocity = rate,
               .acceleration = [](double) { return 0.0; },
               .breaks = {jump}});
    for (const double step : {1e-2, 1e-3}) {
      Simulation simulation(system, rule(step));
      for (int i = 0; i < 100; ++i) {
        simulation.step();
        if (simulation.time() < jump + step && i < 90) simulation.run_until(jump + 1.5 * step);
        // Bodies turn by 2 atan(h w/2): mean velocities are wrong by h^2 w^3/12, w up to 3 rad/s, those at an
        // end by twice that.
        EXPECT_NEAR(simulation.state().spin(crank), rate(simulation.time()), step * step * 27.0 / 6.0)
            << "at " << simulation.time() << " s, step " << step;
      }
      EXPECT_TRUE(ledger_closes(simulation.energy()));
    }
  }
}

}  // namespace
