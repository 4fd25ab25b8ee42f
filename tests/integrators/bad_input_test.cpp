// Models, states and options that cannot be are refused where they enter, by name, with the value and what is
// allowed; nothing has changed afterwards.

#include "tests/integrators/same_run.h"
#include "tests/integrators/throws.h"
#include "tests/model_error.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::bits_of;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

System particle() {
  System system;
  system.add(Particle{.mass = 1.0, .position = {0.0, 1.0}}, "ball");
  return system;
}

TEST(BadInput, EveryOptionOfTimeStepping) {
  const auto refused = [](const TimeStepping& options, const char* name, const char* value) {
    EXPECT_MODEL_ERROR(Simulation(particle(), options), "time stepping", name, value, "allowed");
    Simulation simulation(particle(), TimeStepping{});
    const auto before = bits_of(simulation);
    EXPECT_MODEL_ERROR(simulation.switch_to(options), "time stepping", name, value, "allowed");
    EXPECT_EQ(bits_of(simulation), before);
    EXPECT_EQ(std::get<TimeStepping>(simulation.mode()).step, TimeStepping{}.step);
    simulation.step();  // it still runs
  };
  refused({.step = 0.0}, "step", "is 0");
  refused({.step = -1e-3}, "step", "-0.001");
  refused({.step = nan}, "step", "nan");
  refused({.step = infinity}, "step", "inf");
  refused({.tolerance = -1.0}, "tolerance", "-1");
  refused({.tolerance = nan}, "tolerance", "nan");
  refused({.tolerance = infinity}, "tolerance", "inf");
  refused({.max_sweeps = 1}, "max_sweeps", "is 1");
  refused({.max_sweeps = -5}, "max_sweeps", "-5");
  refused({.capture_speed = -0.1}, "capture_speed", "-0.1");
  refused({.capture_speed = nan}, "capture_speed", "nan");
  refused({.capture_speed = infinity}, "capture_speed", "inf");
  // The borders are allowed.
  EXPECT_NO_THROW(
      Simulation(particle(), TimeStepping{.tolerance = 0.0, .max_sweeps = 2, .capture_speed = 0.0}).step());
}

TEST(BadInput, AnEmptyModel) {
  EXPECT_MODEL_ERROR(Simulation(System(), TimeStepping{}), "bodies", "0", "at least one");
}

TEST(BadInput, AContactWithoutALaw) {
  System system = particle();
  system.add(HalfPlane{.normal = {0.0, 1.0}}, "floor");
  EXPECT_MODEL_ERROR(Simulation(system, TimeStepping{}), "particle 'ball'", "half-plane 'floor'", "law",
                     "allowed");
  // Not asked for where nothing can touch.
  System bare;
  bare.add(Particle{.mass = 1.0, .contact = false});
  bare.add(HalfPlane{.normal = {0.0, 1.0}});
  EXPECT_NO_THROW(Simulation(bare, TimeStepping{}));
  // One of several materials.
  System materials;
  const MaterialId steel = materials.material("steel"), wood = materials.material("wood"),
                   stone = materials.material("stone");
  materials.add(HalfPlane{.normal = {0.0, 1.0}, .material = stone}, "floor");
  materials.between(steel, stone, Surface{.friction = 0.1, .normal_restitution = 0.5});
  materials.add(Particle{.mass = 1.0, .material = steel}, "good");
  const BodyId body = materials.add(RigidBody{.mass = disc(1.0, 1.0)}, "log");
  materials.add(Disc{.body = body, .radius = 1.0, .material = wood}, "bark");
  EXPECT_MODEL_ERROR(Simulation(materials, TimeStepping{}), "disc 'bark'", "rigid body 'log'",
                     "half-plane 'floor'", "law");
  materials.between(stone, wood, Surface{.friction = 0.1, .normal_restitution = 0.5});
  EXPECT_NO_THROW(Simulation(materials, TimeStepping{}));
}

TEST(BadInput, StatesThatAreNoNumbers) {
  System system = particle();
  system.add(RigidBody{.mass = disc(1.0, 1.0)}, "wheel");
  Simulation simulation(std::move(system), TimeStepping{});
  const auto before = bits_of(simulation);
  const BodyId ball = simulation.system().body("ball"), wheel = simulation.system().body("wheel");
  for (const double bad : {nan, infinity, -infinity}) {
    const std::string value = to_text(bad);
    State state = simulation.state();
    state.position(ball)[1] = bad;
    EXPECT_MODEL_ERROR(simulation.set_state(state), "particle 'ball'", "coordinate", value);
    state = simulation.state();
    state.velocity(wheel)[0] = bad;
    EXPECT_MODEL_ERROR(simulation.set_state(state), "rigid body 'wheel'", "velocity", value);
    state = simulation.state();
    state.spin(wheel) = bad;
    EXPECT_MODEL_ERROR(simulation.set_state(state), "rigid body 'wheel'", "velocity", value);
    state = simulation.state();
    state.time = bad;
    EXPECT_MODEL_ERROR(simulation.set_state(state), "time", value);
  }
  EXPECT_EQ(bits_of(simulation), before);
}

TEST(BadInput, StatesOfOtherModels) {
  Simulation simulation(particle(), TimeStepping{}), other(particle(), TimeStepping{});
  const auto before = bits_of(simulation);
  EXPECT_MODEL_ERROR(simulation.set_state(other.state()), "state", "another");
  EXPECT_MODEL_ERROR(simulation.set_state(State()), "state");
  State longer = simulation.state();
  longer.q.push_back(0.0);
  EXPECT_MODEL_ERROR(simulation.set_state(longer), "state", "number of coordinates");
  State internal = simulation.state();
  internal.z.push_back(0.0);
  EXPECT_MODEL_ERROR(simulation.set_state(internal), "state");
  EXPECT_EQ(bits_of(simulation), before);
}

TEST(BadInput, Times) {
  Simulation simulation(particle(), TimeStepping{});
  simulation.run_until(0.5);
  const auto before = bits_of(simulation);
  EXPECT_MODEL_ERROR(simulation.run_until(nan), "run_until", "nan", "finite");
  EXPECT_MODEL_ERROR(simulation.run_until(infinity), "run_until", "inf", "finite");
  EXPECT_MODEL_ERROR(simulation.run_until(0.4), "run_until", "0.4", "0.5");
  EXPECT_MODEL_ERROR(simulation.every(0.0, [](Simulation&) {}), "every", "is 0", "> 0");
  EXPECT_MODEL_ERROR(simulation.every(-1.0, [](Simulation&) {}), "every", "-1");
  EXPECT_MODEL_ERROR(simulation.every(nan, [](Simulation&) {}), "every", "nan");
  EXPECT_MODEL_ERROR(simulation.every(1.0, {}), "every", "empty");
  EXPECT_MODEL_ERROR(simulation.observe({}), "observe", "empty");
  EXPECT_EQ(bits_of(simulation), before);
}

TEST(BadInput, RunningFromWithin) {
  Simulation simulation(particle(), TimeStepping{.step = 1e-3});
  int refused = 0;
  simulation.every(0.01, [&](Simulation& now) {
    for (const bool until : {true, false}) {
      try {
        if (until) {
          now.run_until(1.0);
        } else {
          now.step();
        }
      } catch (const ModelError& error) {
        EXPECT_NE(std::string(error.what()).find("from outside"), std::string::npos);
        ++refused;
      }
    }
  });
  simulation.run_until(0.05);
  EXPECT_EQ(refused, 10);
  EXPECT_EQ(simulation.time(), 0.05);
}

}  // namespace
