// Steps made again: in another order of parts, a second time, by a stepper that has run elsewhere; and that
// they allocate nothing.

#include "examples/scenes/incline.h"
#include "tests/allocation_counter.h"
#include "tests/integrators/same_run.h"

#include <carom/carom.h>
#include <carom/core/assembly.h>
#include <carom/integrators/run/companion.h>
#include <carom/integrators/time_stepping/time_stepper.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <new>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::bits_of;

constexpr double eps = std::numeric_limits<double>::epsilon();

// A chain of bodies of all kinds with springs, a box on two corners, a disc and a particle in contact.
System busy_scene(const std::vector<std::size_t>& order, std::vector<BodyId>* ids_out = nullptr) {
  // `order` says in which order bodies, and springs among themselves, are added.
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.add(HalfPlane{.normal = incline(0.05)},
             Surface{.friction = 0.3, .normal_restitution = 0.7, .tangential_restitution = 0.7}, "floor");
  std::vector<BodyId> ids(4);
  for (const std::size_t i : order) {
    switch (i) {
      case 0:
        ids[0] = system.add(RigidBody{
            .mass = box(2.0, 1.0, 0.4), .position = {0.0, 0.17}, .angle = 0.05, .velocity = {1.0, -1.0}});
        system.add(Polygon{.body = ids[0], .vertices = {{-0.5, -0.2}, {0.5, -0.2}, {0.5, 0.2}, {-0.5, 0.2}}});
        break;
      case 1:
        ids[1] = system.add(RigidBody{
            .mass = disc(1.0, 0.3), .position = {1.5, 0.34}, .velocity = {-1.0, -0.5}, .spin = 4.0});
        system.add(Disc{.body = ids[1], .radius = 0.3});
        break;
      case 2:
        ids[2] = system.add(Particle{.mass = 0.5, .position = {3.0, 0.1}, .velocity = {0.0, -2.0}});
        break;
      default:
        ids[3] = system.add(Particle{.mass = 0.2, .position = {3.0, 1.5}, .velocity = {1.0, 0.0}});
        break;
    }
  }
  for (const std::size_t i : order) {
    if (i == 3) continue;
    const End<2> from = i == 0 ? End<2>(ids[0], {0.5, 0.2}) : End<2>(ids[i]);
    system.add(SpringDamper{.from = from,
                            .to = ids[i + 1],
                            .stiffness = 100.0 * static_cast<double>(i + 1),
                            .damping = 0.5,
                            .free_length = 1.0});
  }
  if (ids_out != nullptr) *ids_out = ids;
  return system;
}

TEST(TimeStepper, OrderOfInsertionChangesRoundingOnly) {
  std::vector<std::size_t> order{0, 1, 2, 3};
  std::vector<double> reference;
  do {
    std::vector<BodyId> ids;
    Simulation simulation(busy_scene(order, &ids), TimeStepping{.step = 1e-3, .tolerance = 0.0});
    simulation.step();
    EXPECT_GE(simulation.report().contacts.size(), 3u);
    std::vector<double> numbers;
    for (const BodyId id : ids) {
      const State& state = simulation.state();
      numbers.insert(numbers.end(), {state.position(id)[0], state.position(id)[1], state.velocity(id)[0],
                                     state.velocity(id)[1]});
    }
    numbers.push_back(simulation.state().spin(ids[0]));
    numbers.push_back(simulation.state().spin(ids[1]));
    if (reference.empty()) reference = numbers;
    // Sums of forces in another order, through contact problems of condition 10; numbers up to 10.
    for (std::size_t i = 0; i < numbers.size(); ++i) EXPECT_NEAR(numbers[i], reference[i], 1e3 * eps) << i;
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(TimeStepper, SameRunTwiceIsTheSameBitForBit) {
  const auto run = [] {
    Simulation simulation(busy_scene({0, 1, 2, 3}), TimeStepping{.step = 1e-3});
    simulation.run_until(2.0);
    return bits_of(simulation);
  };
  const auto first = run();
  // Whatever ran before in the process does not matter.
  Simulation other(busy_scene({3, 1, 0, 2}), TimeStepping{.step = 3e-3});
  other.run_until(0.3);
  EXPECT_EQ(run(), first);
}

TEST(TimeStepper, HistoryOfTheMachineDoesNotMatter) {
  // A stepper owns workspaces only: one that has run elsewhere makes the same step as a new one.
  const Assembly assembly(busy_scene({0, 1, 2, 3}));
  TimeStepper used(assembly, TimeStepping{.step = 1e-3}), fresh(assembly, TimeStepping{.step = 1e-3});
  const auto companion_of = [](const State& state) {
    Companion companion;
    companion.rounding.assign(state.v.size(), 0.0);
    return companion;
  };
  State elsewhere = assembly.initial_state();
  Companion along = companion_of(elsewhere);
  StepReport report;
  for (int i = 0; i < 500; ++i) used.step(elsewhere, along, 1e-3, 1e-3 * (i + 1), report);

  State a = assembly.initial_state(), b = assembly.initial_state();
  Companion ca = companion_of(a), cb = companion_of(b);
  used.step(a, ca, 1e-3, 1e-3, report);
  fresh.step(b, cb, 1e-3, 1e-3, report);
  EXPECT_EQ(carom_test::motion_bits(a), carom_test::motion_bits(b));
  EXPECT_EQ(ca.rounding, cb.rounding);
  EXPECT_EQ(ca.ledger.save(), cb.ledger.save());
}

TEST(TimeStepper, NothingIsAllocatedInTheSteadyState) {
  // The warm-up meets as many contacts as the run will see at once, and the worst contraction (the couplings
  // are rated anew whenever it has doubled, a few times in a run). From then on memory is reused.
  Simulation simulation(busy_scene({0, 1, 2, 3}), TimeStepping{.step = 1e-3});
  const std::int64_t at_start = carom_test::allocations();
  ::operator delete(::operator new(1));  // a call, which unlike a new-expression no compiler may leave out
  ASSERT_GT(carom_test::allocations(), at_start);  // the counter counts
  simulation.run_until(4.0);                       // bouncing, then sliding on two corners
  const std::int64_t contacts_before = simulation.statistics().contact_steps;
  const std::int64_t before = carom_test::allocations();
  for (int i = 0; i < 1000; ++i) simulation.step();
  EXPECT_EQ(carom_test::allocations() - before, 0);
  EXPECT_GE(simulation.statistics().contact_steps - contacts_before, 1000);
}

}  // namespace
