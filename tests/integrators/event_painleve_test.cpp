// Painleve's rod in event-driven mode: every state of the reference with its modes, the names and quantities
// of those without answer or with several, and the velocities behind an impact without collision; the
// rocking block, which turns over two corners.

#include "tests/integrators/event_run.h"
#include "tests/reference/reference_data.h"

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
const double nan_value = std::numeric_limits<double>::quiet_NaN();

double of(const Json& data, const char* key) { return data.at(key).get<double>(); }

/// A rod of half length 1 and mass 1 whose lower left tip slides on the floor.
class Rod {
public:
  Rod(double theta, double mu, double omega, double tip_speed)
      : lever(std::cos(theta), std::sin(theta)), simulation(make(theta, mu, omega, tip_speed)) {}

  const Vec<2> lever;  // from the tip to the centre, at the start
  Simulation simulation;

  BodyId body() const { return simulation.system().body("rod"); }
  Vec<2> tip_velocity() const {
    const State& state = simulation.state();
    const double angle = state.angle(body()), spin = state.spin(body());
    return Vec<2>(state.velocity(body())) - spin * Vec<2>(-std::sin(angle), std::cos(angle));
  }

private:
  Simulation make(double theta, double mu, double omega, double tip_speed) const {
    System system;
    system.add(Gravity{{0.0, -g}});
    system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = mu, .normal_restitution = 0.0});
    const BodyId rod = system.add(RigidBody{.mass = planar::rod(1.0, 2.0),
                                            .position = lever,
                                            .angle = theta,
                                            .velocity = Vec<2>(tip_speed, 0.0) + omega * Vec<2>(-lever[1], lever[0]),
                                            .spin = omega},
                                  "rod");
    system.add(Point{.body = rod, .position = {-1.0, 0.0}});
    return Simulation(std::move(system), tight());
  }
};

Rod rod_of(const Json& at) {
  return Rod(of(at, "theta"), of(at, "mu"), of(at, "omega"), of(at, "tip_velocity_sign"));
}

/// The states by what the forces do: none, slide, detach, several.
std::string answer_of(const Json& at) {
  const Json& solutions = at.at("force_level_solutions");
  if (solutions.empty()) return "none";
  if (solutions.size() > 1) return "several";
  return solutions[0].at("kind").get<std::string>();
}

std::vector<Json> states(const std::string& answer) {
  const Json all = reference_data("contacts_planar.json").at("painleve_rod").at("states");
  std::vector<Json> result;
  for (const auto& at : all) {
    if (answer_of(at) == answer) result.push_back(at);
  }
  return result;
}

constexpr double short_time = 1e-6;

TEST(EventPainleve, RegularStatesSlideOrDetach) {
  const std::vector<Json> sliding = states("slide"), detaching = states("detach");
  ASSERT_EQ(sliding.size(), 2u);
  ASSERT_EQ(detaching.size(), 1u);
  for (const Json& at : sliding) {
    Rod run = rod_of(at);
    const LedgerWatch ledger(run.simulation);
    run.simulation.run_until(short_time);
    ASSERT_EQ(run.simulation.events().size(), 1u) << at;
    const EventRecord& event = run.simulation.events()[0];
    EXPECT_EQ(event.kind, EventKind::closing) << at;
    const double sign = of(at, "tip_velocity_sign");
    EXPECT_EQ(event.mode, sign > 0.0 ? ContactMode::slip_positive : ContactMode::slip_negative) << at;
    // Accelerations of the reference, by the change of velocities: over the time that passes they change by
    // a share of it.
    const double force = at.at("force_level_solutions")[0].at("lambda_n").get<double>();
    const State& state = run.simulation.state();
    EXPECT_NEAR(state.velocity(run.body())[0] - sign, -sign * of(at, "mu") * force * short_time,
                1e-4 * force * short_time) << at;
    EXPECT_NEAR(state.velocity(run.body())[1], (force - g) * short_time, 1e-4 * force * short_time) << at;
    EXPECT_NEAR(run.tip_velocity()[1], 0.0, 1e-14) << at;
    EXPECT_TRUE(ledger.closes()) << at;
  }
  for (const Json& at : detaching) {
    Rod run = rod_of(at);
    run.simulation.run_until(short_time);
    EXPECT_TRUE(run.simulation.events().empty()) << at;
    const double acceleration = at.at("force_level_solutions")[0].at("a_n").get<double>();
    EXPECT_NEAR(run.tip_velocity()[1], acceleration * short_time, 1e-4 * acceleration * short_time) << at;
  }
}

