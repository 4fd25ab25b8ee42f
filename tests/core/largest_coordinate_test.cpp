// How far from the origin bodies are: by their places, not their angles.

#include <carom/carom.h>
#include <carom/core/assembly.h>
#include <carom/core/largest_coordinate.h>

#include <gtest/gtest.h>

namespace {

using namespace carom;
using namespace carom::planar;

TEST(LargestCoordinate, IsThatOfAPlaceOfSomeBodies) {
  System system;
  const BodyId near = system.add(RigidBody{.mass = disc(1.0, 0.1), .position = {0.5, -1.0}, .angle = 100.0});
  const BodyId far = system.add(RigidBody{.mass = disc(1.0, 0.1), .position = {2.0, -7.0}, .angle = -50.0});
  const BodyId particle = system.add(Particle{.mass = 1.0, .position = {3.0, 0.0}});
  const Assembly assembly(system);
  const State state = assembly.initial_state();
  EXPECT_EQ(largest_coordinate(state), 7.0);
  const auto of = [&](BodyId id) {
    const Index body = state.layout()->index(id);
    return largest_coordinate(state, {body, body + 1});
  };
  EXPECT_EQ(of(near), 1.0);
  EXPECT_EQ(of(far), 7.0);
  EXPECT_EQ(of(particle), 3.0);
  EXPECT_EQ(largest_coordinate(state, {0, 0}), 0.0);
}

TEST(LargestCoordinate, IsThatOfPlacesInSpaceToo) {
  System system;
  system.add(spatial::Particle{.mass = 1.0, .position = {1.0, 2.0, -4.0}});
  EXPECT_EQ(largest_coordinate(Assembly(system).initial_state()), 4.0);
}

}  // namespace
