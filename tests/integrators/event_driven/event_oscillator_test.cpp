// Event-driven oscillators with stops: the forced impact oscillator, a ball on a vibrating table.

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
constexpr double pi = 3.14159265358979323846;

double of(const Json& data, const char* key) { return data.at(key).get<double>(); }

System impact_oscillator(const Json& data) {
  return scenes::impact_oscillator({.force = of(data, "F"),
                                    .frequency = of(data, "w"),
                                    .wall = of(data, "wall"),
                                    .restitution = of(data, "e"),
                                    .position = of(data, "x0"),
                                    .speed = of(data, "v0")})
      .system;
}

TEST(EventOscillator, ImpactOscillator) {
  const Json data = reference_data("contacts_planar.json").at("impact_oscillator").at("runs");
  ASSERT_EQ(data.size(), 3u);
  for (const auto& [name, run] : data.items()) {
    Simulation simulation(impact_oscillator(run), tight());
    const LedgerWatch ledger(simulation);
    const Json& impacts = run.at("impacts_t_vminus_vplus");
    simulation.run_until(impacts.back()[0].get<double>() + 1e-3);
    ASSERT_EQ(simulation.events().size(), impacts.size()) << name;
    Worst time, speed;
    for (std::size_t i = 0; i < impacts.size(); ++i) {
      const EventRecord& event = simulation.events()[i];
      EXPECT_EQ(event.kind, EventKind::impact) << name << i;
      time(event.time, impacts[i][0].get<double>());
      // The normal is -x.
      speed(-event.velocity_before[0], impacts[i][1].get<double>());
      speed(-event.velocity_after[0], impacts[i][2].get<double>());
    }
    // Impacts are up to 160 s from the start, a thousand steps and more; each hands on the error of its time.
    EXPECT_LE(time.value(), 1e-10) << name;
    EXPECT_LE(speed.value(), 1e-10) << name;
    note(name + " times", time.value());
    note(name + " speeds", speed.value());
    EXPECT_TRUE(ledger.closes()) << name;
  }
}

TEST(EventOscillator, UnstablePeriodicOrbitIsKeptForAWhile) {
  const Json data = reference_data("contacts_planar.json").at("impact_oscillator");
  const Json& orbit = data.at("periodic_orbits_F1_w2p8_wall0_e0p8")[0];
  const double w = 2.8, period = 2.0 * pi / w, start = of(orbit, "impact_time_mod_T");
  System system;
  system.add(HalfPlane{.normal = {-1.0, 0.0}}, Surface{.friction = 0.0, .normal_restitution = 0.8});
  const BodyId mass = system.add(Particle{.mass = 1.0, .velocity = {of(orbit, "v_after"), 0.0}});
  system.add(SpringDamper{.from = {ground, {0.0, 0.0}}, .to = mass, .stiffness = 1.0});
  system.add(
      AppliedForce{.on = mass, .force = [=](double t) { return Vec<2>(std::cos(w * (t + start)), 0.0); }});
  Simulation simulation(std::move(system), tight());
  const LedgerWatch ledger(simulation);
  constexpr int periods = 8;
  simulation.run_until((periods + 0.5) * period);
  ASSERT_EQ(simulation.events().size(), static_cast<std::size_t>(periods));
  // An error grows by 2.96 each period: by less than 3e4 over nine; it starts with the last digits given.
  for (int i = 0; i < periods; ++i) {
    const EventRecord& event = simulation.events()[static_cast<std::size_t>(i)];
    EXPECT_NEAR(event.time, (i + 1) * period, 1e-10 * std::pow(2.96, i)) << i;
    EXPECT_NEAR(-event.velocity_after[0], of(orbit, "v_after"), 1e-10 * std::pow(2.96, i)) << i;
  }
  EXPECT_TRUE(ledger.closes());
}

