// The rocking block in event-driven mode (Housner 1963): it stands on one corner, falls on both, and goes on
// over the other.

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

double of(const Json& data, const char* key) { return data.at(key).get<double>(); }

struct Errors {
  Worst time, spin, impulse, amplitude;
};

/// Runs on from an impact to where the block turns back; returns the tilt there.
double next_amplitude(Simulation& simulation, double p, double alpha) {
  const BodyId block = simulation.system().body("block");
  for (int i = 0; i < 100; ++i) {
    // theta'' = -p^2 sin(alpha - theta) while theta > 0 and grows; smaller the further it tilts: Newton's
    // method for the turning point never steps over it.
    const double tilt = std::abs(simulation.state().angle(block)),
                 w = std::abs(simulation.state().spin(block));
    const double slowing = p * p * std::sin(alpha - tilt);
    if (w < 1e-4) return tilt + 0.5 * w * w / slowing;  // but for w^4
    simulation.run_until(simulation.time() + w / slowing);
  }
  ADD_FAILURE() << "it does not turn back";
  return 0.0;
}

void expect_rocks(const Json& at, const Json& row, double b, double h, Errors& errors) {
  Simulation simulation(scenes::rocking_block(b, h, of(row, "theta0")).system, tight());
  const LedgerWatch ledger(simulation);
  const BodyId block = simulation.system().body("block");
  const double quarter = of(row, "quarter_period_exact"), before = of(row, "omega_before_impact");
  simulation.run_until(0.5 * quarter);
  ASSERT_EQ(simulation.events().size(), 1u) << row;
  EXPECT_EQ(simulation.events()[0].kind, EventKind::closing);
  EXPECT_EQ(simulation.events()[0].mode, ContactMode::stick);
  constexpr double later = 1e-9;  // the spin changes by less than 1e-8 of itself
  simulation.run_until(quarter + later);

  // Both corners take part, at one instant: the left gets nothing and leaves.
  const auto impacts = events_of(simulation, EventKind::impact);
  ASSERT_EQ(impacts.size(), 2u) << row;
  const Json& law = at.at("contact_law_e0_mu2_solutions")[0];
  const auto impulses = law.at("impulses_t_n_left_right").get<std::vector<double>>();
  for (std::size_t i = 0; i < 2; ++i) {
    const EventRecord& impact = impacts[i];
    errors.time(impact.time, quarter, quarter);
    EXPECT_EQ(std::string(to_string(impact.mode)), law.at("modes")[i].get<std::string>()) << row;
    errors.impulse(impact.impulse[1], -before * impulses[2 * i]);
    errors.impulse(impact.impulse[0], -before * impulses[2 * i + 1]);
  }
  // The kinetic energy is that of a turn about a corner, 4/3 (b^2 + h^2) w^2 / 2, before and after.
  const double inertia = 4.0 / 3.0 * (b * b + h * h);
  errors.spin(-std::sqrt(2.0 * impacts[0].energy_before / inertia), before, -before);
  errors.spin(-std::sqrt(2.0 * impacts[0].energy_after / inertia), of(row, "omega_after_impact"), -before);
  errors.spin(std::sqrt(impacts[0].energy_after / impacts[0].energy_before), of(at, "omega_ratio"));
  EXPECT_NEAR(simulation.state().spin(block), of(row, "omega_after_impact"), 1e-7) << row;
  EXPECT_EQ(events_of(simulation, EventKind::lift_off).size(), 1u) << row;
  const auto closing = events_of(simulation, EventKind::closing);
  ASSERT_EQ(closing.size(), 2u) << row;
  EXPECT_EQ(closing[1].mode, ContactMode::stick);
  EXPECT_NE(closing[1].contact, closing[0].contact);

  errors.amplitude(next_amplitude(simulation, of(at, "p"), of(at, "alpha")), of(row, "next_amplitude_exact"),
                   of(row, "next_amplitude_exact"));
  EXPECT_TRUE(ledger.closes()) << row;
}

TEST(EventRocking, RatioOfSpinsAmplitudesAndQuarterPeriods) {
  const Json data = reference_data("contacts_planar.json").at("rocking_block").at("cases");
  const std::vector<std::pair<std::string, Vec<2>>> blocks{{"b0.2_h0.8", {0.2, 0.8}},
                                                           {"b0.5_h1.0", {0.5, 1.0}}};
  Errors errors;
  for (const auto& [name, half] : blocks) {
    const Json& at = data.at(name);
    ASSERT_EQ(at.at("rows").size(), 4u);
    for (const auto& row : at.at("rows")) expect_rocks(at, row, half[0], half[1], errors);
  }
  // Some hundred steps of 1e-11; the tilt of up to 0.8 alpha is unstable and multiplies errors by up to 4.
  EXPECT_LE(errors.time.value(), 1e-10);
  EXPECT_LE(errors.spin.value(), 1e-10);
  EXPECT_LE(errors.impulse.value(), 1e-10);
  EXPECT_LE(errors.amplitude.value(), 1e-10);
  note("times", errors.time.value());
  note("spins", errors.spin.value());
  note("impulses", errors.impulse.value());
  note("amplitudes", errors.amplitude.value());
}

TEST(EventRocking, ComesToRestOverAlternatingCorners) {
  // Spins shrink by 0.7 with each impact, e_n = 0 or not: the amplitudes add up to a finite time, and the
  // block stands flat behind it.
  Simulation simulation(scenes::rocking_block(0.5, 1.0, 0.05).system, tight());
  const LedgerWatch ledger(simulation);
  const BodyId block = simulation.system().body("block");
  simulation.run_until(5.0);
  EXPECT_NEAR(simulation.state().angle(block), 0.0, 1e-9);
  EXPECT_NEAR(simulation.state().position(block)[1], 1.0, 1e-9);
  EXPECT_NEAR(simulation.state().spin(block), 0.0, 1e-13);
  EXPECT_FALSE(events_of(simulation, EventKind::accumulation).empty());
  const auto impacts = events_of(simulation, EventKind::impact);
  ASSERT_GE(impacts.size(), 20u);
  // Small tilts: quarter periods T = w/(p^2 sin alpha) with w the spin behind an impact, there and back.
  const double last = impacts.back().time, before = impacts[impacts.size() - 3].time;
  EXPECT_GT(last, before);
  std::size_t told = 0;
  for (const EventRecord& event : events_of(simulation, EventKind::accumulation)) {
    if (std::isnan(event.accumulation_time)) continue;
    ++told;
    const double w = 0.7 * std::sqrt(2.0 * impacts.back().energy_before / (4.0 / 3.0 * 1.25));
    const double flight = 2.0 * w / (1.5 * g * 0.5 / (2.0 * 1.25) * 1.0);
    EXPECT_NEAR(event.accumulation_time, last + flight / 0.3, 1e-6);
  }
  EXPECT_GT(told, 0u);
  EXPECT_TRUE(ledger.closes());
}

}  // namespace
