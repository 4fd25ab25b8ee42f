// Event-driven impacts against closed forms: the bouncing ball up to and beyond its accumulation, Johansson's
// tables, Horak's ball, Walton's curves.

#include "examples/scenes/tables.h"
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

TEST(EventImpacts, BouncingBallThroughItsAccumulation) {
  const Json data = reference_data("impacts_planar.json").at("bouncing_ball");
  Simulation simulation(scenes::ball_above_floor(1.0, 0.8).system, tight());
  const LedgerWatch ledger(simulation);
  const BodyId ball = simulation.system().body("ball");
  Worst state;
  std::vector<double> times;
  for (const auto& [time, at] : data.at("states").items()) times.push_back(std::stod(time));
  std::sort(times.begin(), times.end());
  ASSERT_EQ(times.size(), 10u);
  for (const double time : times) {
    simulation.run_until(time);
    for (const auto& [text, at] : data.at("states").items()) {
      if (std::stod(text) != time) continue;
      state(simulation.state().position(ball)[1], of(at, "y"));
      state(simulation.state().velocity(ball)[1], of(at, "v"));
    }
  }
  // Flights are parabolas; what is left is the rounding of gaps, 6e-14 m, at every impact: its time is off by
  // that over the speed, the speed by g times that.
  EXPECT_LE(state.value(), 1e-11);
  note("states", state.value());

  const auto impacts = events_of(simulation, EventKind::impact);
  ASSERT_GE(impacts.size(), data.at("impacts").size());
  Worst time, speed;
  for (std::size_t i = 0; i < data.at("impacts").size(); ++i) {
    const Json& at = data.at("impacts")[i];
    time(impacts[i].time, of(at, "t"));
    speed(impacts[i].velocity_before[0], of(at, "v_minus"));
    speed(impacts[i].velocity_after[0], of(at, "v_plus"));
  }
  EXPECT_LE(time.value(), 1e-11);
  EXPECT_LE(speed.value(), 1e-11);
  note("times", time.value());
  note("speeds", speed.value());

  const auto closed = events_of(simulation, EventKind::accumulation);
  ASSERT_EQ(closed.size(), 1u);
  EXPECT_NEAR(closed[0].accumulation_time, of(data, "zeno_time"), 1e-8);
  note("accumulation time", std::abs(closed[0].accumulation_time - of(data, "zeno_time")));
  EXPECT_LT(closed[0].time, of(data, "zeno_time"));
  EXPECT_NEAR(simulation.state().position(ball)[1], 0.0, 1e-12);
  EXPECT_EQ(simulation.state().velocity(ball)[1], 0.0);
  ASSERT_EQ(events_of(simulation, EventKind::closing).size(), 1u);
  // Thrown away: the energy of the last approach, below the capture speed.
  EXPECT_GT(simulation.energy().flow(EnergyFlow::accumulation), 0.0);
  EXPECT_LE(simulation.energy().flow(EnergyFlow::accumulation), 0.5 * 1e-8);
  EXPECT_TRUE(ledger.closes());
}

