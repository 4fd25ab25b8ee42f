// The closed forms that other tests trust, against the reference data (found by other means) and against the
// equations they solve.

#include "tests/analytic/bouncing_ball.h"
#include "tests/analytic/convergence.h"
#include "tests/analytic/damped_oscillator.h"
#include "tests/analytic/projectile.h"
#include "tests/analytic/rotating_spring_pair.h"
#include "tests/analytic/sphere_impact.h"
#include "tests/reference/reference_data.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using carom::Vec;

TEST(Projectile, ReachesPlane) {
  const analytic::Projectile<2> flight{{0.0, 20.0}, {10.0, 0.0}, {0.0, -9.81}};
  const Vec<2> n(-std::sin(0.1), std::cos(0.1));
  const double t = flight.time_to_plane({0.0, 0.0}, n);
  EXPECT_NEAR(n.dot(flight.position(t)), 0.0, 1e-14);
  EXPECT_GT(n.dot(flight.position(0.5 * t)), 0.0);
  // Upwards first: the same place, later.
  const analytic::Projectile<2> up{{0.0, 1.0}, {0.0, 5.0}, {0.0, -9.81}};
  const double later = up.time_to_plane({0.0, 0.0}, {0.0, 1.0});
  EXPECT_NEAR(up.position(later)[1], 0.0, 1e-14);
  EXPECT_LT(up.velocity(later)[1], 0.0);
}

TEST(DampedOscillator, AgreesWithReference) {
  const analytic::DampedOscillator pair{1.0, 2.0, 100.0, 3.0, 0.5, 9.81, 10.0, 11.0, 2.0, -1.0};
  const auto data =
      carom_test::reference_data("smooth_planar.json").at("two_mass_spring_dashpot").at("reference");
  for (const auto& [time, values] : data.items()) {
    const auto state = pair.state(std::stod(time));
    const double known = values.at("abs_difference_of_two_methods").get<double>();
    // The reference is known to the difference of its two methods; 1e-14 is the rounding of numbers of
    // size 20.
    const double tolerance = 2.0 * known + 1e-14;
    EXPECT_NEAR(state[0], values.at("y1").get<double>(), tolerance);
    EXPECT_NEAR(state[1], values.at("y2").get<double>(), tolerance);
    EXPECT_NEAR(state[2], values.at("v1").get<double>(), tolerance);
    EXPECT_NEAR(state[3], values.at("v2").get<double>(), tolerance);
  }
}

TEST(DampedOscillator, LossIsWorkOfDashpot) {
  const analytic::DampedOscillator pair{1.0, 2.0, 100.0, 3.0, 0.5, 9.81, 10.0, 11.0, 2.0, -1.0};
  // Simpson's rule over 2000 intervals of 5e-4 s; its error is about h^4 w^4 of the integrand.
  double sum = 0.0;
  const int intervals = 2000;
  for (int i = 0; i <= intervals; ++i) {
    const auto at = pair.state(static_cast<double>(i) / intervals);
    const double rate = at[3] - at[2];
    const double weight = i == 0 || i == intervals ? 1.0 : (i % 2 == 0 ? 2.0 : 4.0);
    sum += weight * 3.0 * rate * rate;
  }
  EXPECT_NEAR(sum / (3.0 * intervals), pair.dashpot_loss(1.0), 1e-9);
}

TEST(RotatingSpringPair, AgreesWithReferenceAndEquation) {
  const analytic::RotatingSpringPair pair{1.0, 1000.0, 2.0, 10.0};
  const auto data = carom_test::reference_data("smooth_planar.json").at("rotating_spring_pair");
  EXPECT_DOUBLE_EQ(pair.distance(), data.at("distance").get<double>());
  EXPECT_DOUBLE_EQ(pair.speed(), data.at("tangential_speed").get<double>());
  EXPECT_DOUBLE_EQ(pair.radial_frequency(), data.at("small_radial_frequency").get<double>());
  // m x'' = -k (l - L) x/(l/2), x'' = -w^2 x.
  EXPECT_NEAR(1.0 * 100.0 * 0.5 * pair.distance(), 1000.0 * (pair.distance() - 2.0), 1e-12);
}

