// Impacts and contact with closed forms: Johansson's tables, Horak's ball, the bouncing ball, bodies on
// inclines, sliding that turns into rolling.

#include "tests/analytic/bouncing_ball.h"
#include "tests/analytic/convergence.h"
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
using carom_test::Json;
using carom_test::reference_data;

// The impact itself: one step without gravity from just inside the obstacle. Its velocities do not depend on
// the step or the depth, so they must be those of the law to round-off (asked for: 1e-12).
constexpr double impact_tolerance = 1e-12;

struct Velocities {
  Vec<2> velocity;
  double spin;
  ContactRecord contact;
};
Velocities strike(const MassProperties<2>& mass, double radius, const Vec<2>& normal, const Surface& surface,
                  const Vec<2>& velocity, double spin) {
  constexpr double depth = 1e-12;
  System system;
  system.add(HalfPlane{.point = {0.0, 0.0}, .normal = normal}, surface);
  const BodyId ball = system.add(
      RigidBody{.mass = mass, .position = (radius - depth) * normal, .velocity = velocity, .spin = spin});
  system.add(Disc{.body = ball, .radius = radius});
  Simulation simulation(std::move(system), TimeStepping{.step = 1e-3});
  const StepReport& report = simulation.step();
  EXPECT_EQ(report.contacts.size(), 1u);
  EXPECT_TRUE(report.contacts[0].impact);
  return {simulation.state().velocity(ball), simulation.state().spin(ball), report.contacts[0]};
}

std::string kind_of(ContactMode mode) { return std::string(to_string(mode)).substr(0, 4); }

TEST(ImpactsPlanar, JohanssonTables) {
  constexpr double r = 0.0131, m = 0.00859, e_n = 0.91;
  const Json data = reference_data("impacts_planar.json").at("johansson_tables");
  int impacts = 0;
  for (const auto& [name, run] : data.at("runs").items()) {
    const double e_t = std::stod(name.substr(2, name.find('_') - 2));
    for (const auto& at : run) {
      const auto number = [&](const char* key) { return at.at(key).get<double>(); };
      const bool low = at.at("table").get<std::string>() == "low";
      const Surface surface{
          .friction = low ? 1.13 : 0.95, .normal_restitution = e_n, .tangential_restitution = e_t};
      const auto after = strike(solid_sphere(m, r), r, {0.0, low ? 1.0 : -1.0}, surface,
                                {number("vx_minus"), number("vy_minus")}, number("spin_minus"));
      EXPECT_NEAR(after.velocity[0], number("vx_plus"), impact_tolerance) << name << at;
      EXPECT_NEAR(after.velocity[1], number("vy_plus"), impact_tolerance) << name << at;
      // Spins of several hundred rad/s: relative.
      EXPECT_NEAR(after.spin, number("spin_plus"),
                  impact_tolerance * std::abs(number("spin_minus")) + 1e-9 * r)
          << name << at;
      EXPECT_EQ(kind_of(after.contact.mode), at.at("mode").get<std::string>().substr(0, 4)) << name << at;
      EXPECT_NEAR(std::abs(after.contact.impulse[1] / after.contact.impulse[0]),
                  number("impulse_ratio_Pt_over_Pn"), impact_tolerance)
          << name << at;
      ++impacts;
    }
  }
  EXPECT_EQ(impacts, 48);
}

TEST(ImpactsPlanar, HorakBall) {
  constexpr double r = 0.0359, m = 0.1134;
  const Json data = reference_data("impacts_planar.json").at("horak");
  for (const auto& [name, result] : data.at("results").items()) {
    const Surface surface{.friction = result.at("mu").get<double>(),
                          .normal_restitution = result.at("e_n").get<double>(),
                          .tangential_restitution = result.at("e_t").get<double>()};
    for (const auto& row : result.at("rows")) {
      const auto number = [&](const char* key) { return row.at(key).get<double>(); };
      const auto after = strike(thin_shell(m, r), r, {0.0, 1.0}, surface,
                                {0.0, -data.at("impact_speed").get<double>()}, number("spin_before"));
      EXPECT_NEAR(after.velocity[0], number("vx_after"), impact_tolerance) << name << row;
      EXPECT_NEAR(after.velocity[1], number("vy_after"), impact_tolerance) << name << row;
      EXPECT_NEAR(after.spin, number("spin_after"), impact_tolerance * (1.0 + number("spin_before")))
          << name << row;
      EXPECT_EQ(kind_of(after.contact.mode), row.at("mode").get<std::string>().substr(0, 4)) << name << row;
    }
  }
}

