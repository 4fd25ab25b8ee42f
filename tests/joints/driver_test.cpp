#include <carom/joints/driver.h>
#include <carom/joints/gravity.h>
#include <carom/joints/prismatic.h>
#include <carom/joints/revolute.h>
#include <carom/joints/rod.h>
#include <carom/testing/loaded_model.h>

#include "tests/joints/element_pairs.h"
#include "tests/joints/joint_model.h"
#include "tests/model_error.h"

#include <functional>
#include <limits>
#include <string>

namespace {

using namespace carom;
using namespace carom::planar;
using namespace carom_test;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

using Law = std::function<double(double)>;

/// A turning table with a slide on it, and joints without a coordinate.
struct Table {
  System system;
  BodyId table, slider, dot;
  JointId pin, slide, rod, particle_pin;
  Table() {
    table = system.add(RigidBody{.mass = disc(2.0, 1.0), .angle = 0.4, .spin = 0.5}, "table");
    slider = system.add(
        RigidBody{
            .mass = disc(0.5, 0.2), .position = {0.5, 0.75}, .angle = -0.3, .velocity = {1, 2}, .spin = -1.0},
        "slider");
    dot = system.add(Particle{.mass = 1.0, .position = {3, 4}}, "dot");
    pin = system.add(Revolute{.from = ground, .to = table}, "pin");
    slide = system.add(Prismatic{.from = {table, {0.2, 0.1}}, .to = {slider, {0.1, 0.0}}, .axis = {3, 4}},
                       "slide");
    rod = system.add(Rod{.from = slider, .to = dot}, "rod");
    particle_pin = system.add(Revolute{.from = {ground, {3, 4}}, .to = dot}, "nail");
  }
};

TEST(Driver, RowsMeetDifferences) {
  Random random(331);
  const Law position = [](double t) { return std::sin(2.0 * t); };
  const Law velocity = [](double t) { return 2.0 * std::cos(2.0 * t); };
  const Law acceleration = [](double t) { return -4.0 * std::sin(2.0 * t); };
  for (int repeat = 0; repeat < 10; ++repeat) {
    Table table;
    const JointId one = table.system.add(
        Driver{.joint = table.pin, .position = position, .velocity = velocity, .acceleration = acceleration});
    const JointId two = table.system.add(Driver{
        .joint = table.slide, .position = position, .velocity = velocity, .acceleration = acceleration});
    JointModel model(table.system);
    for (double& q : model.state.q) q += random.uniform(-0.1, 0.1);
    model.state.time = random.uniform(0.0, 3.0);
    model.update();
    for (const JointId driver : {one, two}) {
      EXPECT_TRUE(model.kind(driver).depends_on_time());
      expect_pattern_fits(model, driver);
      expect_rows_meet_differences(model, driver, random);
    }
  }
}

TEST(Driver, ItsGapIsWhatTheCoordinateIsBeyondThePosition) {
  Table table;
  const JointId driver =
      table.system.add(Driver{.joint = table.pin, .position = [](double t) { return 0.5 + t * t; }});
  JointModel model(table.system);
  model.state.angle(table.table) += 3.0;
  model.state.time = 1.25;
  model.update();
  const std::vector<JointRow> rows = model.rows(driver);
  EXPECT_NEAR(rows[0].gap, 3.0 - 0.5 - 1.25 * 1.25, 1e-15);
  EXPECT_NEAR(rows[0].rate, -2.5, 1e-9);
  EXPECT_NEAR(rows[0].drift, -2.0, 1e-6);
}

TEST(Driver, RatesThatAreNotGivenAreDifferencesWithinBreaks) {
  // The position is steady until 1 s, then goes on at 3 m/s; at the kink the motion to come counts.
  Table table;
  const JointId driver =
      table.system.add(Driver{.joint = table.slide,
                              .position = [](double t) { return t < 1.0 ? 0.0 : 3.0 * (t - 1.0); },
                              .breaks = {1.0}});
  JointModel model(table.system);
  for (const auto& [time, rate] :
       {std::pair(0.5, 0.0), std::pair(1.0 - 1e-9, 0.0), std::pair(1.0, 3.0), std::pair(2.0, 3.0)}) {
    model.state.time = time;
    model.update();
    EXPECT_NEAR(model.rows(driver)[0].rate, -rate, 1e-9) << time;
  }
  std::vector<double> breaks;
  model.kind(driver).discontinuity_times(model.slot(driver), breaks);
  EXPECT_EQ(breaks, std::vector{1.0});
}

TEST(Driver, ItsMultiplierIsTheMomentItTakes) {
  System system;
  const BodyId rotor = system.add(RigidBody{.mass = disc(2.0, 3.0)});
  const JointId pin = system.add(Revolute{.from = ground, .to = rotor});
  const JointId driver = system.add(Driver{.joint = pin,
                                           .position = [](double t) { return 0.25 * t * t; },
                                           .velocity = [](double t) { return 0.5 * t; },
                                           .acceleration = [](double) { return 0.5; }});
  JointModel model(system);
  expect_near(model.acceleration(), {0.0, 0.0, 0.5}, 1e-13);
  EXPECT_NEAR(model.reaction(driver).moment, 0.5 * 9.0, 1e-12);
  EXPECT_NEAR(model.reaction(pin).force[0], 0.0, 1e-12);
}

TEST(Driver, ItsMultiplierIsTheForceItTakesAlongAnAxis) {
  // A lift.
  System system;
  system.add(Gravity{{0, -10.0}});
  const BodyId cabin = system.add(RigidBody{.mass = disc(2.0, 1.0)});
  const JointId slide = system.add(Prismatic{.from = ground, .to = cabin, .axis = {0, 2}});
  const JointId driver = system.add(Driver{.joint = slide,
                                           .position = [](double t) { return 1.5 * t * t; },
                                           .velocity = [](double t) { return 3.0 * t; },
                                           .acceleration = [](double) { return 3.0; }});
  JointModel model(system);
  expect_near(model.acceleration(), {0.0, 3.0, 0.0}, 1e-13);
  EXPECT_NEAR(model.reaction(driver).moment, 2.0 * 13.0, 1e-12);
}

TEST(Driver, ALawThatIsNotFiniteNamesDriverAndTime) {
  Table table;
  const Law broken = [](double t) { return t > 1.0 ? nan : 0.0; };
  const Law good = [](double) { return 0.0; };
  for (const auto& [what, part] :
       {std::pair("position",
                  Driver{.joint = table.pin, .position = broken, .velocity = good, .acceleration = good}),
        std::pair("velocity",
                  Driver{.joint = table.pin, .position = good, .velocity = broken, .acceleration = good}),
        std::pair("acceleration",
                  Driver{.joint = table.pin, .position = good, .velocity = good, .acceleration = broken})}) {
    System system = table.system;
    const JointId driver = system.add(part, "crank");
    JointModel model(system);
    static_cast<void>(model.rows(driver));
    model.state.time = 2.0;
    try {
      static_cast<void>(model.rows(driver));
      ADD_FAILURE() << "nothing was thrown";
    } catch (const SolverError& error) {
      const std::string message = error.what();
      EXPECT_NE(message.find("driver 'crank': " + std::string(what) + " at t = 2 s is nan; allowed"),
                std::string::npos)
          << message;
    }
  }
}

TEST(Driver, ImpossibleParametersAreRefusedByName) {
  Table table;
  System& system = table.system;
  const Law good = [](double) { return 0.0; };
  const Law bad = [](double) { return nan; };
  System elsewhere;
  const BodyId body = elsewhere.add(RigidBody{.mass = disc(1.0, 1.0)});
  const JointId foreign = elsewhere.add(Revolute{.from = ground, .to = body});
  const JointId gone = system.add(Revolute{.from = ground, .to = table.slider});
  system.remove(gone);
  EXPECT_MODEL_ERROR(system.add(Driver{.position = good}), "driver #5", "joint is not given",
                     "allowed: a joint of this system");
  EXPECT_MODEL_ERROR(system.add(Driver{.joint = foreign, .position = good}),
                     "joint is part of another system", "allowed: a joint of this system");
  EXPECT_MODEL_ERROR(system.add(Driver{.joint = gone, .position = good}), ", which was removed",
                     "allowed: a joint of this system");
  EXPECT_MODEL_ERROR(system.add(Driver{.joint = table.rod, .position = good}, "pump"), "driver 'pump'",
                     "joint is rod 'rod'", "allowed: a joint with a coordinate");
  EXPECT_MODEL_ERROR(system.add(Driver{.joint = table.particle_pin, .position = good}),
                     "joint is revolute joint 'nail', of particles", "allowed: a joint with a coordinate");
  EXPECT_MODEL_ERROR(system.add(Driver{.joint = table.pin}), "position is not given",
                     "allowed: a function of time");
  EXPECT_MODEL_ERROR(system.add(Driver{.joint = table.pin, .position = good, .acceleration = good}),
                     "velocity is not given", "allowed: a function of time where there is an acceleration");
  EXPECT_MODEL_ERROR(system.add(Driver{.joint = table.pin, .position = bad}), "position at time 0 is nan",
                     "allowed: a finite number");
  EXPECT_MODEL_ERROR(system.add(Driver{.joint = table.pin, .position = good, .velocity = bad}),
                     "velocity at time 0 is nan");
  EXPECT_MODEL_ERROR(
      system.add(Driver{.joint = table.pin, .position = good, .velocity = good, .acceleration = bad}),
      "acceleration at time 0 is nan");
  EXPECT_MODEL_ERROR(system.add(Driver{.joint = table.pin, .position = good, .breaks = {2.0, 1.0}}),
                     "breaks is 1 s after 2 s", "allowed: ascending times");
  EXPECT_MODEL_ERROR(system.add(Driver{.joint = table.pin, .position = good, .breaks = {nan}}),
                     "breaks is nan s");
  const JointId driver = system.add(Driver{.joint = table.pin, .position = good}, "crank");
  EXPECT_MODEL_ERROR(system.add(Driver{.joint = table.pin, .position = good}),
                     "joint is revolute joint 'pin', which driver 'crank' drives",
                     "allowed: a joint without a driver");
  EXPECT_MODEL_ERROR(system.add(Driver{.joint = driver, .position = good}), "joint is driver 'crank'",
                     "allowed: a joint with a coordinate");
  // Its place is free again.
  system.remove(driver);
  system.add(Driver{.joint = table.pin, .position = good});
}

TEST(Driver, WhatIsInUseIsNotRemoved) {
  Table table;
  System& system = table.system;
  const JointId driver =
      system.add(Driver{.joint = table.pin, .position = [](double) { return 0.0; }}, "crank");
  const ElementId motor =
      system.add(Motor{.joint = table.slide, .torque = [](double, double, double) { return 0.0; }}, "ram");
  EXPECT_MODEL_ERROR(system.remove(table.pin), "revolute joint 'pin': cannot be removed",
                     "driver 'crank' acts on its coordinate", "allowed: a joint without drivers");
  EXPECT_MODEL_ERROR(system.remove(table.slide), "prismatic joint 'slide': cannot be removed",
                     "motor 'ram' acts on its coordinate", "allowed: a joint without drivers");
  EXPECT_MODEL_ERROR(system.remove(table.dot), "particle 'dot': cannot be removed",
                     "revolute joint 'nail' binds it", "allowed: a body without joints");
  system.remove(table.particle_pin);
  EXPECT_MODEL_ERROR(system.remove(table.dot), "rod 'rod' binds it");
  system.remove(table.rod);
  EXPECT_MODEL_ERROR(system.remove(table.rod), "removal of joint #2", "not in this system", "allowed");
  EXPECT_MODEL_ERROR(system.remove(JointId{}), "removal of joint that was never given");
  system.remove(table.dot);
  EXPECT_EQ(system.joints(), (std::vector{table.pin, table.slide, driver}));
  EXPECT_EQ(system.joint("crank"), driver);
  EXPECT_MODEL_ERROR(system.joint("rod"), "joint 'rod'", "there is none");
  // The others still work after one is gone.
  system.remove(driver);
  system.remove(table.pin);
  const JointModel model(system);
  EXPECT_NEAR(model.state.coordinate(table.slide), 0.0, 1e-15);
  EXPECT_EQ(largest(model.external), 0.0);
  system.remove(motor);
  system.remove(table.slide);
  EXPECT_TRUE(system.joints().empty());
}

TEST(Motor, PushesToAgainstFrom) {
  System system;
  const BodyId a = system.add(RigidBody{.mass = disc(1.0, 1.0), .angle = 1.0, .spin = 0.5});
  const BodyId b = system.add(RigidBody{.mass = disc(1.0, 1.0), .angle = 10.0, .spin = 3.0});
  const JointId pin = system.add(Revolute{.from = a, .to = b, .zero_angle = 0.0});
  const auto law = [](double t, double angle, double rate) { return t + 10.0 * angle + 100.0 * rate; };
  system.add(Motor{.joint = pin, .torque = law});
  LoadedModel model(system);
  model.state.time = 2.0;
  model.update();
  expect_near(model.external, {0, 0, -342, 0, 0, 342}, 1e-12);
  expect_action_is_reaction(model);
  EXPECT_EQ(largest(model.conservative), 0.0);
  EXPECT_EQ(largest(model.dissipative), 0.0);
}

TEST(Motor, ActionIsReactionAndPowerIsForceTimesRate) {
  Random random(332);
  for (int repeat = 0; repeat < 20; ++repeat) {
    const Bodies bodies(random);
    for (const auto& [from, to] : pairs_of_ends(bodies, random)) {
      System system = bodies.system;
      if (from.body != ground && !system.has_orientation(from.body)) continue;
      const JointId slot = system.add(PointOnLine{.from = from, .to = to, .axis = random.vec<2>()});
      double power = 0.0, seen = 0.0, rate_seen = 0.0;
      system.add(Motor{.joint = slot, .torque = [&](double, double distance, double rate) {
                         seen = distance;
                         rate_seen = rate;
                         power = (2.0 + rate) * rate;
                         return 2.0 + rate;
                       }});
      const LoadedModel model(system);
      EXPECT_NEAR(seen, model.state.coordinate(slot), 1e-15);
      EXPECT_NEAR(rate_seen, model.state.rate(slot), 1e-14);
      EXPECT_NEAR(model.power(model.external), power, 1e-12 * (1.0 + largest(model.external)));
      if (from.body != ground && to.body != ground) expect_action_is_reaction(model);
    }
  }
}

TEST(Motor, ImpossibleParametersAreRefusedByName) {
  Table table;
  System& system = table.system;
  const auto good = [](double, double, double) { return 1.0; };
  System elsewhere;
  const BodyId body = elsewhere.add(RigidBody{.mass = disc(1.0, 1.0)});
  const JointId foreign = elsewhere.add(Revolute{.from = ground, .to = body});
  EXPECT_MODEL_ERROR(system.add(Motor{.torque = good}), "motor #0", "joint is not given",
                     "allowed: a joint of this system");
  EXPECT_MODEL_ERROR(system.add(Motor{.joint = foreign, .torque = good}), "joint is part of another system");
  EXPECT_MODEL_ERROR(system.add(Motor{.joint = table.rod, .torque = good}, "m"), "motor 'm'",
                     "joint is rod 'rod'", "allowed: a joint with a coordinate");
  EXPECT_MODEL_ERROR(system.add(Motor{.joint = table.particle_pin, .torque = good}),
                     "joint is revolute joint 'nail', of particles");
  EXPECT_MODEL_ERROR(system.add(Motor{.joint = table.pin}), "torque is not given",
                     "allowed: a function of time, coordinate and rate");
  EXPECT_MODEL_ERROR(system.add(Motor{.joint = table.pin, .torque = good, .breaks = {1.0, 1.0}}),
                     "breaks is 1 s after 1 s", "allowed: ascending times");
  EXPECT_TRUE(system.elements().empty());
}

TEST(Driver, FingerprintChangesWithEveryParameter) {
  const Law good = [](double) { return 0.0; };
  const auto torque = [](double, double, double) { return 0.0; };
  const auto print = [&](const auto& part) {
    Table table;
    table.system.add(part(table));
    return table.system.fingerprint();
  };
  const std::vector<std::uint64_t> prints{
      Table().system.fingerprint(),
      print([&](const Table& t) { return Driver{.joint = t.pin, .position = good}; }),
      print([&](const Table& t) { return Driver{.joint = t.slide, .position = good}; }),
      print([&](const Table& t) { return Driver{.joint = t.pin, .position = good, .breaks = {1.0}}; }),
      print([&](const Table& t) { return Driver{.joint = t.pin, .position = good, .breaks = {2.0}}; }),
      print([&](const Table& t) { return Motor{.joint = t.pin, .torque = torque}; }),
      print([&](const Table& t) { return Motor{.joint = t.slide, .torque = torque}; }),
      print([&](const Table& t) { return Motor{.joint = t.pin, .torque = torque, .breaks = {1.0}}; })};
  for (std::size_t i = 0; i < prints.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(prints[i], prints[j]) << i << " and " << j;
  }
  // Names do not count; a copy is the same.
  Table named;
  named.system.add(Driver{.joint = named.pin, .position = good}, "crank");
  EXPECT_EQ(named.system.fingerprint(), prints[1]);
  EXPECT_EQ(System(named.system).fingerprint(), prints[1]);
}

}  // namespace