TEST(EventImpacts, BounceThenRoll) {
  // The capture leaves out the last flights and costs nothing: with or without them the normal forces hold
  // the disc up over the same time and bring it to the same height, so that their impulse and its integral
  // are the same, and with them those of friction.
  Worst time, place, speed;
  const Json data = reference_data("impacts_planar.json").at("bounce_then_roll").at("cases");
  ASSERT_EQ(data.size(), 3u);
  for (const auto& at : data) {
    constexpr double r = 0.1;
    scenes::BodyScene scene = scenes::round_body(
        {.mass = 1.0, .inertia = 0.5 * r * r}, r,
        {.friction = of(at, "mu"), .normal_restitution = of(at, "e_n")}, 0.5, {2.0, 0.0}, 0.0);
    const BodyId disc = scene.body;
    Simulation simulation(std::move(scene.system), tight());
    const LedgerWatch ledger(simulation);
    simulation.run_until(10.0);
    const auto impacts = events_of(simulation, EventKind::impact);
    ASSERT_GE(impacts.size(), at.at("first_impacts").size());
    for (std::size_t i = 0; i < at.at("first_impacts").size(); ++i) {
      time(impacts[i].time, of(at.at("first_impacts")[i], "t"));
      EXPECT_EQ(kind_of(impacts[i].mode), at.at("first_impacts")[i].at("mode").get<std::string>()) << at << i;
    }
    const auto closed = events_of(simulation, EventKind::accumulation);
    ASSERT_EQ(closed.size(), 1u) << at;
    EXPECT_NEAR(closed[0].accumulation_time, of(at, "zeno_time"), 1e-8) << at;
    if (of(at, "slip_speed_at_zeno") > 0.0) {
      const auto stick = events_of(simulation, EventKind::stick);
      ASSERT_EQ(stick.size(), 1u) << at;
      time(stick[0].time, of(at, "t_roll"));
    }
    place(simulation.state().position(disc)[0], of(at, "x_at_10s"), of(at, "x_at_10s"));
    speed(simulation.state().velocity(disc)[0], of(at, "v_roll"));
    speed(-r * simulation.state().spin(disc), of(at, "v_roll"));
    EXPECT_NEAR(simulation.state().position(disc)[1], r, 1e-11);
    EXPECT_TRUE(ledger.closes()) << at;
  }
  EXPECT_LE(time.value(), 1e-9);
  EXPECT_LE(place.value(), 1e-9);
  EXPECT_LE(speed.value(), 1e-9);
  note("times", time.value());
  note("places", place.value());
  note("speeds", speed.value());
}

/// The number after a word in the name of a run.
double named(const std::string& name, const std::string& word) {
  return std::stod(name.substr(name.find(word) + word.size()));
}

TEST(EventImpacts, JohanssonTables) {
  constexpr double m = scenes::ball_mass;
  Worst time, velocity, spin;
  int runs = 0;
  const Json data = reference_data("impacts_planar.json").at("johansson_tables").at("runs");
  for (const auto& [name, run] : data.items()) {
    System system;
    const BodyId ball = scenes::add_tables(system, {.tangential_restitution = named(name, "et"),
                                                    .horizontal_speed = named(name, "_vx"),
                                                    .vertical_speed = named(name, "_vy"),
                                                    .height = named(name, "_y"),
                                                    .spin = named(name, "_spin")});
    const ObstacleId low = system.obstacle("lower table");
    Simulation simulation(std::move(system), tight());
    const LedgerWatch ledger(simulation);
    for (const auto& at : run) {
      constexpr double later = 1e-3;
      simulation.run_until(of(at, "t") + later);
      const auto impacts = events_of(simulation, EventKind::impact);
      ASSERT_EQ(impacts.size(), of(at, "n")) << name;
      const EventRecord& impact = impacts.back();
      EXPECT_EQ(impact.obstacle == low, at.at("table").get<std::string>() == "low") << name << at;
      EXPECT_EQ(kind_of(impact.mode), at.at("mode").get<std::string>()) << name << at;
      time(impact.time, of(at, "t"));
      const State& state = simulation.state();
      velocity(state.velocity(ball)[0], of(at, "vx_plus"));
      velocity(state.velocity(ball)[1], of(at, "vy_plus") - g * later);
      spin(state.spin(ball), of(at, "spin_plus"), std::max(1.0, std::abs(of(at, "spin_plus"))));
      // The file gives the energy of all, height from the lower table.
      EXPECT_NEAR(impact.energy_before + m * g * of(at, "y"), of(at, "energy_before"), 1e-11) << name << at;
      EXPECT_NEAR(impact.energy_after + m * g * of(at, "y"), of(at, "energy_after"), 1e-11) << name << at;
    }
    EXPECT_TRUE(ledger.closes()) << name;
    ++runs;
  }
  EXPECT_EQ(runs, 12);
  EXPECT_LE(time.value(), 1e-11);
  EXPECT_LE(velocity.value(), 1e-11);
  EXPECT_LE(spin.value(), 1e-11);
  note("times", time.value());
  note("velocities", velocity.value());
  note("spins", spin.value());
}

