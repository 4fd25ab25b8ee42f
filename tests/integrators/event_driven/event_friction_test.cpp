// Event-driven friction against closed forms: bodies on inclines, sliding that turns into rolling, sliders
// that stop and turn round, the Coulomb oscillator, static against sliding friction.

#include "tests/integrators/event_run.h"
#include "tests/reference/reference_data.h"
#include "validation/scenes.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using namespace carom_test;

constexpr double g = 9.81;

// Constant accelerations and sums of them are followed exactly by the Runge-Kutta method: what is left is the
// rounding of some hundred steps and of the search for events.
constexpr double rounding = 1e-12;

double of(const Json& data, const char* key) { return data.at(key).get<double>(); }

/// A body in contact with a plane that falls to the right, running.
class Downhill {
public:
  Downhill(double slope, double mu, double inertia, double r, double speed, double forward_spin)
      : scene_{.slope = slope,
               .friction = mu,
               .inertia = inertia,
               .radius = r,
               .speed = speed,
               .forward_spin = forward_spin},
        simulation_(scenes::downhill(scene_).system, tight()) {}

  double distance() const { return scene_.distance(simulation_.state(), body()); }
  double height() const {
    return scene_.normal().dot(Vec<2>(simulation_.state().position(body()))) - scene_.radius;
  }
  double speed() const { return scene_.speed_of(simulation_.state(), body()); }
  double forward_spin() const { return -simulation_.state().spin(body()); }
  Simulation& simulation() { return simulation_; }

private:
  BodyId body() const { return simulation_.system().body("body"); }

  scenes::Downhill scene_;
  Simulation simulation_;
};

TEST(EventFriction, BodyOnInclineSlidesOrRolls) {
  const Json data = reference_data("impacts_planar.json").at("body_on_incline").at("cases");
  ASSERT_EQ(data.size(), 16u);
  Worst worst;
  for (const auto& at : data) {
    constexpr double r = 0.1;
    Downhill run(of(at, "slope"), of(at, "mu"), of(at, "inertia_over_m_r2") * r * r, r, 0.0, 0.0);
    const LedgerWatch ledger(run.simulation());
    run.simulation().run_until(1.0);
    worst(run.distance(), of(at, "distance_after_1s"));
    worst(run.speed(), of(at, "centre_acceleration"));
    worst(r * run.forward_spin(), of(at, "r_times_angular_acceleration"));
    worst(run.height(), 0.0);
    // It starts at rest: that it slides is decided at the start, not by an event later.
    ASSERT_EQ(run.simulation().events().size(), 1u) << at;
    const EventRecord& event = run.simulation().events()[0];
    EXPECT_EQ(event.kind, EventKind::closing) << at;
    EXPECT_EQ(event.mode == ContactMode::stick, at.at("mode").get<std::string>() == "roll") << at;
    EXPECT_TRUE(ledger.closes()) << at;
  }
  EXPECT_LE(worst.value(), rounding);
  note("worst", worst.value());
}

TEST(EventFriction, SlidingTurnsIntoRolling) {
  int cases = 0;
  Worst time, end;
  for (const char* file : {"impacts_planar.json", "open_variants.json"}) {
    const Json all = reference_data(file).at("slide_to_roll");
    for (const auto& at : all.is_array() ? all : all.at("cases")) {
      const double r = of(at, "r");
      Downhill run(0.0, of(at, "mu"), of(at, "I_over_m_r2") * r * r, r, of(at, "v0"), of(at, "spin0"));
      const LedgerWatch ledger(run.simulation());
      const double last = at.contains("x_at_2s")   ? 2.0
                          : at.contains("x_at_5s") ? 5.0
                                                   : of(at, "t_roll") + 1.0;
      run.simulation().run_until(last);
      const auto stick = events_of(run.simulation(), EventKind::stick);
      ASSERT_EQ(stick.size(), 1u) << at;
      time(stick[0].time, of(at, "t_roll"));
      // Rolling goes on at constant speed.
      end(run.distance(), of(at, "x_roll") + of(at, "v_roll") * (last - of(at, "t_roll")));
      for (const char* key : {"x_at_2s", "x_at_5s"}) {
        if (at.contains(key)) end(run.distance(), of(at, key));
      }
      end(run.speed(), of(at, "v_roll"));
      end(r * run.forward_spin(), of(at, "v_roll"));
      EXPECT_EQ(run.simulation().events().size(), 2u) << at;
      EXPECT_TRUE(ledger.closes()) << at;
      ++cases;
    }
  }
  EXPECT_EQ(cases, 8);
  EXPECT_LE(time.value(), rounding);
  EXPECT_LE(end.value(), 10.0 * rounding);  // places up to 14 m
  note("times", time.value());
  note("ends", end.value());
}

