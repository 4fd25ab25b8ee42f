// Painleve's rod in event-driven mode: every state of the reference with its modes, the names and quantities
// of those without answer or with several, and the velocities behind an impact without collision.

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
  static Simulation make(double theta, double mu, double omega, double tip_speed) {
    return {
        scenes::painleve_rod({.theta = theta, .friction = mu, .omega = omega, .tip_speed = tip_speed}).system,
        tight()};
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
                1e-4 * force * short_time)
        << at;
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
    EXPECT_EQ(
        run.simulation.statistics().events[static_cast<std::size_t>(EventKind::impact_without_collision)], 1);
    // Velocities behind it are those of the impulse; the tip sticks or goes on as forces say, without speed.
    const State& state = run.simulation.state();
    const double force = 10.0 * g;  // more than the forces there
    EXPECT_NEAR(state.velocity(run.body())[0], -1.0 + law[1].get<double>(), force * short_time) << at;
    EXPECT_NEAR(state.velocity(run.body())[1], law[2].get<double>(), force * short_time) << at;
    EXPECT_TRUE(ledger.closes()) << at;
    // Lost by the impact, which has a line of its own.
    const EnergyLedger& energy = run.simulation.energy();
    EXPECT_NEAR(energy.flow(EnergyFlow::impact_without_collision), 0.5 * law[1].get<double>(), 1e-12);
    EXPECT_EQ(energy.flow(EnergyFlow::impact_normal), 0.0);
    EXPECT_EQ(energy.flow(EnergyFlow::impact_tangential), 0.0);
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

TEST(EventPainleve, OfSeveralAnswersThePresentModeIsKept) {
  // Pressed on, the rod of the reference slides at little friction as it must; then the press goes and the
  // friction comes: to slide on and to lift off are both possible.
  for (const Json& at : states("several")) {
    const double theta = of(at, "theta"), omega = of(at, "omega");
    const Vec<2> lever(std::cos(theta), std::sin(theta));
    System system;
    const MaterialId wood = system.material("wood"), stone = system.material("stone");
    system.add(Gravity{{0.0, -g}});
    system.add(HalfPlane{.normal = {0.0, 1.0}, .material = stone});
    system.between(wood, stone, {.friction = 0.1, .normal_restitution = 0.0});
    const BodyId rod =
        system.add(RigidBody{.mass = planar::rod(1.0, 2.0),
                             .position = lever,
                             .angle = theta,
                             .velocity = Vec<2>(-1.0, 0.0) + omega * Vec<2>(-lever[1], lever[0]),
                             .spin = omega});
    system.add(Point{.body = rod, .position = {-1.0, 0.0}, .material = wood});
    const ElementId press =
        system.add(AppliedForce{.on = rod, .force = [](double) { return Vec<2>(0.0, -100.0); }});
    Simulation simulation(std::move(system), tight());
    const LedgerWatch ledger(simulation);
    simulation.run_until(short_time);
    ASSERT_EQ(simulation.events().size(), 1u);
    ASSERT_EQ(simulation.events()[0].mode, ContactMode::slip_negative);
    simulation.edit([&](System& now) {
      now.remove(press);
      now.between(wood, stone, {.friction = of(at, "mu"), .normal_restitution = 0.0});
    });
    simulation.clear_events();
    const State start = simulation.state();
    const double before = start.velocity(rod)[1];
    simulation.run_until(2.0 * short_time);
    ASSERT_EQ(simulation.events().size(), 1u) << at;
    const EventRecord& event = simulation.events()[0];
    EXPECT_EQ(event.kind, EventKind::several_accelerations) << at;
    EXPECT_EQ(event.mode, ContactMode::slip_negative) << at;
    // The state is a millionth of a second further than that of the reference.
    EXPECT_NEAR(event.stiffness, of(at, "p"), 1e-4) << at;
    EXPECT_NEAR(event.free_acceleration, of(at, "b"), 1e-3) << at;
    // It slides on under the force of that answer, -b/p.
    const double force = at.at("force_level_solutions")[1].at("lambda_n").get<double>();
    EXPECT_NEAR(simulation.state().velocity(rod)[1] - before, (force - g) * short_time,
                1e-3 * force * short_time)
        << at;
    EXPECT_TRUE(ledger.closes()) << at;
    // A state that is set has no present mode: it lifts off, as at any start.
    simulation.set_state(start);
    simulation.clear_events();
    simulation.run_until(2.0 * short_time);
    ASSERT_EQ(simulation.events().size(), 1u) << at;
    EXPECT_EQ(simulation.events()[0].kind, EventKind::several_accelerations) << at;
    EXPECT_EQ(simulation.events()[0].mode, ContactMode::open) << at;
  }
}

