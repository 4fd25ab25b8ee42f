// Mechanisms and free bodies between them, restored at every step: bit for bit as in one run.

#include "tests/integrators/same_run.h"
#include "tests/random.h"
#include "tests/shares.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::bits_of;

/// Pendulums and rods that hang beside discs, and hit each other and these. \param run seeds them
System mechanisms_beside_discs(std::uint64_t run) {
  carom_test::Random random(run);
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.set_default_law({.friction = 0.3, .normal_restitution = 0.3, .tangential_restitution = 0.3});
  for (int i = 0; i < 3; ++i) {
    const double x = 0.5 * i;
    const BodyId hung = system.add(RigidBody{.mass = disc(1.0, 0.1), .position = {x + 0.45, 0.1 * i}});
    system.add(Disc{.body = hung, .radius = 0.1});
    system.add(Rod{.from = {ground, {x, random.uniform(0.0, 0.1)}}, .to = hung});
    const BodyId free = system.add(RigidBody{.mass = disc(0.5, 0.1),
                                             .position = {x + 0.1, random.uniform(-0.25, -0.2)},
                                             .velocity = random.vec<2>(1.0)});
    system.add(Disc{.body = free, .radius = 0.1});
    const BodyId bar = system.add(
        RigidBody{.mass = rod(1.0, 0.4), .position = {x + 0.3, -0.6}, .spin = random.uniform(-9.0, -2.0)});
    system.add(Segment{.body = bar, .from = {-0.2, 0.0}, .to = {0.2, 0.0}, .radius = 0.02});
    system.add(Revolute{.from = {ground, {x + 0.1, -0.6}}, .to = {bar, {-0.2, 0.0}}});
  }
  return system;
}

/// The same with springs from ground to the ends of all bars.
System held(System system) {
  for (std::size_t bar = 2; bar < 9; bar += 3) {
    system.add(SpringDamper{.from = {ground, {0.2 * static_cast<double>(bar), -0.3}},
                            .to = {system.bodies()[bar], {0.2, 0.03}},
                            .stiffness = 40.0,
                            .damping = 0.5});
  }
  return system;
}

/// Restores runs at each of their steps and compares the next one. \param change what is made of the models
void expect_same_bits(const TimeStepping& mode, System (*change)(System)) {
  for (std::uint64_t run = 1; run <= carom_test::usual_or(4U, 1U); ++run) {
    const auto model = [&] { return change(mechanisms_beside_discs(run)); };
    Simulation whole(model(), mode);
    std::size_t joined = 0;
    for (int i = 0; i < 400; ++i) {
      Simulation fresh(model(), mode);
      fresh.restore(whole.checkpoint());
      whole.step();
      fresh.step();
      ASSERT_EQ(bits_of(fresh), bits_of(whole)) << run << " " << i;
      for (const ContactRecord& contact : whole.report().contacts) joined += contact.other.valid() ? 1U : 0U;
    }
    EXPECT_GT(joined, 5U) << run;  // else no island has several components
  }
}

// Bodies that contact joins need not follow one another: where those between them were in the step before
// must not matter. (Gaps were projected to the rounding of their coordinates, too.)
TEST(CheckpointOfMechanisms, ContinuesBitForBitFromEveryStepWithProjectedGaps) {
  expect_same_bits({.step = 1e-3, .project_gaps = true}, [](System system) { return system; });
}

// Loads at the end of a step are those of the state there, to the last bit.
TEST(CheckpointOfMechanisms, ContinuesBitForBitFromEveryStepWithLoadsThatTurn) {
  expect_same_bits({.step = 1e-3}, held);
  expect_same_bits({.step = 1e-3, .impacts = ImpactTimes::located}, held);
}

}  // namespace
