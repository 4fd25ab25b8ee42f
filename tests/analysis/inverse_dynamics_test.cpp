#include <carom/carom.h>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

constexpr double g = 9.81;

std::vector<double> even_times(double end, int count) {
  std::vector<double> times;
  for (int i = 0; i <= count; ++i) times.push_back(end * i / count);
  return times;
}

// theta = a sin(w t) from the vertical: I theta'' + m g (l/2) sin(theta).
TEST(InverseDynamics, SwungPendulum) {
  constexpr double mass = 1.2, length = 0.9, a = 1.4, w = 3.0;
  System system;
  system.add(Gravity{{0.0, -g}});
  const BodyId body = system.add(RigidBody{
      .mass = rod(mass, length), .position = {0.0, -0.5 * length}, .angle = -0.5 * std::numbers::pi});
  const JointId pin = system.add(Revolute{.from = ground, .to = {body, {-0.5 * length, 0.0}}});
  const JointId driver =
      system.add(Driver{.joint = pin,
                        .position = [](double t) { return a * std::sin(w * t); },
                        .velocity = [](double t) { return a * w * std::cos(w * t); },
                        .acceleration = [](double t) { return -a * w * w * std::sin(w * t); }});
  const InverseDynamics result = inverse_dynamics(system, even_times(2.0, 80));
  ASSERT_EQ(result.drivers, std::vector<JointId>{driver});
  ASSERT_EQ(result.samples.size(), 81U);
  for (const DriverForces& sample : result.samples) {
    const double t = sample.state.time, angle = a * std::sin(w * t);
    const double torque =
        -mass * length * length / 3.0 * w * w * angle + 0.5 * mass * g * length * std::sin(angle);
    EXPECT_NEAR(sample.state.coordinate(pin), angle, 1e-12) << t;
    EXPECT_NEAR(sample.forces[0], torque, 1e-8) << t;
    EXPECT_NEAR(sample.powers[0], torque * a * w * std::cos(w * t), 1e-8) << t;
  }
}

// A slide that a motor pushes with F cos(w t) moves by F/(m w^2) (1 - cos(w t)): simulated with the motor,
// then driven along that motion.
TEST(InverseDynamics, MotorOfASlideComesBack) {
  constexpr double mass = 3.0, push = 7.0, w = 5.0, far = push / (mass * w * w);
  const auto slide = [](System& system) {
    const BodyId body = system.add(RigidBody{.mass = box(mass, 0.2, 0.1)});
    return system.add(Prismatic{.from = ground, .to = body, .axis = {1.0, 0.0}});
  };
  System pushed;
  const JointId guide = slide(pushed);
  pushed.add(
      Motor{.joint = guide, .torque = [](double t, double, double) { return push * std::cos(w * t); }});
  EventDriven mode;
  mode.relative_tolerance = 1e-12;
  mode.absolute_tolerance = 1e-14;
  Simulation simulation(pushed, mode);
  for (const double t : {0.3, 0.9, 1.7}) {
    simulation.run_until(t);
    EXPECT_NEAR(simulation.state().coordinate(guide), far * (1.0 - std::cos(w * t)), 1e-9);
  }
  System driven;
  driven.add(Driver{.joint = slide(driven),
                    .position = [](double t) { return far * (1.0 - std::cos(w * t)); },
                    .velocity = [](double t) { return far * w * std::sin(w * t); },
                    .acceleration = [](double t) { return far * w * w * std::cos(w * t); }});
  for (const DriverForces& sample : inverse_dynamics(driven, even_times(2.0, 40)).samples) {
    EXPECT_NEAR(sample.forces[0], push * std::cos(w * sample.state.time), 1e-8);
  }
}

/// Two links that hang, l = 1 m, m = 1 kg, moving with `spin`. Returns the two pins.
std::vector<JointId> add_arm(System& system, double spin) {
  system.add(Gravity{{0.0, -g}});
  std::vector<JointId> pins;
  End<2> before(ground);
  for (int i = 0; i < 2; ++i) {
    const double depth = i + 0.5;
    const BodyId link = system.add(RigidBody{.mass = rod(1.0, 1.0),
                                             .position = {0.0, -depth},
                                             .angle = -0.5 * std::numbers::pi,
                                             .velocity = {depth * spin, 0.0},
                                             .spin = spin});
    pins.push_back(system.add(Revolute{.from = before, .to = {link, {-0.5, 0.0}}}));
    before = End<2>(link, {0.5, 0.0});
  }
  return pins;
}

