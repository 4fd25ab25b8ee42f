// A ball on a vibrating table, y = A sin(w t), G = A w^2/g, in both modes: orbits whose every flight takes n
// periods of the table, where they are stable and where their period doubles (P. J. Holmes, J. Sound Vib. 84
// (1982) 173; the exact map). The table is a half-plane, a block, the inside of a box and others, moved.

#include "tests/analytic/convergence.h"
#include "tests/integrators/event_run.h"
#include "tests/reference/reference_data.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::Json;
using carom_test::reference_data;
using carom_test::tight;

constexpr double g = 9.81, radius = 0.01;

/// The shapes that a table may be: name, and how it is added with its surface at y = 0.
struct Table {
  const char* name;
  void (*add)(System& system, const PrescribedMotion& motion, const Surface& law);
};
constexpr std::array<Table, 5> tables{{
    {"half-plane",
     [](System& system, const PrescribedMotion& motion, const Surface& law) {
       system.add(HalfPlane{.normal = {0.0, 1.0}, .motion = motion}, law);
     }},
    {"block",
     [](System& system, const PrescribedMotion& motion, const Surface& law) {
       system.add(planar::Block{.vertices = {{-1, -0.2}, {1, -0.2}, {1, 0}, {-1, 0}}, .motion = motion}, law);
     }},
    {"inside of a box",
     [](System& system, const PrescribedMotion& motion, const Surface& law) {
       system.add(BoxInside{.lower = {-1, 0}, .upper = {1, 9}, .motion = motion}, law);
     }},
    {"terrain",
     [](System& system, const PrescribedMotion& motion, const Surface& law) {
       system.add(Terrain{.vertices = {{-1, 0}, {-0.1, 0}, {1, 0}}, .depth = 1.0, .motion = motion}, law);
     }},
    {"wall",
     [](System& system, const PrescribedMotion& motion, const Surface& law) {
       system.add(Wall{.from = {-1, -0.1}, .to = {1, -0.1}, .radius = 0.1, .motion = motion}, law);
     }},
}};

/// The closed form of an orbit.
struct Orbit {
  double e, gamma, w, n;

  [[nodiscard]] double amplitude() const { return gamma * g / (w * w); }
  [[nodiscard]] double take_off() const { return n * std::numbers::pi * g / w; }  // [m/s]
  [[nodiscard]] double period() const { return n * 2.0 * std::numbers::pi / w; }
  [[nodiscard]] double impact() const {  // the first [s]
    return std::acos(n * std::numbers::pi * (1.0 - e) / ((1.0 + e) * gamma)) / w;
  }
  [[nodiscard]] double height() const { return amplitude() * std::sin(w * impact()); }  // of the impact [m]
  [[nodiscard]] PrescribedMotion motion() const {
    const double a = amplitude(), rate = w;
    return {
        .displacement = [a, rate](double t) { return Vec<2>(0.0, a * std::sin(rate * t)); },
        .velocity = [a, rate](double t) { return Vec<2>(0.0, a * rate * std::cos(rate * t)); },
        .acceleration = [a, rate](double t) { return Vec<2>(0.0, -a * rate * rate * std::sin(rate * t)); }};
  }
  /// A ball on this orbit, on its way down to the first impact. \param aside faster by this at time 0 [m/s]
  [[nodiscard]] System ball(const Table& table, double aside = 0.0) const {
    System system;
    system.add(Gravity{{0.0, -g}});
    table.add(system, motion(), {.friction = 0.0, .normal_restitution = e});
    const double start = height() + take_off() * impact() - 0.5 * g * impact() * impact();
    const BodyId body = system.add(RigidBody{.mass = disc(0.1, radius),
                                             .position = {0.0, start + radius},
                                             .velocity = {0.0, -take_off() + g * impact() + aside}},
                                   "ball");
    system.add(Disc{.body = body, .radius = radius});
    return system;
  }
};

Orbit orbit_of_example(const Json& of) { return {of["e"], of["Gamma"], of["w"], 1.0}; }

// The closed form here is that of the reference.
TEST(VibratingTable, TheOrbitIsThatOfTheReference) {
  const Json reference = reference_data("contacts_planar.json")["vibrating_table"];
  const Json example = reference["example"];
  const Orbit orbit = orbit_of_example(example);
  EXPECT_NEAR(orbit.amplitude(), example["A"], 1e-16);
  EXPECT_NEAR(orbit.impact(), example["first_impact_time"], 1e-16);
  EXPECT_NEAR(orbit.take_off(), example["take_off_speed"], 1e-15);
  EXPECT_NEAR(orbit.height(), example["height_at_take_off"], 1e-17);
  EXPECT_NEAR(orbit.period(), example["period"], 1e-16);
  EXPECT_NEAR(0.5 * orbit.take_off() * orbit.take_off() / g, example["apex_above_take_off"], 1e-16);
}