TEST(EventOscillator, GrazingIsFoundFromOneSideOnly) {
  // On the steady response  x = F/(1 - w^2) cos(w t)  a stop at s is met if F > F_grazing = s |1 - w^2|.
  const Json data = reference_data("contacts_planar.json").at("impact_oscillator").at("grazing_values");
  ASSERT_EQ(data.size(), 3u);
  for (const auto& at : data) {
    const double w = of(at, "w"), wall = of(at, "wall");
    for (const double off : {-1e-6, -1e-9, 1e-9, 1e-6, 1e-3}) {
      const double size = of(at, "F_grazing") * (1.0 + off), amplitude = size / (1.0 - w * w);
      // From half a period before the top.
      const double shift = amplitude > 0.0 ? pi : 0.0;
      System system;
      system.add(HalfPlane{.point = {wall, 0.0}, .normal = {-1.0, 0.0}},
                 Surface{.friction = 0.0, .normal_restitution = 0.8});
      const BodyId mass = system.add(Particle{.mass = 1.0, .position = {-std::abs(amplitude), 0.0}});
      system.add(SpringDamper{.from = {ground, {0.0, 0.0}}, .to = mass, .stiffness = 1.0});
      system.add(AppliedForce{
          .on = mass, .force = [=](double t) { return Vec<2>(size * std::cos(w * t + shift), 0.0); }});
      Simulation simulation(std::move(system), tight());
      const LedgerWatch ledger(simulation);
      simulation.run_until(1.2 * pi / w);
      if (off < 0.0) {
        EXPECT_TRUE(simulation.events().empty()) << at << off;
      } else {
        ASSERT_GE(simulation.events().size(), 1u) << at << off;
        const EventRecord& impact = simulation.events()[0];
        // |x| cos(pi - w t) = s; the speed there is w sqrt(|x|^2 - s^2), of the order of sqrt(2 a d).
        const double overlap = std::abs(amplitude) - wall;
        const double speed = w * std::sqrt(overlap * (std::abs(amplitude) + wall));
        EXPECT_NEAR(impact.time, (pi - std::acos(wall / std::abs(amplitude))) / w, 1e-11 / speed)
            << at << off;
        // Slower than the capture speed it takes no rebound; but the force draws it off the stop.
        const bool slow = speed < tight().capture_speed;
        EXPECT_EQ(impact.kind, slow ? EventKind::accumulation : EventKind::impact) << at << off;
        EXPECT_TRUE(events_of(simulation, EventKind::closing).empty()) << at << off;
        // An error of the place of 1e-11 is one of the overlap.
        EXPECT_NEAR(-impact.velocity_before[0], speed, speed * 1e-11 / overlap) << at << off;
      }
      EXPECT_TRUE(ledger.closes()) << at << off;
    }
  }
}

System vibrating_table(double size, double w, double phase, double e, double y, double speed) {
  return scenes::vibrating_table({.amplitude = size,
                                  .frequency = w,
                                  .phase = phase,
                                  .restitution = e,
                                  .height = y,
                                  .speed = speed})
      .system;
}

// The period-1 orbit with n periods per flight leaves the table at the speed n pi g/w when the table's phase
// is that whose cosine is n pi (1 - e)/((1 + e) Gamma).
struct Orbit {
  double w, size, phase, speed;
  int n;
};
Orbit orbit_of(double e, int n, double gamma) {
  constexpr double w = 50.0;
  const double c = n * pi * (1.0 - e) / ((1.0 + e) * gamma);
  return {w, gamma * g / (w * w), std::acos(c), n * pi * g / w, n};
}

TEST(EventOscillator, VibratingTableExample) {
  const Json data = reference_data("contacts_planar.json").at("vibrating_table").at("example");
  const double size = of(data, "A"), w = of(data, "w"), start = of(data, "first_impact_time");
  // The orbit begins with the impact at that time: it comes back a period later.
  EXPECT_NEAR(size * std::sin(w * start), of(data, "height_at_take_off"), 1e-12);
  Simulation simulation(vibrating_table(size, w, w * start, of(data, "e"), size * std::sin(w * start),
                                        of(data, "take_off_speed")),
                        tight());
  const LedgerWatch ledger(simulation);
  const BodyId ball = simulation.system().body("ball");
  simulation.run_until(of(data, "take_off_speed") / g);
  EXPECT_NEAR(simulation.state().position(ball)[1] - of(data, "height_at_take_off"),
              of(data, "apex_above_take_off"), 1e-12);
  simulation.run_until(1.5 * of(data, "period"));
  ASSERT_EQ(simulation.events().size(), 1u);
  EXPECT_NEAR(simulation.events()[0].time, of(data, "period"), 1e-12);
  // Speeds of events are against the table.
  const double table = size * w * std::cos(w * start);
  EXPECT_NEAR(simulation.events()[0].velocity_after[0] + table, of(data, "take_off_speed"), 1e-12);
  EXPECT_TRUE(ledger.closes());

  // The same in the time of the file: thrown so that it lands at its first impact with the orbit's speed.
  const double down = -of(data, "take_off_speed"), back = start;
  const double y = size * std::sin(w * start) - down * back - 0.5 * g * back * back;
  Simulation whole(vibrating_table(size, w, 0.0, of(data, "e"), y, down + g * back), tight());
  const LedgerWatch whole_ledger(whole);
  whole.run_until(start + 10.5 * of(data, "period"));
  ASSERT_EQ(whole.events().size(), 11u);
  for (std::size_t i = 0; i < whole.events().size(); ++i) {
    EXPECT_NEAR(whole.events()[i].time, start + static_cast<double>(i) * of(data, "period"), 1e-11) << i;
    EXPECT_NEAR(whole.events()[i].velocity_after[0] + table, of(data, "take_off_speed"), 1e-11) << i;
  }
  EXPECT_TRUE(whole_ledger.closes());
}