// The torques of a driven arm, given to motors, move it as it was driven.
TEST(InverseDynamics, MotorsRepeatWhatDriversDid) {
  constexpr double a = 0.8, w = 4.0, b = 0.6;
  const auto first = [](double t) { return a * std::sin(w * t); };
  const auto second = [](double t) { return b * (1.0 - std::cos(w * t)); };
  System driven;
  const std::vector<JointId> pins = add_arm(driven, a * w);
  const JointId shoulder =
      driven.add(Driver{.joint = pins[0],
                        .position = first,
                        .velocity = [](double t) { return a * w * std::cos(w * t); },
                        .acceleration = [](double t) { return -a * w * w * std::sin(w * t); }});
  driven.add(Driver{.joint = pins[1],
                    .position = second,
                    .velocity = [](double t) { return b * w * std::sin(w * t); },
                    .acceleration = [](double t) { return b * w * w * std::cos(w * t); }});
  // Torques at Chebyshev's points of 0 to 1 s, between them the barycentric polynomial.
  constexpr int order = 48;
  std::vector<double> times, weights;
  for (int i = 0; i <= order; ++i) {
    times.push_back(0.5 - 0.5 * std::cos(std::numbers::pi * i / order));
    weights.push_back((i % 2 == 0 ? 1.0 : -1.0) * (i == 0 || i == order ? 0.5 : 1.0));
  }
  const InverseDynamics result = inverse_dynamics(driven, times);
  ASSERT_EQ(result.drivers.front(), shoulder);
  const auto torque = [&](std::size_t driver) {
    return [&result, times, weights, driver](double t, double, double) {
      double sum = 0.0, total = 0.0;
      for (std::size_t i = 0; i < times.size(); ++i) {
        const double value = result.samples[i].forces[driver];
        if (t == times[i]) return value;
        sum += weights[i] / (t - times[i]) * value;
        total += weights[i] / (t - times[i]);
      }
      return sum / total;
    };
  };
  System moved;
  const std::vector<JointId> same = add_arm(moved, a * w);
  moved.add(Motor{.joint = same[0], .torque = torque(0)});
  moved.add(Motor{.joint = same[1], .torque = torque(1)});
  EventDriven mode;
  mode.relative_tolerance = 1e-12;
  mode.absolute_tolerance = 1e-13;
  Simulation simulation(moved, mode);
  for (const double t : {0.25, 0.5, 0.75, 1.0}) {
    simulation.run_until(t);
    EXPECT_NEAR(simulation.state().coordinate(same[0]), first(t), 1e-8) << t;
    EXPECT_NEAR(simulation.state().coordinate(same[1]), second(t), 1e-8) << t;
  }
}

TEST(InverseDynamics, SaysWhatFails) {
  const std::vector<double> start{0.0};
  const auto message = [&](const System& system) -> std::string {
    try {
      static_cast<void>(inverse_dynamics(system, start));
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  };
  System system;
  const std::vector<JointId> pins = add_arm(system, 0.0);
  EXPECT_NE(message(system).find("no driver"), std::string::npos);
  const auto still = [](double) { return 0.0; };
  system.add(Driver{.joint = pins[0], .position = still}, "one");
  EXPECT_NE(message(system).find("leave 1 degrees of freedom"), std::string::npos) << message(system);
  system.add(Driver{.joint = pins[1], .position = still}, "two");
  EXPECT_EQ(message(system), "");
  // A parallelogram whose two cranks are both driven.
  System bars;
  std::vector<BodyId> links;
  for (const double x : {0.0, 1.0}) {
    links.push_back(
        bars.add(RigidBody{.mass = rod(1.0, 1.0), .position = {x, 0.5}, .angle = 0.5 * std::numbers::pi}));
    const JointId pin = bars.add(Revolute{.from = {ground, {x, 0.0}}, .to = {links.back(), {-0.5, 0.0}}});
    bars.add(Driver{.joint = pin, .position = still}, x > 0.0 ? "right" : "left");
  }
  const BodyId coupler = bars.add(RigidBody{.mass = rod(1.0, 1.0), .position = {0.5, 1.0}});
  bars.add(Revolute{.from = {links[0], {0.5, 0.0}}, .to = {coupler, {-0.5, 0.0}}});
  bars.add(Revolute{.from = {links[1], {0.5, 0.0}}, .to = {coupler, {0.5, 0.0}}});
  EXPECT_NE(message(bars).find("is not determined"), std::string::npos) << message(bars);
  EXPECT_NE(message(bars).find("prescribes the same"), std::string::npos) << message(bars);
  EXPECT_THROW(static_cast<void>(inverse_dynamics(system, std::vector<double>{1.0, 0.5})), ModelError);
}

}  // namespace
