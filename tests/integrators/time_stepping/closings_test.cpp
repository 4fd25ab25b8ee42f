// Impacts that are located where a body is not alone: bodies that touch each other, bodies with joints, laws
// of impact of their own. Steps end when contacts close (step_closings.h); against the event-driven mode.

#include "tests/allocation_counter.h"
#include "tests/analytic/convergence.h"
#include "tests/energy/ledger_check.h"
#include "tests/integrators/event_run.h"
#include "tests/integrators/same_run.h"
#include "tests/integrators/time_stepping/located_runs.h"
#include "tests/random.h"
#include "tests/temporary_folder.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::bits_of;
using carom_test::distance;
using carom_test::ledger_closes;
using carom_test::located;
using carom_test::run;
using carom_test::tight;

constexpr double g = 9.81;

BodyId add_disc(System& system, const Vec<2>& position, const Vec<2>& velocity, double radius = 0.1,
                double mass = 1.0) {
  const BodyId body =
      system.add(RigidBody{.mass = disc(mass, radius), .position = position, .velocity = velocity});
  system.add(Disc{.body = body, .radius = radius});
  return body;
}

void add_floor(System& system, const Surface& law) {
  system.add(Gravity{{0.0, -g}});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, "floor");
  system.set_default_law(law);
}

constexpr Surface rough{.friction = 0.3, .normal_restitution = 0.7, .tangential_restitution = 0.3};

/// Three discs that fall, meet and rebound.
System discs(const Surface& law = rough) {
  System system;
  add_floor(system, law);
  add_disc(system, {0.0, 0.5}, {1.0, 0.0});
  add_disc(system, {0.5, 0.9}, {-1.0, -1.0}, 0.15, 2.0);
  add_disc(system, {0.2, 1.5}, {0.1, -1.0}, 0.12, 2.0);
  return system;
}

/// Three boxes, that fall on each other turned.
System boxes() {
  System system;
  add_floor(system, {.friction = 0.3, .normal_restitution = 0.5, .tangential_restitution = 0.5});
  for (int i = 0; i < 3; ++i) {
    const BodyId body = system.add(RigidBody{.mass = box(1.0, 0.4, 0.2),
                                             .position = {0.05 * i, 0.4 + 0.45 * i},
                                             .angle = 0.3 * i + 0.1,
                                             .spin = 1.0 - i});
    system.add(Polygon{.body = body, .vertices = {{-0.2, -0.1}, {0.2, -0.1}, {0.2, 0.1}, {-0.2, 0.1}}});
  }
  return system;
}

/// Two discs on a spring with a dashpot, hit from above.
System coupled_discs(double damping) {
  System system;
  add_floor(system, rough);
  const BodyId a = add_disc(system, {0.0, 0.6}, {0.0, 0.0});
  const BodyId b = add_disc(system, {0.5, 0.6}, {0.0, 0.0}, 0.15, 2.0);
  add_disc(system, {0.02, 1.0}, {0.0, -3.0}, 0.12, 2.0);
  system.add(SpringDamper{.from = a, .to = b, .stiffness = 200.0, .damping = damping, .free_length = 0.4});
  return system;
}

/// Two pendulums of which one falls against the other.
System pendulums() {
  System system;
  system.add(Gravity{{0.0, -g}});
  system.set_default_law({.friction = 0.0, .normal_restitution = 0.8});
  for (int i = 0; i < 2; ++i) {
    const Vec<2> pivot(0.25 * i, 0.0), place = pivot + (i == 0 ? Vec<2>(0.0, -1.0) : Vec<2>(0.6, -0.8));
    const BodyId body = add_disc(system, place, {0.0, 0.0});
    system.add(Revolute{.from = {ground, pivot}, .to = {body, pivot - place}, .zero_angle = 0.0});
  }
  return system;
}