TEST(BouncingBall, AgreesWithReference) {
  const auto data = carom_test::reference_data("impacts_planar.json").at("bouncing_ball");
  const analytic::BouncingBall ball{1.0, 9.81, 0.8};
  EXPECT_NEAR(ball.end(), data.at("zeno_time").get<double>(), 1e-14);
  for (const auto& impact : data.at("impacts")) {
    const int n = impact.at("n").get<int>();
    EXPECT_NEAR(ball.impact_time(n), impact.at("t").get<double>(), 1e-14);
    EXPECT_NEAR(ball.speed_after(n), impact.at("v_plus").get<double>(), 1e-14);
  }
  for (const auto& [time, values] : data.at("states").items()) {
    const auto motion = ball.at(std::stod(time));
    EXPECT_NEAR(motion.height, values.at("y").get<double>(), 1e-14) << time;
    // Near the accumulation the time since the last impact cancels: 1e-13 s of 4 s.
    EXPECT_NEAR(motion.speed, values.at("v").get<double>(), 1e-12) << time;
  }
}

TEST(SphereImpact, AgreesWithHorak) {
  const auto data = carom_test::reference_data("impacts_planar.json").at("horak");
  const double m = 0.1134, r = 0.0359;
  const double contact_mass = 1.0 / (1.0 / m + r * r / (2.0 / 3.0 * m * r * r));
  const double speed = data.at("impact_speed").get<double>();
  for (const auto& [name, result] : data.at("results").items()) {
    const analytic::SphereImpact law{m, contact_mass, result.at("mu").get<double>(),
                                     result.at("e_n").get<double>(), result.at("e_t").get<double>()};
    for (const auto& row : result.at("rows")) {
      const double x = r * row.at("spin_before").get<double>();
      EXPECT_EQ(law.sticks(-speed, x), row.at("mode").get<std::string>() == "stick") << name << row;
      if (x == 0.0) continue;
      const double impulse = -law.tangential_factor(-speed, x) * x;
      EXPECT_NEAR(impulse / m, row.at("vx_after").get<double>(), 1e-13) << name << row;
    }
  }
}

TEST(SphereImpact, InconsistentEnergy) {
  const auto data = carom_test::reference_data("impacts_planar.json").at("energy_inconsistency");
  for (const auto& value : data.at("values")) {
    const double gain = analytic::inconsistent_impact_energy(1.0, 1.0, value.at("e_n").get<double>(),
                                                             value.at("e_t").get<double>());
    EXPECT_NEAR(gain, value.at("energy_change").get<double>(), 1e-14) << value;
  }
}

TEST(Convergence, SlopeOfPowers) {
  EXPECT_NEAR(analytic::slope({1.0, 0.5, 0.25}, {3.0, 0.75, 0.1875}), 2.0, 1e-14);
  const auto first = analytic::mean_order(1e-2, 4, 8, [](double h) { return 5.0 * h; });
  EXPECT_NEAR(first.slope, 1.0, 1e-12);
  EXPECT_EQ(first.steps.size(), 4u);
  EXPECT_LE(first.deviation, 1e-7);  // nothing scatters
  // Errors spread evenly over [0, h]: deviation 0.577 of the mean; of the slope 0.577/sqrt(n)/(ln 2 sqrt(5)).
  int count = 0;
  const auto scattered = analytic::mean_order(
      1e-2, 4, 400, [&](double h) { return h * std::fmod(0.7548776662466927 * ++count, 1.0); });
  EXPECT_NEAR(scattered.deviation, 0.577 / 20.0 / (std::log(2.0) * std::sqrt(5.0)), 1e-3);
  EXPECT_NEAR(scattered.slope, 1.0, 3.0 * scattered.deviation);
}

}  // namespace