TEST(EventImpacts, HorakBall) {
  constexpr double r = 0.0359, m = 0.1134, height = 0.799, later = 0.1;
  const Json data = reference_data("impacts_planar.json").at("horak");
  const double fall = std::sqrt(2.0 * height / g);
  Worst velocity, spin;
  for (const auto& [name, result] : data.at("results").items()) {
    for (const auto& row : result.at("rows")) {
      scenes::BodyScene scene = scenes::round_body(thin_shell(m, r), r,
                                                   {.friction = of(result, "mu"),
                                                    .normal_restitution = of(result, "e_n"),
                                                    .tangential_restitution = of(result, "e_t")},
                                                   height, {0.0, 0.0}, of(row, "spin_before"));
      const BodyId ball = scene.body;
      Simulation simulation(std::move(scene.system), tight());
      const LedgerWatch ledger(simulation);
      simulation.run_until(fall + later);
      ASSERT_EQ(simulation.events().size(), 1u) << name << row;
      EXPECT_NEAR(simulation.events()[0].time, fall, 1e-12);
      // "slip+1" in the file.
      EXPECT_TRUE(row.at("mode").get<std::string>().starts_with(kind_of(simulation.events()[0].mode)));
      const State& state = simulation.state();
      velocity(state.velocity(ball)[0], of(row, "vx_after"));
      velocity(state.velocity(ball)[1], of(row, "vy_after") - g * later);
      spin(state.spin(ball), of(row, "spin_after"), 1.0 + of(row, "spin_before"));
      EXPECT_TRUE(ledger.closes()) << name << row;
    }
  }
  EXPECT_LE(velocity.value(), 1e-11);
  EXPECT_LE(spin.value(), 1e-11);
  note("velocities", velocity.value());
  note("spins", spin.value());
}

TEST(EventImpacts, WaltonCurvesFromContactsThatStartClosed) {
  Worst speed;
  const Json data = reference_data("impacts_planar.json").at("walton_curves").at("cases");
  ASSERT_EQ(data.size(), 3u);
  for (const auto& curve : data) {
    constexpr double r = 1.59e-3, m = 4.0e-5;
    for (const auto& point : curve.at("curve_psi1_psi2_mode")) {
      scenes::BodyScene scene =
          scenes::round_body({.mass = m, .inertia = of(curve, "I_over_m_r2") * m * r * r}, r,
                             {.friction = of(curve, "mu"),
                              .normal_restitution = of(curve, "e_n"),
                              .tangential_restitution = of(curve, "beta0")},
                             0.0, {point[0].get<double>(), -1.0}, 0.0);
      const BodyId ball = scene.body;
      Simulation simulation(std::move(scene.system), tight());
      const LedgerWatch ledger(simulation);
      simulation.step();
      ASSERT_EQ(simulation.events().size(), 1u) << curve << point;
      EXPECT_EQ(simulation.events()[0].time, 0.0);
      EXPECT_EQ(simulation.events()[0].kind, EventKind::impact);
      const State& state = simulation.state();
      speed(state.velocity(ball)[0] + r * state.spin(ball), point[1].get<double>());
      speed(state.velocity(ball)[1], of(curve, "e_n"));
      EXPECT_TRUE(ledger.closes()) << curve << point;
    }
  }
  EXPECT_LE(speed.value(), 1e-12);
  note("speeds", speed.value());
}

