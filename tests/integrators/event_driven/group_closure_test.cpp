// Closures of the joints and closed contacts of a group.

#include <carom/carom.h>
#include <carom/core/assembly.h>
#include <carom/integrators/event_driven/group_closure.h>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

/// The one component of a model, at a state of its own.
struct OneComponent {
  explicit OneComponent(const System& system)
      : assembly(system),
        detector(assembly),
        memory(assembly),
        sample(assembly),
        motion(assembly, detector, {{0}, {}}, options, memory),
        y(motion.size()) {
    motion.model().unknowns.gather(assembly.initial_state(), y);
  }
  Closure close() {
    motion.sample(0.0, y.data(), Forces::all, sample);
    return carom::close(motion, sample, y);
  }

  Assembly assembly;
  Detector detector;
  EventDriven options;
  MotionMemory memory;
  MotionSample sample;
  SmoothMotion motion;
  std::vector<double> y;
};

TEST(GroupClosure, APendulumReturnsToItsRod) {
  System system;
  const BodyId bob = system.add(Particle{.mass = 2.0, .position = {1.0, 0.0}, .velocity = {0.0, 3.0}});
  system.add(Rod{.from = {ground, {0.0, 0.0}}, .to = bob});
  OneComponent pendulum(system);
  pendulum.y[0] += 1e-6;
  pendulum.y[2] += 0.01;  // along the rod
  const Closure result = pendulum.close();
  EXPECT_TRUE(result.changed);
  EXPECT_NEAR(std::hypot(pendulum.y[0], pendulum.y[1]), 1.0, 1e-11);
  EXPECT_NEAR(pendulum.y[2], 0.0, 1e-11);
  EXPECT_NEAR(pendulum.y[3], 3.0, 1e-11);
  EXPECT_NEAR(result.velocity_energy, 0.5 * 2.0 * 0.01 * 0.01, 1e-15);
  EXPECT_NEAR(result.lost, 0.5 * 2.0 * 0.01 * 0.01, 1e-15);
  EXPECT_NEAR(result.shift, 1e-6, 1e-11);
  // On the constraints nothing is taken out.
  EXPECT_NEAR(pendulum.close().lost, 0.0, 1e-12);
}

TEST(GroupClosure, WithoutConstraintsNothingChanges) {
  System system;
  system.add(Particle{.mass = 2.0, .position = {1.0, 0.0}, .velocity = {0.0, 3.0}});
  OneComponent free(system);
  const std::vector<double> before = free.y;
  EXPECT_FALSE(free.close().changed);
  EXPECT_EQ(free.y, before);
}

TEST(GroupClosure, AClosedContactIsBroughtToItsSurface) {
  System system;
  system.add(Particle{.mass = 2.0, .position = {0.0, 1e-7}, .velocity = {1.0, -1e-5}});
  system.add(HalfPlane{.point = {0, 0}, .normal = {0, 1}},
             Surface{.friction = 0.0, .normal_restitution = 0.0});
  OneComponent sliding(system);
  ActiveContact& closed = sliding.motion.active().list().emplace_back();
  closed.pair = sliding.motion.model().pairs.front();
  closed.place = 0;
  closed.mode = ContactMode::slip_positive;
  EXPECT_TRUE(sliding.close().changed);
  EXPECT_NEAR(sliding.y[1], 0.0, 1e-15);
  EXPECT_NEAR(sliding.y[3], 0.0, 1e-15);
  EXPECT_EQ(sliding.y[2], 1.0);
}

}  // namespace
