// The ladder in event-driven mode: it stands if the floor is rough enough, slips if not, and leaves a smooth
// wall where it should.

#include "tests/integrators/event_run.h"
#include "tests/reference/reference_data.h"
#include "validation/scenes.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace carom;
using namespace carom::planar;
using namespace carom_test;

constexpr double g = 9.81;

double of(const Json& data, const char* key) { return data.at(key).get<double>(); }

TEST(EventLadder, StandsAboveTheLeastFriction) {
  const Json data = reference_data("contacts_planar.json").at("ladder");
  const double theta = of(data, "theta"), least = of(data, "mu_min");
  for (const double mu : {least * (1.0 + 1e-9), least + 0.1, 2.0}) {
    Simulation simulation(scenes::ladder(mu, theta).system, tight());
    const LedgerWatch ledger(simulation);
    const BodyId body = simulation.system().body("ladder");
    simulation.run_until(5.0);
    ASSERT_EQ(simulation.events().size(), 2u) << mu;
    for (const EventRecord& event : simulation.events()) EXPECT_EQ(event.kind, EventKind::closing) << mu;
    EXPECT_NEAR(simulation.state().angle(body), -theta, 1e-13) << mu;
    EXPECT_NEAR(simulation.state().spin(body), 0.0, 1e-13) << mu;
    EXPECT_TRUE(ledger.closes());
  }
}

TEST(EventLadder, SlipsBelowTheLeastFriction) {
  const Json data = reference_data("contacts_planar.json").at("ladder");
  const double theta = of(data, "theta"), least = of(data, "mu_min");
  for (const double mu : {least * (1.0 - 1e-6), 0.2, 0.0}) {
    Simulation simulation(scenes::ladder(mu, theta).system, tight());
    const LedgerWatch ledger(simulation);
    const BodyId body = simulation.system().body("ladder");
    constexpr double time = 1e-3;
    simulation.run_until(time);
    ASSERT_EQ(simulation.events().size(), 2u) << mu;
    for (const EventRecord& event : simulation.events()) EXPECT_EQ(kind_of(event.mode), "slip") << mu;
    // m = 1, l = 2, I = 1/3: N_floor = g - c alpha, N_wall = s alpha + mu N_floor, and
    // I alpha = (c - mu s) N_floor - s N_wall. Over a millisecond alpha grows by less than g t^2.
    const double c = std::cos(theta), s = std::sin(theta);
    const double alpha = g * (c - 2.0 * mu * s) / (4.0 / 3.0 - 2.0 * mu * s * c);
    EXPECT_NEAR(simulation.state().spin(body) / time, alpha, 2e-5 * alpha) << mu;
    EXPECT_TRUE(ledger.closes());
  }
}

TEST(EventLadder, LeavesTheSmoothWallAtTwoThirdsOfItsHeight) {
  // Without friction (2/3) omega^2 = g (sin theta0 - sin theta) while it leans; the wall's force ends where
  // sin theta = (2/3) sin theta0. From there on its foot slides at a constant speed of the centre.
  const double theta0 = 1.0;
  Simulation simulation(scenes::ladder(0.0, theta0).system, tight());
  const LedgerWatch ledger(simulation);
  const BodyId body = simulation.system().body("ladder");
  const ObstacleId wall = simulation.system().obstacle("wall");
  double leaves = 0.0;
  while (leaves == 0.0 && simulation.time() < 2.0) {
    simulation.step();
    for (const EventRecord& event : events_of(simulation, EventKind::lift_off)) {
      EXPECT_EQ(event.obstacle, wall);
      leaves = event.time;
    }
  }
  // theta' = -omega: the time by Simpson's rule in u with sin theta = sin theta0 - u^2.
  const double s0 = std::sin(theta0);
  const auto rate = [&](double u) {  // dt/du
    const double s = s0 - u * u;
    return 2.0 / (std::sqrt(1.5 * g) * std::sqrt(1.0 - s * s));
  };
  constexpr int n = 2000;
  const double end = std::sqrt(s0 / 3.0), h = end / n;
  double expected = rate(0.0) + rate(end);
  for (int i = 1; i < n; ++i) expected += (i % 2 == 1 ? 4.0 : 2.0) * rate(i * h);
  expected *= h / 3.0;
  // It starts from rest, from where the smallest error grows as exp(2.5 t); forces are known to 1e-11.
  EXPECT_NEAR(leaves, expected, 1e-10);
  note("leaves", std::abs(leaves - expected));
  const double sideways = std::sqrt(1.5 * g * s0 / 3.0) * 2.0 / 3.0 * s0;
  EXPECT_NEAR(simulation.state().velocity(body)[0], sideways, 1e-10);
  note("speed", std::abs(simulation.state().velocity(body)[0] - sideways));
  simulation.run_until(simulation.time() + 0.1);
  EXPECT_NEAR(simulation.state().velocity(body)[0], sideways, 1e-10);
  EXPECT_TRUE(ledger.closes());
}

}  // namespace
