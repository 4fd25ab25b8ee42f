// Spring and dashpot problems without contact: the implicit trapezoidal rule, order 2.

#include "tests/analytic/convergence.h"
#include "tests/analytic/damped_oscillator.h"
#include "tests/analytic/rotating_spring_pair.h"
#include "tests/reference/incline_run.h"
#include "tests/reference/reference_data.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::reference_data;

// Slopes are fitted over four halvings of h from 1e-3 s. The error is a series in h^2; its second term is
// h^2 w^2/10 of the first, 2.5e-4 at the fastest frequency here (50 rad/s): the slope is 2 within 1e-3.
constexpr double slope_tolerance = 1e-3;

/// Numbers of all bodies, in the order given: positions, then velocities.
std::vector<double> numbers(const State& state, const std::vector<BodyId>& bodies) {
  std::vector<double> all;
  for (const BodyId body : bodies) all.insert(all.end(), {state.position(body)[0], state.position(body)[1]});
  for (const BodyId body : bodies) all.insert(all.end(), {state.velocity(body)[0], state.velocity(body)[1]});
  return all;
}

/// Error at a time for steps h, h/2, ..., h/16.
struct Refinement {
  std::vector<double> steps, errors;
  [[nodiscard]] double slope() const { return analytic::slope(steps, errors); }
};
Refinement refine(const System& system, const std::vector<BodyId>& bodies, double time, double step,
                  const std::vector<double>& reference) {
  Refinement result;
  for (int halving = 0; halving < 5; ++halving, step *= 0.5) {
    Simulation simulation(system, TimeStepping{.step = step, .tolerance = 1e-14});
    simulation.run_until(time);
    result.steps.push_back(step);
    result.errors.push_back(carom_test::distance(numbers(simulation.state(), bodies), reference));
  }
  return result;
}

TEST(SmoothPlanar, TwoMassSpringDashpotOrderTwo) {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  const BodyId lower = system.add(Particle{.mass = 1.0, .position = {0.0, 10.0}, .velocity = {0.0, 2.0}});
  const BodyId upper = system.add(Particle{.mass = 2.0, .position = {0.0, 11.0}, .velocity = {0.0, -1.0}});
  system.add(
      SpringDamper{.from = lower, .to = upper, .stiffness = 100.0, .damping = 3.0, .free_length = 0.5});
  const auto data = reference_data("smooth_planar.json").at("two_mass_spring_dashpot").at("reference");
  for (const auto& item : data.items()) {
    const std::string& time = item.key();
    const auto& at = item.value();
    const auto number = [&](const char* name) { return at.at(name).get<double>(); };
    const auto refined = refine(system, {lower, upper}, std::stod(time), 1e-3,
                                {0.0, number("y1"), 0.0, number("y2"), 0.0, number("v1"), 0.0, number("v2")});
    EXPECT_NEAR(refined.slope(), 2.0, slope_tolerance) << "t = " << time;
    // The trapezoidal rule is off by h^2 |z|^3 t/12 of a motion exp(z t), |z| = sqrt(k/m) = 12.25/s; the
    // amplitude of the relative speed is 6.8 m/s exp(-2.25 t), of which the masses have 2/3 and 1/3, 0.745.
    const double t = std::stod(time);
    EXPECT_LE(refined.errors[0], 1e-6 * 1837.0 * t / 12.0 * 6.8 * 0.745 * std::exp(-2.25 * t))
        << "t = " << time;
  }
}

TEST(SmoothPlanar, SpringPendulumOrderTwo) {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  const BodyId bob = system.add(Particle{.mass = 1.0, .position = {1.0, 0.0}});
  system.add(SpringDamper{.from = ground, .to = bob, .stiffness = 40.0, .free_length = 1.0});
  const auto data = reference_data("smooth_planar.json").at("spring_pendulum").at("reference");
  for (const auto& item : data.items()) {
    const std::string& time = item.key();
    const auto& at = item.value();
    const auto number = [&](const char* name) { return at.at(name).get<double>(); };
    const auto refined =
        refine(system, {bob}, std::stod(time), 1e-3, {number("x"), number("y"), number("vx"), number("vy")});
    EXPECT_NEAR(refined.slope(), 2.0, slope_tolerance) << "t = " << time;
    // The spring (6.3 rad/s) lags by h^2 w^3 t/12 = 2.1e-5 rad per second; times a speed of the order of 2
    // m/s.
    EXPECT_LE(refined.errors[0], 4.2e-5 * std::stod(time)) << "t = " << time;
  }
}

TEST(SmoothPlanar, SpringPendulumVariantsOrderTwo) {
  const carom_test::Json variants = reference_data("open_variants.json").at("spring_pendulum");
  for (const auto& variant : variants) {
    const auto start = variant.at("start").get<std::vector<double>>();
    System system;
    system.add(Gravity{{0.0, -9.81}});
    const BodyId bob = system.add(Particle{.mass = carom_test::number(variant.at("m")),
                                           .position = {start[0], start[1]},
                                           .velocity = {start[2], start[3]}});
    system.add(SpringDamper{.from = ground,
                            .to = bob,
                            .stiffness = carom_test::number(variant.at("k")),
                            .free_length = carom_test::number(variant.at("l0"))});
    const auto refined = refine(system, {bob}, 1.0, 1e-3, variant.at("t1").get<std::vector<double>>());
    EXPECT_NEAR(refined.slope(), 2.0, slope_tolerance) << variant;
  }
}

TEST(SmoothPlanar, RotatingSpringPairOrderTwo) {
  const analytic::RotatingSpringPair exact{1.0, 1000.0, 2.0, 10.0};
  System system;
  const BodyId first =
      system.add(Particle{.mass = 1.0, .position = exact.position(0.0), .velocity = exact.velocity(0.0)});
  const BodyId second =
      system.add(Particle{.mass = 1.0, .position = -exact.position(0.0), .velocity = -exact.velocity(0.0)});
  system.add(SpringDamper{.from = first, .to = second, .stiffness = 1000.0, .free_length = 2.0});
  const auto x = exact.position(1.0);
  const auto v = exact.velocity(1.0);
  const auto refined =
      refine(system, {first, second}, 1.0, 1e-3, {x[0], x[1], -x[0], -x[1], v[0], v[1], -v[0], -v[1]});
  EXPECT_NEAR(refined.slope(), 2.0, slope_tolerance);
  // The turn lags by h^2 w^3 t/12 = 8.3e-5 rad; times the speeds and positions of both, 15.0 (m/s,
  // m): 1.25e-3.
  EXPECT_LE(refined.errors[0], 1.3e-3);
}

}  // namespace