TEST(ImpactsPlanar, WaltonCurves) {
  // psi1 = tangential over normal contact speed before, psi2 = tangential after over normal speed before.
  const Json data = reference_data("impacts_planar.json").at("walton_curves");
  for (const auto& curve : data.at("cases")) {
    const double factor = curve.at("I_over_m_r2").get<double>();
    const double r = 1.59e-3, m = 4.0e-5;
    const Surface surface{.friction = curve.at("mu").get<double>(),
                          .normal_restitution = curve.at("e_n").get<double>(),
                          .tangential_restitution = curve.at("beta0").get<double>()};
    for (const auto& point : curve.at("curve_psi1_psi2_mode")) {
      const auto after = strike({.mass = m, .inertia = factor * m * r * r}, r, {0.0, 1.0}, surface,
                                {point[0].get<double>(), -1.0}, 0.0);
      EXPECT_NEAR(after.velocity[0] + r * after.spin, point[1].get<double>(), impact_tolerance)
          << curve << point;
    }
  }
}

TEST(ImpactsPlanar, EnergyInconsistency) {
  // r1 = r, r2 = -r, I = m r^2, mu = 1: the corner at (-r, -r) of the body strikes with (v0, -2 v0).
  const Json data = reference_data("impacts_planar.json").at("energy_inconsistency");
  for (const auto& value : data.at("values")) {
    scenes::BodyScene scene = scenes::struck_point({.mass = 1.0, .inertia = 1.0}, {-1.0, -1.0},
                                                   {.friction = 1.0,
                                                    .normal_restitution = value.at("e_n").get<double>(),
                                                    .tangential_restitution = value.at("e_t").get<double>()},
                                                   {1.0, -2.0});
    Simulation simulation(std::move(scene.system), TimeStepping{});
    const StepReport& report = simulation.step();
    ASSERT_EQ(report.contacts.size(), 1u);
    EXPECT_NEAR(report.contacts[0].impulse[0], value.at("Pn").get<double>(), impact_tolerance) << value;
    EXPECT_NEAR(report.contacts[0].impulse[1], value.at("Pt").get<double>(), impact_tolerance) << value;
    EXPECT_NEAR(simulation.energy().kinetic() - 2.5, value.at("energy_change").get<double>(),
                impact_tolerance)
        << value;
  }
}

double height_error(double step, double time, double exact) {
  scenes::BodyScene scene = scenes::ball_above_floor(1.0, 0.8);
  const BodyId ball = scene.body;
  Simulation simulation(std::move(scene.system), TimeStepping{.step = step});
  simulation.run_until(time);
  return std::abs(simulation.state().position(ball)[1] - exact);
}

TEST(ImpactsPlanar, BouncingBallOrderOneInTheMean) {
  const Json data = reference_data("impacts_planar.json").at("bouncing_ball");
  for (const char* time : {"0.6", "1.0", "1.5", "2.0"}) {
    const double exact = data.at("states").at(time).at("y").get<double>();
    const auto order =
        analytic::mean_order(2e-3, 4, 40, [&](double h) { return height_error(h, std::stod(time), exact); });
    // Three standard deviations, as the scatter gives them.
    EXPECT_NEAR(order.slope, 1.0, 3.0 * order.deviation) << time;
    EXPECT_LE(order.deviation, 0.09) << time;
  }
}

TEST(ImpactsPlanar, BouncingBallComesToRestAtTheAccumulation) {
  // Behind the accumulation the ball stays within the depth that the last bounces of the size of a step
  // leave: flights shorter than 2h can no longer be told apart, v < g h, depth < (3 - e)/2 h v + g h^2.
  for (const double h : {1e-2, 1e-3, 1e-4}) {
    EXPECT_LE(height_error(h, 5.0, 0.0), (0.5 * (3.0 - 0.8) + 1.0) * 9.81 * h * h) << h;
  }
}