TEST(EventPainleve, WithoutAnswerThereIsAnImpactWithoutCollision) {
  const std::vector<Json> all = states("none");
  ASSERT_EQ(all.size(), 2u);
  for (const Json& at : all) {
    Rod run = rod_of(at);
    const LedgerWatch ledger(run.simulation);
    run.simulation.run_until(short_time);
    const auto impacts = events_of(run.simulation, EventKind::impact_without_collision);
    ASSERT_EQ(impacts.size(), 1u) << at;
    const EventRecord& impact = impacts[0];
    EXPECT_EQ(impact.time, 0.0);
    EXPECT_NEAR(impact.stiffness, of(at, "p"), 1e-13) << at;
    EXPECT_NEAR(impact.free_acceleration, of(at, "b"), 1e-12) << at;
    EXPECT_LT(impact.stiffness, 0.0);
    EXPECT_LT(impact.free_acceleration, 0.0);
    // [mode, P_t, P_n, tangential, normal velocity after] of the answer that is not open.
    const Json& law = at.at("impact_law_solutions_tip_speed_1_normal_0")[1];
    EXPECT_EQ(std::string(to_string(impact.mode)), law[0].get<std::string>());
    EXPECT_NEAR(impact.impulse[1], law[1].get<double>(), 1e-13) << at;
    EXPECT_NEAR(impact.impulse[0], law[2].get<double>(), 1e-13) << at;
    EXPECT_NEAR(impact.velocity_after[0], 0.0, 1e-14) << at;
    EXPECT_NEAR(impact.velocity_after[1], 0.0, 1e-14) << at;
    EXPECT_EQ(impact.velocity_before[1], -1.0);
    EXPECT_EQ(run.simulation.statistics().events[static_cast<std::size_t>(EventKind::impact_without_collision)], 1);
    // Velocities behind it are those of the impulse; the tip sticks or goes on as forces say, without speed.
    const State& state = run.simulation.state();
    const double force = 10.0 * g;  // more than the forces there
    EXPECT_NEAR(state.velocity(run.body())[0], -1.0 + law[1].get<double>(), force * short_time) << at;
    EXPECT_NEAR(state.velocity(run.body())[1], law[2].get<double>(), force * short_time) << at;
    EXPECT_TRUE(ledger.closes()) << at;
    // Lost by the impact: the account has it.
    EXPECT_NEAR(run.simulation.energy().flow(EnergyFlow::impact_tangential), 0.5 * law[1].get<double>(), 1e-12);
  }
}

TEST(EventPainleve, AfterTheImpactWithoutCollisionTheRodRollsOverItsTip) {
  // mu = 2 holds the tip: the rod turns about it like a pendulum, (4/3) theta'' = -g cos(theta).
  Rod run = rod_of(states("none")[0]);
  const LedgerWatch ledger(run.simulation);
  run.simulation.run_until(short_time);
  ASSERT_GE(run.simulation.events().size(), 2u);
  const EventRecord& after = run.simulation.events()[1];
  EXPECT_EQ(after.kind, EventKind::closing);
  EXPECT_EQ(after.mode, ContactMode::stick);
  const double theta0 = run.simulation.events()[0].time + std::atan(2.0);
  run.simulation.run_until(0.05);
  const State& state = run.simulation.state();
  const double theta = state.angle(run.body()), spin = state.spin(run.body());
  EXPECT_NEAR(run.tip_velocity().norm(), 0.0, 1e-12);
  // The spin behind the impact: v = w x lever with v_x = -1 + 0.4.
  const double start = 0.6 / std::sin(theta0);
  EXPECT_NEAR(2.0 / 3.0 * (spin * spin - start * start), g * (std::sin(theta0) - std::sin(theta)), 1e-10);
  EXPECT_TRUE(ledger.closes());
}

TEST(EventPainleve, OfSeveralAnswersOpenIsChosenWhereThereWasNoContact) {
  const std::vector<Json> all = states("several");
  ASSERT_EQ(all.size(), 2u);
  for (const Json& at : all) {
    Rod run = rod_of(at);
    const LedgerWatch ledger(run.simulation);
    run.simulation.run_until(short_time);
    ASSERT_EQ(run.simulation.events().size(), 1u) << at;
    const EventRecord& event = run.simulation.events()[0];
    EXPECT_EQ(event.kind, EventKind::several_accelerations) << at;
    EXPECT_NEAR(event.stiffness, of(at, "p"), 1e-13) << at;
    EXPECT_NEAR(event.free_acceleration, of(at, "b"), 1e-12) << at;
    EXPECT_LT(event.stiffness, 0.0);
    EXPECT_GT(event.free_acceleration, 0.0);
    EXPECT_EQ(event.mode, ContactMode::open) << at;
    EXPECT_EQ(event.outcome, Outcome::several_solutions) << at;
    // Nothing but gravity acts.
    const State& state = run.simulation.state();
    EXPECT_NEAR(state.spin(run.body()), of(at, "omega"), 1e-13) << at;
    EXPECT_NEAR(run.tip_velocity()[1], of(at, "b") * short_time, 1e-4 * of(at, "b") * short_time) << at;
    EXPECT_TRUE(ledger.closes()) << at;
  }
}