// Friction that grows as the sliding slows takes the stiffness to zero while the rod slides: the force on the
// tip grows without bound within a millionth of a second, and the impact without collision ends the sliding.
TEST(EventPainleve, ForceThatGrowsWithoutBoundEndsInAnImpactWithoutCollision) {
  constexpr double kinetic = 1.0, fixed = 2.0;
  const double theta = std::atan(2.0);
  const Vec<2> lever(std::cos(theta), std::sin(theta));
  for (const FlowMethod method :
       {FlowMethod::explicit_runge_kutta, FlowMethod::one_step, FlowMethod::adams, FlowMethod::bdf}) {
    for (const double tangential_restitution : {0.0, 0.5}) {
      for (const double curve : {0.2, 0.5}) {
        SCOPED_TRACE(testing::Message()
                     << static_cast<int>(method) << ", " << tangential_restitution << ", " << curve);
        System system;
        system.add(Gravity{{0.0, -g}});
        system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = kinetic,
                                                            .normal_restitution = 0.0,
                                                            .tangential_restitution = tangential_restitution,
                                                            .static_friction = fixed,
                                                            .stribeck_speed = curve});
        const BodyId rod = system.add(RigidBody{
            .mass = planar::rod(1.0, 2.0), .position = lever, .angle = theta, .velocity = {-1.0, 0.0}});
        system.add(Point{.body = rod, .position = {-1.0, 0.0}});
        Simulation simulation(std::move(system), tight(method));
        const LedgerWatch ledger(simulation);
        simulation.run_until(0.05);
        const auto impacts = events_of(simulation, EventKind::impact_without_collision);
        ASSERT_EQ(impacts.size(), 1u);
        const EventRecord& impact = impacts[0];
        // p = 0, seen from behind. Steps end at 1e-16 s: p falls like the root of the time left, at rates of
        // some 1e2 1/(kg s)^(1/2).
        EXPECT_LT(impact.stiffness, 0.0);
        EXPECT_GT(impact.stiffness, -1e-5);
        EXPECT_LT(impact.free_acceleration, -1.0);
        // At the inclination then, 1 + 3 cos (cos - mu sin) = 0; hence mu, and by the curve the speed.
        // Gravity alone turns the rod by less than 1e-3 rad until then, and mu by some thousandths.
        const double critical = (1.0 + 3.0 * lever[0] * lever[0]) / (3.0 * lever[0] * lever[1]);
        EXPECT_NEAR(impact.velocity_before[1], curve * std::log((critical - kinetic) / (fixed - kinetic)),
                    1e-3);
        EXPECT_NEAR(impact.velocity_before[0], 0.0, 1e-11);
        EXPECT_NEAR(impact.velocity_after[0], 0.0, 1e-11);
        EXPECT_NEAR(impact.velocity_after[1], -tangential_restitution * impact.velocity_before[1], 1e-9);
        // Along the edge of the cone, where p is zero: P_t = W_nn/|W_nt| P_n.
        EXPECT_NEAR(impact.impulse[1], critical * impact.impulse[0], 5e-3 * impact.impulse[1]);
        EXPECT_GT(simulation.energy().flow(EnergyFlow::impact_without_collision), 0.0);
        EXPECT_TRUE(ledger.closes());
      }
    }
  }
}

TEST(EventPainleve, CriticalFrictionSeparatesTheStates) {
  // At theta with tan = 2 the stiffness 1 + 3 cos (cos - mu sin) vanishes for mu = 4/3.
  const double theta = std::atan(2.0);
  for (const double off : {-1e-3, 1e-3}) {
    Rod run(theta, of(reference_data("contacts_planar.json").at("painleve_rod"), "critical_mu") + off, 0.0,
            -1.0);
    run.simulation.run_until(1e-9);
    const bool stuck = !events_of(run.simulation, EventKind::impact_without_collision).empty();
    EXPECT_EQ(stuck, off > 0.0) << off;
  }
}

}  // namespace