// Time, speed and height of 20 impacts. Errors do not grow: the orbit is stable.
TEST(VibratingTable, EventsOfTheOrbitAreExact) {
  const Orbit orbit = orbit_of_example(reference_data("contacts_planar.json")["vibrating_table"]["example"]);
  for (const Table& table : tables) {
    Simulation simulation(orbit.ball(table), tight());
    simulation.run_until(19.5 * orbit.period());
    const auto impacts = carom_test::events_of(simulation, EventKind::impact);
    ASSERT_EQ(impacts.size(), 20U) << table.name;
    for (std::size_t i = 0; i < impacts.size(); ++i) {
      const double time = orbit.impact() + static_cast<double>(i) * orbit.period();
      EXPECT_NEAR(impacts[i].time, time, 1e-11) << table.name << ", impact " << i;
      EXPECT_NEAR(impacts[i].motions[0].velocity_after[1], orbit.take_off(), 1e-10) << table.name;
      EXPECT_NEAR(impacts[i].motions[0].position[1], orbit.height() + radius, 1e-12) << table.name;
    }
    EXPECT_NEAR(simulation.energy().residual(), 0.0, 1e-11) << table.name;
  }
}

// Flights are exact, and the table is where it is at the instant: nothing of the step is left.
TEST(VibratingTable, LocatedStepsOfTheOrbitAreExact) {
  const Orbit orbit = orbit_of_example(reference_data("contacts_planar.json")["vibrating_table"]["example"]);
  for (const Table& table : tables) {
    for (const double step : {7e-3, 1e-3}) {
      Simulation simulation(orbit.ball(table), TimeStepping{.step = step, .impacts = ImpactTimes::located});
      simulation.run_until(20.0 * orbit.period());
      // A whole number of periods after the start, at the start's place and speed.
      const State& end = simulation.state();
      const double fall = orbit.impact();
      EXPECT_NEAR(end.v[1], -orbit.take_off() + g * fall, 1e-11) << table.name << ", step " << step;
      EXPECT_NEAR(end.q[1], orbit.height() + orbit.take_off() * fall - 0.5 * g * fall * fall + radius, 1e-12)
          << table.name << ", step " << step;
      EXPECT_EQ(simulation.statistics().impacts, 20) << table.name;
      EXPECT_NEAR(simulation.energy().residual(), 0.0, 1e-13) << table.name;
    }
  }
}

// Impacts noticed up to a step late: of first order, on every table the same.
TEST(VibratingTable, StepsOfTheOrbitAreOfFirstOrder) {
  const Orbit orbit = orbit_of_example(reference_data("contacts_planar.json")["vibrating_table"]["example"]);
  for (const Table& table : tables) {
    const analytic::MeanOrder order = analytic::mean_order(1e-3, 4, 12, [&](double step) {
      Simulation simulation(orbit.ball(table), TimeStepping{.step = step});
      simulation.run_until(orbit.period());
      const double fall = orbit.impact();
      return std::abs(simulation.state().v[1] + orbit.take_off() - g * fall);
    });
    EXPECT_NEAR(order.slope, 1.0, 3.0 * order.deviation + 0.1) << table.name;
  }
}

// A disturbance dies out where the reference says that the orbit is stable, and grows behind the doubling.
TEST(VibratingTable, OrbitsAreStableUpToThePeriodDoubling) {
  const Json rows = reference_data("contacts_planar.json")["vibrating_table"]["rows"];
  for (const Json& row : rows) {
    const double e = row["e"], low = row["Gamma_low"], high = row["Gamma_high"], n = row["n"];
    const double middle = 0.5 * (low + high);
    for (const double gamma : {middle, 0.99 * high + 0.01 * low, 1.02 * high}) {
      const Orbit orbit{e, gamma, 50.0, n};
      for (const Table& table : {tables[0], tables[1], tables[2]}) {
        const System system = orbit.ball(table, 1e-3 * orbit.take_off());
        Simulation simulation(system, tight());
        simulation.run_until(60.0 * orbit.period());
        const auto impacts = carom_test::events_of(simulation, EventKind::impact);
        ASSERT_GT(impacts.size(), 50U) << table.name;
        const auto off = [&](std::size_t i) {
          return std::abs(impacts[i].motions[0].velocity_after[1] / orbit.take_off() - 1.0);
        };
        const double late = std::max(off(impacts.size() - 1), off(impacts.size() - 2));
        if (gamma < high) {
          EXPECT_LT(late, 0.7 * std::max(off(0), off(1))) << table.name << " e " << e << " G " << gamma;
        } else {
          EXPECT_GT(late, 5.0 * std::max(off(0), off(1))) << table.name << " e " << e << " G " << gamma;
        }
        if (gamma != middle) continue;
        // Multipliers of size sqrt(det) = e: 20 impacts take the disturbance down by e^20, but for the phase.
        const double found = std::max(off(22), off(21)) / std::max(off(2), off(1));
        const double expected = std::pow(row["moduli_mid"][0].get<double>(), 20.0);
        EXPECT_LT(found, 20.0 * expected + 1e-5) << table.name << " e " << e;
        EXPECT_GT(found, expected / 20.0 - 1e-5) << table.name << " e " << e;
      }
    }
  }
}

}  // namespace