TEST(EventFriction, SliderOnARamp) {
  const Json data = reference_data("contacts_planar.json").at("slider_on_ramp").at("cases");
  ASSERT_EQ(data.size(), 4u);
  Worst worst;
  for (const auto& at : data) {
    Downhill run(of(at, "slope"), of(at, "mu"), 0.0, 0.0, of(at, "v0"), 0.0);
    const LedgerWatch ledger(run.simulation());
    run.simulation().run_until(2.0);
    const auto stick = events_of(run.simulation(), EventKind::stick);
    const auto slip = events_of(run.simulation(), EventKind::slip);
    if (at.contains("t_stop")) {
      ASSERT_EQ(stick.size(), 1u) << at;
      worst(stick[0].time, of(at, "t_stop"));
      worst(run.distance(), of(at, "x_stop"));
      EXPECT_NEAR(run.speed(), 0.0, 1e-14);
    }
    if (at.contains("t_reverse")) {
      ASSERT_EQ(slip.size(), 1u) << at;
      worst(slip[0].time, of(at, "t_reverse"));
      EXPECT_EQ(slip[0].mode, ContactMode::slip_positive);
      worst(run.distance(), of(at, "x_at_2s"));
      worst(run.speed(), of(at, "v_at_2s"));
      Downhill half(of(at, "slope"), of(at, "mu"), 0.0, 0.0, of(at, "v0"), 0.0);
      half.simulation().run_until(of(at, "t_reverse"));
      worst(half.distance(), of(at, "x_reverse"));
    }
    if (at.contains("acceleration")) {
      EXPECT_EQ(run.simulation().events().size(), 1u) << at;
      worst(run.distance(), of(at, "x_at_2s"));
    }
    EXPECT_TRUE(ledger.closes()) << at;
  }
  EXPECT_LE(worst.value(), rounding);
  note("worst", worst.value());
}

/// \param allowed error of places [m] and times [s]
void expect_coulomb_oscillator(FlowMethod method, double allowed) {
  const Json data = reference_data("contacts_planar.json").at("coulomb_oscillator");
  scenes::BodyScene scene = scenes::coulomb_oscillator();
  const BodyId block = scene.body;
  Simulation simulation(std::move(scene.system), tight(method));
  const LedgerWatch ledger(simulation);
  Worst place, time;
  const std::vector<double> looks{0.1, 0.5, 0.9};
  for (std::size_t i = 0; i < looks.size(); ++i) {
    simulation.run_until(looks[i]);
    place(simulation.state().position(block)[0], data.at("x_at")[i][1].get<double>());
  }
  simulation.run_until(2.0);
  EXPECT_NEAR(simulation.state().position(block)[0], of(data, "rest_position"), 1e-8);
  place(simulation.state().position(block)[0], of(data, "rest_position"));
  EXPECT_NEAR(simulation.state().velocity(block)[0], 0.0, 1e-14);

  // It turns round twice and stops at the third time.
  const auto slip = events_of(simulation, EventKind::slip), stick = events_of(simulation, EventKind::stick);
  ASSERT_EQ(slip.size(), 2u);
  ASSERT_EQ(stick.size(), 1u);
  time(slip[0].time, of(data, "half_period"));
  time(slip[1].time, 2.0 * of(data, "half_period"));
  time(stick[0].time, of(data, "stop_time"));
  EXPECT_EQ(slip[0].mode, ContactMode::slip_positive);
  EXPECT_EQ(slip[1].mode, ContactMode::slip_negative);
  EXPECT_LE(place.value(), allowed);
  EXPECT_LE(time.value(), allowed);
  note("places", place.value());
  note("times", time.value());
  // Friction is mu m g all along the way.
  double way = 0.0;
  for (std::size_t i = 1; i < data.at("turning_points").size(); ++i) {
    way +=
        std::abs(data.at("turning_points")[i].get<double>() - data.at("turning_points")[i - 1].get<double>());
  }
  EXPECT_NEAR(simulation.energy().flow(EnergyFlow::sliding), 0.3 * g * way, 10.0 * allowed);
  EXPECT_TRUE(ledger.closes());
}