/// Starts on an orbit but for a small error of the speed; returns how far the take-off speed of the last of
/// many flights is off, as a multiple of that error.
double growth(const Orbit& orbit, double e, int flights) {
  constexpr double error = 1e-6;
  Simulation simulation(vibrating_table(orbit.size, orbit.w, orbit.phase, e,
                                        orbit.size * std::sin(orbit.phase), orbit.speed * (1.0 + error)),
                        tight());
  const LedgerWatch ledger(simulation);
  simulation.run_until((flights + 0.5) * orbit.n * 2.0 * pi / orbit.w);
  EXPECT_EQ(simulation.events().size(), static_cast<std::size_t>(flights));
  EXPECT_TRUE(ledger.closes());
  const EventRecord& last = simulation.events().back();
  const double table = orbit.size * orbit.w * std::cos(orbit.w * last.time + orbit.phase);
  return std::abs((last.velocity_after[0] + table) / orbit.speed - 1.0) / error;
}

TEST(EventOscillator, PeriodOneOrbitsAreStableUpToGammaHigh) {
  const Json rows = reference_data("contacts_planar.json").at("vibrating_table").at("rows");
  ASSERT_EQ(rows.size(), 4u);
  for (const auto& row : rows) {
    const double e = of(row, "e"), low = of(row, "Gamma_low"), high = of(row, "Gamma_high");
    const int n = row.at("n").get<int>();
    // In the middle both multipliers have the modulus e.
    const double inside = growth(orbit_of(e, n, 0.5 * (low + high)), e, 30);
    EXPECT_LE(inside, 100.0 * std::pow(e, 30)) << row;
    // Five hundredths above, one is below -1: the error grows, and turns its sign each time.
    const double outside = growth(orbit_of(e, n, 1.05 * high), e, 10);
    EXPECT_GT(outside, 1.0) << row;
    const double later = growth(orbit_of(e, n, 1.05 * high), e, 16);
    EXPECT_GT(later, 1.2 * outside) << row;
  }
}

TEST(EventOscillator, NoOrbitBelowGammaLow) {
  // The ball loses too much: it comes to rest on the table, which for Gamma < 1 it never leaves again.
  constexpr double e = 0.8, w = 50.0, gamma = 0.3;  // Gamma_low is 0.349
  const double size = gamma * g / (w * w);
  Simulation simulation(vibrating_table(size, w, 0.0, e, 0.0, pi * g / w), tight());
  const LedgerWatch ledger(simulation);
  simulation.run_until(10.0);
  EXPECT_EQ(events_of(simulation, EventKind::closing).size(), 1u);
  EXPECT_EQ(events_of(simulation, EventKind::lift_off).size(), 0u);
  const BodyId ball = simulation.system().body("ball");
  EXPECT_NEAR(simulation.state().position(ball)[1], size * std::sin(w * simulation.time()), 1e-11);
  EXPECT_NEAR(simulation.state().velocity(ball)[1], size * w * std::cos(w * simulation.time()), 1e-11);
  EXPECT_TRUE(ledger.closes());
}

TEST(EventOscillator, TheBallLeavesTheTableWhereItFallsFasterThanTheBall) {
  // At rest on the table at its middle, going up: it takes off where Gamma sin(w t) = 1.
  constexpr double w = 20.0, gamma = 1.5;
  const double size = gamma * g / (w * w);
  Simulation simulation(vibrating_table(size, w, 0.0, 0.0, 0.0, size * w), tight());
  const LedgerWatch ledger(simulation);
  const BodyId ball = simulation.system().body("ball");
  const double off = std::asin(1.0 / gamma) / w;
  simulation.run_until(1.5 * off);
  ASSERT_EQ(simulation.events().size(), 2u);
  EXPECT_EQ(simulation.events()[0].kind, EventKind::closing);
  EXPECT_EQ(simulation.events()[1].kind, EventKind::lift_off);
  EXPECT_NEAR(simulation.events()[1].time, off, 1e-11);
  const double since = 0.5 * off;
  EXPECT_NEAR(simulation.state().position(ball)[1],
              size / gamma + size * w * std::cos(w * off) * since - 0.5 * g * since * since, 1e-11);
  EXPECT_TRUE(ledger.closes());
}

}  // namespace