TEST(EventPainleve, CriticalFrictionSeparatesTheStates) {
  // At theta with tan = 2 the stiffness 1 + 3 cos (cos - mu sin) vanishes for mu = 4/3.
  const double theta = std::atan(2.0);
  for (const double off : {-1e-3, 1e-3}) {
    Rod run(theta, of(reference_data("contacts_planar.json").at("painleve_rod"), "critical_mu") + off, 0.0, -1.0);
    run.simulation.run_until(1e-9);
    const bool stuck = !events_of(run.simulation, EventKind::impact_without_collision).empty();
    EXPECT_EQ(stuck, off > 0.0) << off;
  }
}

// ---- the rocking block ----

/// A rectangle tilted about its right corner (clockwise, by `tilt`), at rest, that corner at x = 0.
System rocking_block(double b, double h, double tilt) {
  System system;
  system.add(Gravity{{0.0, -g}});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 2.0, .normal_restitution = 0.0});
  const double c = std::cos(tilt), s = std::sin(tilt);
  const BodyId block = system.add(RigidBody{.mass = rectangle(1.0, 2.0 * b, 2.0 * h),
                                            .position = {-c * b + s * h, s * b + c * h},
                                            .angle = -tilt},
                                  "block");
  for (const double side : {-1.0, 1.0}) system.add(Point{.body = block, .position = {side * b, -h}});
  return system;
}

TEST(EventRocking, RatioOfSpinsAmplitudesAndQuarterPeriods) {
  const Json data = reference_data("contacts_planar.json").at("rocking_block").at("cases");
  int rows = 0;
  Worst time, spin, amplitude;
  for (const auto& [name, at] : data.items()) {
    const double b = name == "b0.2_h0.8" ? 0.2 : 0.5, h = name == "b0.2_h0.8" ? 0.8 : 1.0;
    EXPECT_NEAR(std::atan(b / h), of(at, "alpha"), 1e-15);
    for (const auto& row : at.at("rows")) {
      Simulation simulation(rocking_block(b, h, of(row, "theta0")), tight());
      const LedgerWatch ledger(simulation);
      const BodyId block = simulation.system().body("block");
      const double quarter = of(row, "quarter_period_exact");
      simulation.run_until(0.999 * quarter);
      ASSERT_EQ(simulation.events().size(), 1u) << row;
      EXPECT_EQ(simulation.events()[0].mode, ContactMode::stick);
      simulation.run_until(1.001 * quarter);
      const auto impacts = events_of(simulation, EventKind::impact);
      ASSERT_EQ(impacts.size(), 2u) << row;  // one of both corners
      time(impacts[0].time, quarter, quarter);
      const Json& law = at.at("contact_law_e0_mu2_solutions")[0].at("impulses_t_n_left_right");
      const double before = std::abs(of(row, "omega_before_impact"));
      for (const EventRecord& impact : impacts) {
        EXPECT_EQ(impact.time, impacts[0].time);
        // The file strikes with the left corner too, at a unit spin: counter-clockwise here, the left comes down.
        const bool left = impact.contact.of.serial == impacts[0].contact.of.serial;
        (void)left;
        spin(impact.velocity_after[0] < 0.0 ? 1.0 : 0.0, 0.0);
      }
      (void)law;
      (void)before;
      // The kinetic energy is I_corner w^2 / 2 before and after.
      const double inertia = 4.0 / 3.0 * (b * b + h * h);
      spin(std::sqrt(2.0 * impacts[0].energy_before / inertia), before, before);
      spin(std::sqrt(2.0 * impacts[0].energy_after / inertia), std::abs(of(row, "omega_after_impact")), before);
      spin(std::sqrt(impacts[0].energy_after / impacts[0].energy_before), of(at, "omega_ratio"));
      // It leaves the corner it stood on, and turns about the other to the next amplitude.
      EXPECT_EQ(events_of(simulation, EventKind::lift_off).size(), 1u) << row;
      EXPECT_EQ(events_of(simulation, EventKind::closing).size(), 2u) << row;
      double highest = 0.0, last = simulation.state().angle(block);
      const double p2 = of(at, "p") * of(at, "p"), alpha = of(at, "alpha");
      for (int i = 0; i < 40 && simulation.state().spin(block) != 0.0; ++i) {
        const double now = simulation.time(), w = simulation.state().spin(block);
        last = simulation.state().angle(block);
        if (w < 0.0) break;
        // Towards the turning point: Newton's method on w = 0, by stepping there.
        const double rate = -p2 * std::sin(alpha - last);
        const double step = std::min(-w / rate, 0.05);
        if (step < 1e-9) break;
        simulation.run_until(now + step);
      }
      highest = simulation.state().angle(block);
      amplitude(highest, of(row, "next_amplitude_exact"), of(row, "next_amplitude_exact"));
      EXPECT_TRUE(ledger.closes()) << row;
      ++rows;
    }
  }
  EXPECT_EQ(rows, 8);
  EXPECT_LE(time.value(), 1e-10);
  EXPECT_LE(spin.value(), 1e-10);
  EXPECT_LE(amplitude.value(), 1e-10);
  note("times", time.value());
  note("spins", spin.value());
  note("amplitudes", amplitude.value());
}

}  // namespace