TEST(EventFriction, CoulombOscillator) {
  // Errors of steps: 1e-11 of 0.2 m and, in the velocity, of 2 m/s; some hundred steps.
  expect_coulomb_oscillator(FlowMethod::explicit_runge_kutta, 1e-11);
  expect_coulomb_oscillator(FlowMethod::one_step, 1e-11);
  expect_coulomb_oscillator(FlowMethod::adams, 1e-10);
  expect_coulomb_oscillator(FlowMethod::bdf, 1e-9);  // over a thousand steps that err to one side
}

TEST(EventFriction, CoulombOscillatorTurnsWhereItShould) {
  const Json data = reference_data("contacts_planar.json").at("coulomb_oscillator");
  for (int turn = 1; turn <= 3; ++turn) {
    scenes::BodyScene scene = scenes::coulomb_oscillator();
    const BodyId block = scene.body;
    Simulation simulation(std::move(scene.system), tight());
    simulation.run_until(turn * of(data, "half_period"));
    EXPECT_NEAR(simulation.state().position(block)[0],
                data.at("turning_points")[static_cast<std::size_t>(turn)].get<double>(), 1e-10);
  }
}

/// x'' = w^2 x - g sin(w t) + mu (g cos(w t) + 2 w x'), uphill positive, from rest at `start`: the block on a
/// plane that turns at w, slipping down. Solved by a Runge-Kutta method of order 4 in many steps.
Vec<2> slide_on_turning_plane(double w, double mu, double start, double time, double x) {
  const auto rate = [&](double t, const Vec<2>& y) {
    return Vec<2>(y[1], w * w * y[0] - g * std::sin(w * t) + mu * (g * std::cos(w * t) + 2.0 * w * y[1]));
  };
  constexpr int steps = 2000;
  const double h = (time - start) / steps;
  Vec<2> y(x, 0.0);
  for (int i = 0; i < steps; ++i) {
    const double t = start + i * h;
    const Vec<2> a = rate(t, y), b = rate(t + 0.5 * h, y + 0.5 * h * a),
                 c = rate(t + 0.5 * h, y + 0.5 * h * b), d = rate(t + h, y + h * c);
    y += h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
  }
  return y;
}

TEST(EventFriction, ABlockBreaksLooseAtMuSAndSlidesWithMuK) {
  constexpr double mu_s = 0.5, mu_k = 0.3, w = 0.1;
  System system;
  system.add(Gravity{{0.0, -g}});
  system.add(HalfPlane{.normal = {0.0, 1.0},
                       .motion = {.angle = [](double t) { return w * t; },
                                  .spin = [](double) { return w; },
                                  .angular_acceleration = [](double) { return 0.0; }}},
             Surface{.friction = mu_k, .normal_restitution = 0.0, .static_friction = mu_s});
  const BodyId block = system.add(Particle{.mass = 2.0});
  Simulation simulation(std::move(system), tight());
  const LedgerWatch ledger(simulation);
  const double loose = std::atan(mu_s) / w;
  simulation.run_until(loose + 0.5);
  ASSERT_EQ(simulation.events().size(), 2u);
  EXPECT_EQ(simulation.events()[0].mode, ContactMode::stick);
  EXPECT_EQ(simulation.events()[1].kind, EventKind::slip);
  EXPECT_EQ(simulation.events()[1].mode, ContactMode::slip_negative);
  // It lies where the plane turns: no centrifugal force. Forces are known to 1e-11 of their size.
  EXPECT_NEAR(simulation.events()[1].time, loose, 1e-9);
  note("times", std::abs(simulation.events()[1].time - loose));
  const double turn = w * simulation.time();
  const Vec<2> uphill(std::cos(turn), std::sin(turn)), at = simulation.state().position(block);
  const Vec<2> expected = slide_on_turning_plane(w, mu_k, loose, simulation.time(), 0.0);
  EXPECT_LT(expected[0], -0.2);
  EXPECT_NEAR(uphill.dot(at), expected[0], 1e-9);
  note("place", std::abs(uphill.dot(at) - expected[0]));
  EXPECT_TRUE(ledger.closes());
}