// Flights under constant loads are exact, and so are the instants: nothing of the step is left.
TEST(Closings, OfBodiesThatFlyAreExact) {
  for (const System& system : {discs(), boxes()}) {
    const State there = run(system, tight(), 0.33);
    for (const double step : {1e-2, 1e-3, 2e-4}) {
      // Instants are found to 1e-12 m; impacts of discs multiply what is off there by some tens.
      EXPECT_LT(distance(run(system, located(step), 0.33), there), 1e-9) << step;
    }
    EXPECT_GT(distance(run(system, TimeStepping{.step = 1e-3}, 0.33), there), 1e-3);
  }
}

TEST(Closings, AreOfSecondOrder) {
  struct Case {
    const char* name;
    System system;
    double end;
  };
  for (const Case& scene : {Case{"spring", coupled_discs(0.0), 0.2}, Case{"dashpot", coupled_discs(5.0), 0.2},
                            Case{"pendulums", pendulums(), 0.8}}) {
    const State there = run(scene.system, tight(), scene.end);
    const analytic::MeanOrder order = analytic::mean_order(4e-3, 4, 8, [&](double step) {
      return distance(run(scene.system, located(step), scene.end), there);
    });
    EXPECT_GT(order.slope, 1.8) << scene.name << ", deviation " << order.deviation;
    EXPECT_LT(order.slope, 2.4) << scene.name;
    const State first_order = run(scene.system, TimeStepping{.step = order.steps.back()}, scene.end);
    EXPECT_GT(distance(first_order, there), 20.0 * order.errors.back()) << scene.name;
  }
}

// Every rule of impact that the steps themselves do not know.
TEST(Closings, TakeAnyLawOfImpact) {
  for (const ImpactLaw law : {ImpactLaw::poisson, ImpactLaw::energetic}) {
    const System system = discs({.friction = 0.2, .normal_restitution = 0.6, .impact_law = law});
    EXPECT_LT(distance(run(system, located(1e-3), 0.3), run(system, tight(), 0.3)), 1e-9) << to_string(law);
    System alone;
    alone.add(Gravity{{0.0, -g}});
    alone.add(HalfPlane{.normal = {0.0, 1.0}},
              Surface{.friction = 0.2, .normal_restitution = 0.6, .impact_law = law});
    const BodyId body =
        alone.add(RigidBody{.mass = box(1.0, 0.4, 0.2), .position = {0.0, 0.6}, .angle = 0.4, .spin = 2.0});
    alone.add(Polygon{.body = body, .vertices = {{-0.2, -0.1}, {0.2, -0.1}, {0.2, 0.1}, {-0.2, 0.1}}});
    EXPECT_LT(distance(run(alone, located(1e-3), 0.5), run(alone, tight(), 0.5)), 1e-9) << to_string(law);
  }
  for (const ImpactRules& rules :
       {ImpactRules{.order = ImpactOrder::sequential}, ImpactRules{.energy_gain = EnergyGain::limit}}) {
    TimeStepping stepping = located(1e-3);
    EventDriven events = tight();
    stepping.impact_rules = events.impact_rules = rules;
    const System system = discs({.friction = 0.2, .normal_restitution = 0.9, .tangential_restitution = 0.0});
    EXPECT_LT(distance(run(system, stepping, 0.3), run(system, events, 0.3)), 1e-9);
  }
}

// A cradle of five, whose first disc arrives within a step: by the sequential law the last one leaves alone.
TEST(Closings, OfACradleHandTheSpeedOn) {
  System system;
  system.set_default_law({.friction = 0.0, .normal_restitution = 1.0});
  for (int i = 0; i < 5; ++i)
    add_disc(system, {0.2 * i - (i == 0 ? 0.05 : 0.0), 0.0}, {i == 0 ? 1.0 : 0.0, 0.0});
  TimeStepping options = located(1e-2);
  options.impact_rules.order = ImpactOrder::sequential;
  Simulation simulation(system, options);
  simulation.run_until(0.1);
  for (int i = 0; i < 5; ++i) {
    EXPECT_NEAR(simulation.state().v[3 * static_cast<std::size_t>(i)], i == 4 ? 1.0 : 0.0, 1e-12) << i;
  }
  // It went on where the first arrived, at t = 0.05.
  EXPECT_NEAR(simulation.state().q[12], 0.8 + 0.05, 1e-11);
}

