#include <carom/bodies/particle.h>
#include <carom/bodies/rigid_body.h>
#include <carom/core/assembly.h>
#include <carom/core/dynamics/total_momentum.h>

#include <gtest/gtest.h>

namespace {

using namespace carom;

TEST(TotalMomentum, InThePlane) {
  System system;
  system.add(planar::Particle{.mass = 2.0, .position = {1.0, 2.0}, .velocity = {3.0, -1.0}});
  system.add(planar::RigidBody{.mass = {.mass = 4.0, .inertia = 0.5},
                               .position = {-1.0, 0.5},
                               .angle = 0.7,
                               .velocity = {0.5, 2.0},
                               .spin = 3.0});
  const Assembly assembly(system);
  const TotalMomentum sum = total_momentum(assembly, assembly.initial_state());
  EXPECT_EQ(sum.linear, (std::array{6.0 + 2.0, -2.0 + 8.0, 0.0}));
  // x p_y - y p_x + I w
  EXPECT_EQ(sum.angular, (std::array{0.0, 0.0, (-2.0 - 12.0) + (-8.0 - 1.0) + 1.5}));
  EXPECT_EQ(sum.linear_scale, 8.0);
  EXPECT_EQ(sum.angular_scale, 12.0);
}

TEST(TotalMomentum, InSpace) {
  System system;
  system.add(spatial::Particle{.mass = 2.0, .position = {1.0, 2.0, 3.0}, .velocity = {-1.0, 0.5, 2.0}});
  const Assembly assembly(system);
  const TotalMomentum sum = total_momentum(assembly, assembly.initial_state());
  EXPECT_EQ(sum.linear, (std::array{-2.0, 1.0, 4.0}));
  EXPECT_EQ(sum.angular, (std::array{2.0 * 4.0 - 3.0, -6.0 - 4.0, 1.0 + 4.0}));
}

}  // namespace