TEST(EventFriction, StribecksCurveSlowsAsTheClosedFormSays) {
  // u = exp(v/s) obeys u' = -(g/s)(mu_k u + d), d = mu_s - mu_k: it stops where u = 1 and then sticks.
  constexpr double mu_k = 0.2, d = 0.3, s = 0.5, v0 = 2.0;
  const double start = std::exp(v0 / s) + d / mu_k;
  const double stop = s / (g * mu_k) * std::log(start / (1.0 + d / mu_k));
  System system;
  system.add(Gravity{{0.0, -g}});
  system.add(
      HalfPlane{.normal = {0.0, 1.0}},
      Surface{.friction = mu_k, .normal_restitution = 0.0, .static_friction = mu_k + d, .stribeck_speed = s});
  const BodyId block = system.add(Particle{.mass = 1.0, .velocity = {v0, 0.0}});
  Simulation simulation(std::move(system), tight());
  const LedgerWatch ledger(simulation);
  Worst speed;
  for (const double share : {0.3, 0.6, 0.9}) {
    simulation.run_until(share * stop);
    const double u = start * std::exp(-g * mu_k * simulation.time() / s) - d / mu_k;
    speed(simulation.state().velocity(block)[0], s * std::log(u));
  }
  simulation.run_until(2.0 * stop);
  const auto stick = events_of(simulation, EventKind::stick);
  ASSERT_EQ(stick.size(), 1u);
  EXPECT_NEAR(stick[0].time, stop, 1e-9);
  EXPECT_LE(speed.value(), 1e-9);
  note("times", std::abs(stick[0].time - stop));
  note("speeds", speed.value());
  EXPECT_EQ(simulation.state().velocity(block)[0], 0.0);
  EXPECT_TRUE(ledger.closes());
}

TEST(EventFriction, WhatSticksHasItsStaticFrictionWhenItIsHit) {
  // A box is carried by a belt, and hit from above by a disc that drags it along: both floor contacts slip in
  // the impact, from sticking. The speed against the belt is rounding, which differs with the slope.
  constexpr double mu_k = 0.3, mu_s = 0.5;
  int sliding_by_rounding = 0;
  for (int i = 0; i < 40; ++i) {
    const double slope = 0.03 * i, belt = 0.7 + 0.013 * i;
    const Vec<2> normal = incline(slope), along(normal[1], -normal[0]);
    System system;
    system.add(Gravity{-g * normal});
    const MaterialId rubber = system.material("rubber"), wood = system.material("wood");
    const Surface floor{.friction = mu_k, .normal_restitution = 0.0, .static_friction = mu_s};
    system.between(rubber, wood, floor);
    system.between(wood, wood, {.friction = 0.8, .normal_restitution = 0.0});
    system.add(HalfPlane{.normal = normal, .material = rubber, .surface_speed = belt});
    const BodyId block = system.add(RigidBody{
        .mass = box(1.0, 0.6, 0.1), .position = 0.05 * normal, .angle = slope, .velocity = belt * along});
    system.add(Polygon{.body = block,
                       .vertices = {{-0.3, -0.05}, {0.3, -0.05}, {0.3, 0.05}, {-0.3, 0.05}},
                       .material = wood});
    const BodyId ball = system.add(RigidBody{.mass = disc(3.0, 0.05),
                                             .position = 0.35 * normal - 0.53 * along,
                                             .velocity = 6.0 * along - 2.0 * normal});
    system.add(Disc{.body = ball, .radius = 0.05, .material = wood});
    Simulation simulation(std::move(system), tight());
    simulation.run_until(0.2);
    double pressed = 0.0, rubbed = 0.0;
    for (const EventRecord& event : simulation.events()) {
      if (event.kind != EventKind::impact || !event.obstacle.valid()) continue;
      if (pressed == 0.0 && event.velocity_before[1] != 0.0) ++sliding_by_rounding;
      EXPECT_LE(std::abs(event.velocity_before[1]), 1e-11) << i;
      pressed += event.impulse[0];
      rubbed += event.impulse[1];
    }
    ASSERT_GT(pressed, 1.0) << i;
    EXPECT_NEAR(rubbed, -mu_s * pressed, 1e-11 * pressed) << i;
  }
  EXPECT_GE(sliding_by_rounding, 1);
}

}  // namespace