// Rolling resistance at an impact: with spin, on ground without friction, M = -rho P_n.
TEST(Closings, TakeRollingResistance) {
  constexpr double rho = 0.01, e = 0.5, radius = 0.2, spin = 30.0, height = 0.1;
  System system;
  system.add(Gravity{{0.0, -g}});
  system.add(HalfPlane{.normal = {0.0, 1.0}},
             Surface{.friction = 0.0, .normal_restitution = e, .rolling_resistance = rho});
  const BodyId body =
      system.add(RigidBody{.mass = disc(1.5, radius), .position = {0.0, radius + height}, .spin = spin});
  system.add(Disc{.body = body, .radius = radius});
  Simulation simulation(system, located(7e-3));
  const double fall = std::sqrt(2.0 * height / g), speed = g * fall, end = fall + 0.05;
  simulation.run_until(end);
  const double inertia = 0.5 * 1.5 * radius * radius;
  EXPECT_NEAR(simulation.state().v[2], spin - rho * 1.5 * (1.0 + e) * speed / inertia, 1e-11);
  EXPECT_NEAR(simulation.state().v[1], e * speed - g * 0.05, 1e-11);
  EXPECT_NEAR(simulation.state().q[1], radius + e * speed * 0.05 - 0.5 * g * 0.05 * 0.05, 1e-12);
  EXPECT_TRUE(ledger_closes(simulation.energy()));
}

// A gas: with e = 1 no impact takes energy, none takes momentum.
TEST(Closings, OfAGasKeepEnergyAndMomentum) {
  carom_test::Random random(5);
  System system;
  system.set_default_law({.friction = 0.0, .normal_restitution = 1.0});
  std::vector<double> masses;
  for (int i = 0; i < 16; ++i) {
    masses.push_back(random.uniform(0.5, 2.0));
    add_disc(system, {0.3 * (i % 4), 0.3 * (i / 4)}, random.vec<2>(2.0), 0.1, masses.back());
  }
  Simulation simulation(system, located(1e-2));
  const double energy = simulation.energy().total();
  const std::vector<BodyId> bodies = simulation.system().bodies();
  const auto momentum = [&] {
    Vec<2> sum = Vec<2>::Zero();
    for (std::size_t i = 0; i < bodies.size(); ++i) sum += masses[i] * simulation.state().velocity(bodies[i]);
    return sum;
  };
  const Vec<2> before = momentum();
  simulation.run_until(1.0);
  EXPECT_GT(simulation.statistics().impacts, 10);
  EXPECT_NEAR(simulation.energy().total(), energy, 1e-12 * energy);
  EXPECT_LT((momentum() - before).norm(), 1e-12);
  EXPECT_TRUE(ledger_closes(simulation.energy()));
  EXPECT_GT(simulation.statistics().deepest_gap, -1e-11);
}

TEST(Closings, ThatAccumulateEndAtRest) {
  for (const int most : {1, 10}) {
    System system;
    add_floor(system, {.friction = 0.3, .normal_restitution = 0.6});
    add_disc(system, {0.0, 0.3}, {0.0, 0.0});
    add_disc(system, {0.0, 0.8}, {0.0, 0.0});
    TimeStepping options = located(5e-3);
    options.most_impacts = most;
    Simulation simulation(system, options);
    simulation.run_until(5.0);
    // The last contacts begin with at most the capture speed, or a step late, and last.
    for (const std::size_t body : {std::size_t{0}, std::size_t{1}}) {
      EXPECT_NEAR(simulation.state().q[3 * body + 1], 0.1 + 0.2 * static_cast<double>(body), 1e-3) << most;
      EXPECT_NEAR(simulation.state().v[3 * body + 1], 0.0, 1e-12) << most;
    }
    EXPECT_TRUE(ledger_closes(simulation.energy())) << most;
    EXPECT_EQ(simulation.report().contacts.size(), 2U) << most;
  }
}

