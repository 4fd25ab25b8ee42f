// Contacts that belts and drums drive, and resistance to rolling: event-driven, against closed forms.

#include "tests/reference/reference_data.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::Json;
using carom_test::reference_data;

Json problems(const char* name) { return reference_data("driven_contacts.json").at(name); }
double of(const Json& data, const char* key) { return data.at(key).get<double>(); }

System under_gravity() {
  System system;
  system.add(Gravity{{0.0, -of(reference_data("driven_contacts.json"), "gravity")}});
  return system;
}

std::vector<double> times_of(const Simulation& simulation, EventKind kind, double after) {
  std::vector<double> times;
  for (const EventRecord& event : simulation.events()) {
    if (event.kind == kind && event.time > after) times.push_back(event.time);
  }
  return times;
}

TEST(DrivenContacts, MassOnABeltSticksAndSlips) {
  for (const Json& at : problems("belts")) {
    System system = under_gravity();
    system.add(HalfPlane{.normal = {0.0, 1.0}, .surface_speed = of(at, "speed")},
               Surface{.friction = of(at, "friction"),
                       .normal_restitution = 0.0,
                       .static_friction = of(at, "static_friction")});
    const BodyId mass = system.add(Particle{.mass = of(at, "mass"), .velocity = {of(at, "speed"), 0.0}});
    constexpr double length = 10.0;
    system.add(SpringDamper{.from = {ground, {-length, 0.0}},
                            .to = mass,
                            .stiffness = of(at, "stiffness"),
                            .free_length = length});
    const auto slips = at["slips"].get<std::vector<double>>(),
               sticks = at["sticks"].get<std::vector<double>>();
    Simulation simulation(system, EventDriven{});
    simulation.run_until(slips.back() + 1e-3);
    const std::vector<double> slipped = times_of(simulation, EventKind::slip, 0.0);
    const std::vector<double> stuck = times_of(simulation, EventKind::stick, slips.front());
    ASSERT_EQ(slipped.size(), slips.size());
    ASSERT_EQ(stuck.size(), sticks.size());
    // Three periods of steps with the tolerance 1e-9.
    for (std::size_t i = 0; i < slips.size(); ++i) EXPECT_NEAR(slipped[i], slips[i], 3e-9) << i;
    for (std::size_t i = 0; i < sticks.size(); ++i) EXPECT_NEAR(stuck[i], sticks[i], 3e-9) << i;
  }
}

TEST(DrivenContacts, DiscRollsToRest) {
  for (const Json& at : problems("rolls")) {
    const double r = of(at, "radius");
    System system = under_gravity();
    system.add(
        HalfPlane{.normal = {0.0, 1.0}},
        Surface{.friction = 0.5, .normal_restitution = 0.5, .rolling_resistance = of(at, "resistance")});
    const BodyId body = system.add(RigidBody{.mass = disc(2.0, r),
                                             .position = {0.0, r},
                                             .velocity = {of(at, "speed"), 0.0},
                                             .spin = -of(at, "speed") / r});
    system.add(Disc{.body = body, .radius = r});
    Simulation simulation(system, EventDriven{});
    simulation.run_until(of(at, "time") + 1.0);
    // Under constant loads steps are exact but for rounding.
    EXPECT_NEAR(simulation.state().position(body)[0], of(at, "distance"), 1e-12);
    EXPECT_NEAR(simulation.state().angle(body), -of(at, "distance") / r, 1e-11);
    const std::vector<double> held = times_of(simulation, EventKind::hold, 0.0);
    ASSERT_EQ(held.size(), 1U);
    EXPECT_NEAR(held.front(), of(at, "time"), 1e-12);
  }
}

TEST(DrivenContacts, BodiesStandInADrumThatTurns) {
  constexpr double end = 2.0, mass = 2.0;
  for (const Json& at : problems("drums")) {
    const double radius = of(at, "radius"), r = of(at, "disc_radius");
    const auto place = [](double distance, double angle) -> Vec<2> {
      return {distance * std::sin(angle), -distance * std::cos(angle)};
    };
    System sliding = under_gravity();
    sliding.add(drum({0.0, 0.0}, radius, of(at, "spin")),
                Surface{.friction = of(at, "friction"), .normal_restitution = 0.0});
    const BodyId grain =
        sliding.add(Particle{.mass = mass, .position = place(radius, of(at, "slide_angle"))}, "grain");
    Simulation slides(sliding, EventDriven{});
    slides.run_until(end);
    // Equilibria: what is left is rounding, which neither grows nor decays.
    EXPECT_NEAR((Vec<2>(slides.state().position(grain)) - place(radius, of(at, "slide_angle"))).norm(), 0.0,
                1e-12);
    EXPECT_NEAR(slides.energy().flow(EnergyFlow::external), mass * of(at, "slide_power") * end, 1e-10);
    EXPECT_NEAR(slides.energy().flow(EnergyFlow::sliding), mass * of(at, "slide_power") * end, 1e-10);

    System rolling = under_gravity();
    rolling.add(drum({0.0, 0.0}, radius, of(at, "spin")),
                Surface{.friction = of(at, "friction"),
                        .normal_restitution = 0.0,
                        .rolling_resistance = of(at, "resistance")});
    const BodyId roller = rolling.add(RigidBody{.mass = disc(mass, r),
                                                .position = place(radius - r, of(at, "roll_angle")),
                                                .spin = of(at, "roll_spin")});
    rolling.add(Disc{.body = roller, .radius = r});
    Simulation rolls(rolling, EventDriven{});
    rolls.run_until(end);
    EXPECT_NEAR((Vec<2>(rolls.state().position(roller)) - place(radius - r, of(at, "roll_angle"))).norm(),
                0.0, 1e-11);
    EXPECT_NEAR(rolls.state().spin(roller), of(at, "roll_spin"), 1e-10);
    EXPECT_NEAR(rolls.energy().flow(EnergyFlow::external), mass * of(at, "roll_power") * end, 1e-9);
    EXPECT_NEAR(rolls.energy().flow(EnergyFlow::rolling), mass * of(at, "roll_power") * end, 1e-9);
  }
}

}  // namespace