TEST(EventImpacts, RandomContacts) {
  const Json data = reference_data("open_variants.json").at("single_contact");
  ASSERT_EQ(data.size(), 40u);
  Worst worst;
  int impacts = 0;
  for (const auto& at : data) {
    const auto point = at.at("contact_from_centre").get<std::vector<double>>();
    const auto before = at.at("v_minus").get<std::vector<double>>();
    Simulation simulation(
        scenes::struck_point({.mass = of(at, "m"), .inertia = of(at, "I")}, {point[0], point[1]},
                             {.friction = of(at, "mu"),
                              .normal_restitution = of(at, "e_n"),
                              .tangential_restitution = of(at, "e_t")},
                             {before[0], before[1]})
            .system,
        tight());
    const LedgerWatch ledger(simulation);
    simulation.run_until(1e-6);
    EXPECT_TRUE(ledger.closes()) << at;
    if (before[1] > 0.0) {
      EXPECT_TRUE(simulation.events().empty()) << at;
      continue;
    }
    ++impacts;
    ASSERT_GE(simulation.events().size(), 1u) << at;
    const EventRecord& impact = simulation.events()[0];
    EXPECT_EQ(impact.kind, EventKind::impact) << at;
    // [mode, P_t, P_n, tangential, normal velocity after], one of them where there are several.
    bool found = false;
    for (const Json& solution : at.at("solutions")) {
      const double size = 1.0 + solution[2].get<double>();
      const double error = std::max({std::abs(impact.impulse[1] - solution[1].get<double>()),
                                     std::abs(impact.impulse[0] - solution[2].get<double>()),
                                     std::abs(impact.velocity_after[1] - solution[3].get<double>()),
                                     std::abs(impact.velocity_after[0] - solution[4].get<double>())});
      if (error > 1e-9 * size) continue;
      found = true;
      worst(error, 0.0, size);
    }
    EXPECT_TRUE(found) << at;
  }
  EXPECT_GT(impacts, 30);
  EXPECT_LE(worst.value(), 1e-12);
  note("impulses and velocities", worst.value());
}

TEST(EventImpacts, ImpactsThatGainEnergyAreToldAndCanBeRefused) {
  const Json data = reference_data("impacts_planar.json").at("energy_inconsistency").at("values");
  int gains = 0;
  for (const auto& value : data) {
    const Surface surface{
        .friction = 1.0, .normal_restitution = of(value, "e_n"), .tangential_restitution = of(value, "e_t")};
    EventDriven options = tight();
    const System system =
        scenes::struck_point({.mass = 1.0, .inertia = 1.0}, {-1.0, -1.0}, surface, {1.0, -2.0}).system;
    Simulation simulation(system, options);
    const LedgerWatch ledger(simulation);
    simulation.run_until(1e-6);
    const EventRecord& impact = simulation.events().at(0);
    EXPECT_NEAR(impact.impulse[0], of(value, "Pn"), 1e-12) << value;
    EXPECT_NEAR(impact.impulse[1], of(value, "Pt"), 1e-12) << value;
    const double change = of(value, "energy_change");
    EXPECT_NEAR(impact.energy_after - impact.energy_before, change, 1e-12) << value;
    EXPECT_TRUE(ledger.closes()) << value;

    options.impact_rules.energy_gain = EnergyGain::refuse;
    Simulation strict(system, options);
    if (change > 1e-12) {
      ++gains;
      EXPECT_NEAR(simulation.statistics().energy_gained, change, 1e-12) << value;
      EXPECT_THROW(strict.run_until(1e-6), SolverError) << value;
      EXPECT_EQ(strict.time(), 0.0);
      EXPECT_EQ(strict.state().velocity(strict.system().body("body"))[1], -2.0);
    } else {
      EXPECT_EQ(simulation.statistics().energy_gains, 0) << value;
      EXPECT_NO_THROW(strict.run_until(1e-6)) << value;
    }
  }
  EXPECT_GT(gains, 0);
}

}  // namespace