TEST(Closings, GoOnBitForBitAfterACheckpoint) {
  const carom_test::TemporaryFolder folder;
  for (const System& system : {discs(), boxes(), coupled_discs(5.0), pendulums()}) {
    Simulation whole(system, located(1e-3));
    whole.run_until(0.317);
    whole.save(folder / "half");
    Simulation rest(system, located(1e-3));
    rest.load(folder / "half");
    whole.run_until(1.0);
    rest.run_until(1.0);
    EXPECT_EQ(bits_of(rest), bits_of(whole));
  }
}

constexpr double half_side = 0.1;  // of the blocks of a stack [m]

/// Adds blocks at rest, corner on corner. \param bottom height of the ground below them
void add_stack(System& system, int blocks, double bottom) {
  constexpr double half = half_side;
  for (int i = 0; i < blocks; ++i) {
    const BodyId body = system.add(RigidBody{.mass = box(1.0, 2.0 * half, 2.0 * half),
                                             .position = {0.0, bottom + half + 2.0 * half * i}});
    system.add(
        Polygon{.body = body, .vertices = {{-half, -half}, {half, -half}, {half, half}, {-half, half}}});
  }
}

/// The fastest spin of a stack in some steps, over that of a block one of whose corners is missing for a
/// whole step, about h g / half a side.
double rocking(const System& stack, const TimeStepping& options, int steps) {
  Simulation simulation(stack, options);
  double fastest = 0.0;
  for (int step = 0; step < steps; ++step) {
    simulation.step();
    for (const BodyId body : simulation.system().bodies()) {
      fastest = std::max(fastest, std::abs(simulation.state().spin(body)));
    }
  }
  EXPECT_TRUE(ledger_closes(simulation.energy()));
  return fastest / (options.step * g / half_side);
}

// A corner that rounding has opened may be listed by the vertex of the other block when it closes, while the
// second corner of the two blocks touches.
void expect_rest(int blocks) {
  for (const ForceRule rule : {ForceRule::trapezoidal, ForceRule::energy_momentum}) {
    System system;
    add_floor(system, {.friction = 0.3, .normal_restitution = 0.0});
    add_stack(system, blocks, 0.0);
    TimeStepping options = located(1e-3);
    options.force_rule = rule;
    // Corners that rounding opens are missing for a part of a step.
    EXPECT_LT(rocking(system, options, 10), 1e-2) << blocks;
  }
}

TEST(Closings, StacksOfBlocksStayAtRest) { expect_rest(6); }

// Contacts closed to rounding at the start of a step last: no step of a stack is parted by corners that
// rounding has opened, so none lists a contact twice.
TEST(Closings, OfStacksAtRestAreNone) {
  for (const double restitution : {0.0, 0.5}) {
    System system;
    add_floor(system, {.friction = 0.3, .normal_restitution = restitution});
    add_stack(system, 10, 0.0);
    Simulation simulation(system, located(1e-3));
    for (int step = 0; step < 200; ++step) {
      EXPECT_EQ(simulation.step().contacts.size(), 20U) << step;
    }
    // Ten blocks on each other, each to the rounding of its gap.
    EXPECT_NEAR(simulation.state().position(simulation.system().bodies().back())[1], 1.9, 1e-11);
  }
}

TEST(ClosingsLong, HigherStacksOfBlocksStayAtRest) {
  for (const int blocks : {8, 10}) expect_rest(blocks);
}

