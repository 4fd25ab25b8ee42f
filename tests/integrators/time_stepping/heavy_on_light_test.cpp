// A heavy slab on a layer of light blocks: more contacts than exact solvers are asked for, and masses so
// uneven that sweeps need many more than the budget of even ones.

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace {

using namespace carom;
using namespace carom::planar;

constexpr double g = 9.81, h = 1e-3;

struct Layer {
  System system;
  BodyId slab;

  Layer(int blocks, double mass) {
    constexpr double width = 0.2;
    system.add(Gravity{{0.0, -g}});
    system.set_default_law({.friction = 0.5, .normal_restitution = 0.0});
    system.add(Terrain{.vertices = {{-50.0, 0.0}, {50.0, 0.0}}, .depth = 5.0});
    for (int i = 0; i < blocks; ++i) {
      add_block({width * (i - 0.5 * (blocks - 1)), 0.1}, 1.0, {0.09, 0.1});
    }
    slab = add_block({0.0, 0.4}, mass, {0.5 * width * blocks, 0.2});
  }
  BodyId add_block(const Vec<2>& place, double mass, const Vec<2>& half) {
    const BodyId body =
        system.add(RigidBody{.mass = box(mass, 2.0 * half[0], 2.0 * half[1]), .position = place});
    system.add(Polygon{
        .body = body,
        .vertices = {{-half[0], -half[1]}, {half[0], -half[1]}, {half[0], half[1]}, {-half[0], half[1]}}});
    return body;
  }
};

// The slab carries on 60 or 240 contacts. A block that has a part e too little of its share of the impulse
// M g h/n sinks as if M e/n weighed on it alone: at first, before sweeps know the forces, by up to 1e-4 m.
TEST(HeavyOnLight, TheSlabStaysWhereItLies) {
  for (const int blocks : {15, 60}) {
    for (const double mass : {1e3, 1e6}) {
      const Layer layer(blocks, mass);
      Simulation simulation(layer.system, TimeStepping{.step = h});
      double residual = 0.0;  // of the last 50 steps
      simulation.observe([&](const Simulation& now) {
        if (now.time() < 0.25) return;
        for (const ContactRecord& contact : now.report().contacts) {
          residual = std::max(residual, contact.residual);
        }
      });
      simulation.run_until(0.3);
      EXPECT_GT(simulation.statistics().deepest_gap, -2e-4) << blocks << " " << mass;
      EXPECT_NEAR(simulation.state().position(layer.slab)[1], 0.4, 1e-4) << blocks << " " << mass;
      EXPECT_LT(simulation.state().velocity(layer.slab).norm(), 1e-6) << blocks << " " << mass;
      EXPECT_LT(residual, 1e-5) << blocks << " " << mass;
      EXPECT_LT(std::abs(simulation.state().spin(layer.slab)), 1e-6) << blocks << " " << mass;
      const Vec<2> force = force_on(simulation.report(), layer.slab).mean_force;
      EXPECT_NEAR(force[1], mass * g, 1e-4 * mass * g) << blocks << " " << mass;
    }
  }
}

}  // namespace