struct Rolling {
  double distance;  // along the plane, downhill or forward
  double speed;
  double spin;  // forward
};
/// A round body in contact with a plane that falls to the right; `depth` below it.
Rolling roll(double factor, double r, double slope, double mu, double speed, double spin, double depth,
             double step, double time) {
  const scenes::Downhill start{.slope = slope,
                               .friction = mu,
                               .inertia = factor * r * r,
                               .radius = r,
                               .speed = speed,
                               .forward_spin = spin,
                               .depth = depth};
  scenes::BodyScene scene = scenes::downhill(start);
  Simulation simulation(std::move(scene.system), TimeStepping{.step = step});
  simulation.run_until(time);
  const State& state = simulation.state();
  EXPECT_LE(std::abs(simulation.energy().residual()), 1e3 * 2.2e-16 * simulation.energy().scale());
  return {start.distance(state, scene.body), start.speed_of(state, scene.body), -state.spin(scene.body)};
}

TEST(ImpactsPlanar, BodyOnInclineSlidesOrRolls) {
  // With e = 0 the law gives the impulses of constant forces, and the trapezoidal rule follows a constant
  // acceleration exactly: all to round-off of 1000 steps, whatever the step.
  const Json data = reference_data("impacts_planar.json").at("body_on_incline");
  for (const auto& at : data.at("cases")) {
    const auto number = [&](const char* key) { return at.at(key).get<double>(); };
    const Rolling found =
        roll(number("inertia_over_m_r2"), 0.1, number("slope"), number("mu"), 0.0, 0.0, 1e-9, 1e-3, 1.0);
    EXPECT_NEAR(found.distance, number("distance_after_1s"), 1e-12) << at;
    EXPECT_NEAR(found.speed, number("centre_acceleration"), 1e-12) << at;
    EXPECT_NEAR(0.1 * found.spin, number("r_times_angular_acceleration"), 1e-12) << at;
  }
}

TEST(ImpactsPlanar, BodyOnInclineStartsExactlyInContact) {
  // At gap 0, rounding decides whether the first steps see the contact: the body may fall freely for a step,
  // which costs at most g h^2/2 of height and g h of speed along the plane: first order.
  const Json data = reference_data("impacts_planar.json").at("body_on_incline");
  for (const auto& at : data.at("cases")) {
    const auto number = [&](const char* key) { return at.at(key).get<double>(); };
    for (const double h : {1e-2, 1e-3, 1e-4}) {
      const Rolling found =
          roll(number("inertia_over_m_r2"), 0.1, number("slope"), number("mu"), 0.0, 0.0, 0.0, h, 1.0);
      EXPECT_NEAR(found.distance, number("distance_after_1s"), 9.81 * h) << at << h;
    }
  }
}

TEST(ImpactsPlanar, SlidingTurnsIntoRolling) {
  const Json data = reference_data("impacts_planar.json").at("slide_to_roll");
  for (const auto& at : data.at("cases")) {
    const auto number = [&](const char* key) { return at.at(key).get<double>(); };
    const bool late = at.contains("x_at_5s");
    const double time = late ? 5.0 : 2.0;
    const double exact = number(late ? "x_at_5s" : "x_at_2s");
    const auto error_at = [&](double h) {
      const Rolling found =
          roll(number("I_over_m_r2"), 0.1, 0.0, 0.3, number("v0"), number("spin0"), 1e-9, h, time);
      // The change of speed and spin is an impulse that does not depend on when it acts.
      EXPECT_NEAR(found.speed, number("v_roll"), 1e-12) << at;
      EXPECT_NEAR(found.spin, number("spin_rolling"), 1e-11) << at;
      return std::abs(found.distance - exact);
    };
    // Only the step in which sliding ends is wrong, by at most mu g h^2/8 of distance: order 2 in the mean,
    // the share of that step being spread evenly. Four bins of 32: three deviations of the slope are 0.2.
    const auto order = analytic::mean_order(2e-2, 4, 32, [&](double h) {
      const double error = error_at(h);
      EXPECT_LE(error, 0.3 * 9.81 * h * h / 8.0 + 1e-12) << at << h;
      return error;
    });
    EXPECT_NEAR(order.slope, 2.0, 3.0 * order.deviation) << at;
    EXPECT_LE(order.deviation, 0.08) << at;
  }
}

}  // namespace