// Stacks stay at rest on corners of the ground: of a block of ground as wide as the stack, of a narrower one,
// of terrain below the corners and between them.
TEST(Closings, StacksOnCornersOfTheGroundStayAtRest) {
  constexpr double top = 0.3, half = half_side;
  const auto block = [&](double width) {
    return planar::Block{.vertices = {{-width, 0.0}, {width, 0.0}, {width, top}, {-width, top}}};
  };
  const auto stack_on = [&](const auto& ground_shape, int blocks) {
    System system;
    system.add(Gravity{{0.0, -g}});
    system.set_default_law({.friction = 0.3, .normal_restitution = 0.0});
    system.add(ground_shape);
    add_stack(system, blocks, top);
    return system;
  };
  const Terrain below{.vertices = {{-1.0, top}, {-half, top}, {half, top}, {1.0, top}}, .depth = 0.5};
  const Terrain between{.vertices = {{-1.0, 0.0}, {-0.07, top}, {0.07, top}, {1.0, 0.0}}, .depth = 0.05};
  for (const int blocks : {1, 2, 6}) {
    for (const System& system : {stack_on(block(half), blocks), stack_on(block(0.07), blocks),
                                 stack_on(below, blocks), stack_on(between, blocks)}) {
      for (const double step : {3e-3, 1e-2}) {
        EXPECT_LT(rocking(system, located(step), 20), 1e-2) << blocks << " blocks, step " << step;
      }
    }
  }
}

TEST(Closings, FollowStepControl) {
  // An error per step of the tolerance, of third order in the step, is one of tolerance^(2/3) at the end. Six
  // impacts, with the lengths of the steps that meet them, scatter its factor from 2 to 4.
  const System system = coupled_discs(0.0);
  const State there = run(system, tight(), 0.3);
  TimeStepping options = located(1e-3);
  for (const double tolerance : {1e-6, 1e-7, 2e-8, 1e-8, 5e-9, 1e-9, 1e-10}) {
    options.control = StepControl{.tolerance = tolerance};
    EXPECT_LT(distance(run(system, options, 0.3), there), 5.0 * std::pow(tolerance, 2.0 / 3.0)) << tolerance;
  }
}

TEST(Closings, TakeNoMemoryOnceTheyWereSeen) {
  System system;
  add_floor(system, {.friction = 0.1, .normal_restitution = 1.0, .tangential_restitution = 1.0});
  add_disc(system, {0.0, 0.3}, {0.0, 0.0});
  add_disc(system, {0.0, 0.8}, {0.0, 0.0});
  Simulation simulation(system, located(1e-3));
  simulation.run_until(3.0);
  const std::int64_t before = carom_test::allocations(), impacts = simulation.statistics().impacts;
  for (int i = 0; i < 2000; ++i) simulation.step();
  EXPECT_GT(simulation.statistics().impacts, impacts + 5);
  EXPECT_EQ(carom_test::allocations() - before, 0);
}

// A disc that flies at 10 km/s is in a large one at the end of a step, and leaves it by then: past the
// middle.
TEST(Closings, StrikesWhatItWouldHaveLeftAtTheEndOfTheStep) {
  constexpr double speed = 1e4, offset = 0.3, distance = 1.001, mass = 1e-6;
  for (const double start : {-20.0, -20.3, -20.6}) {
    System system;
    system.set_default_law({.friction = 0.0, .normal_restitution = 1.0});
    add_disc(system, {0.0, 0.0}, {0.0, 0.0}, 1.0, 1.0);
    const BodyId shot = add_disc(system, {start, offset}, {speed, 0.0}, 1e-3, mass);
    Simulation simulation(system, located(1e-4));
    simulation.run_until(3e-3);
    // The impulse along the line of centres (-c, s).
    const double s = offset / distance, c = std::sqrt(1.0 - s * s);
    const double impulse = 2.0 * speed * c / (1.0 / mass + 1.0);
    // The closing is found to 1e-12 m, which turns the line of centres by as much.
    EXPECT_NEAR(simulation.state().velocity(shot)[0], speed - impulse / mass * c, 1e-7) << start;
    EXPECT_NEAR(simulation.state().velocity(shot)[1], impulse / mass * s, 1e-7) << start;
  }
}

}  // namespace
