// Problems of the kinds of contacts_planar.json with other masses, shapes, laws and numbers, in both modes:
// cradles, discs in a trough, stacked blocks, rocking blocks, shaken columns, oblique impacts.

#include "tests/integrators/event_run.h"
#include "tests/reference/reference_data.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::events_of;
using carom_test::Json;
using carom_test::reference_data;
using carom_test::tight;

constexpr double g = 9.81;
// Impulses and velocities are of order 10, from masses of 0.1 kg on: round-off, 1e3 epsilon of the largest.
constexpr double rounding = 1e-12;

Json problems(const char* name) { return reference_data("contacts_variants.json").at(name); }
double of(const Json& data, const char* key) { return data.at(key).get<double>(); }
std::vector<double> list(const Json& data) { return data.get<std::vector<double>>(); }
Vec<2> vec(const Json& data) { return {data.at(0).get<double>(), data.at(1).get<double>()}; }

BodyId add_disc(System& system, const MassProperties<2>& mass, double radius, const Vec<2>& place,
                const Vec<2>& velocity = {0, 0}, double spin = 0.0, MaterialId material = {}) {
  const BodyId body =
      system.add(RigidBody{.mass = mass, .position = place, .velocity = velocity, .spin = spin});
  system.add(Disc{.body = body, .radius = radius, .material = material});
  return body;
}

// ---------------------------------------------------------------------------------------------- cradles

/// Discs in a line, each pair of neighbours with a coefficient of its own.
/// \param apart of the moving ones from the others at the start [m]
System cradle(const Json& at, ImpactLaw law, double apart) {
  System system;
  const std::vector<double> masses = list(at["masses"]), e = list(at["restitution"]), v = list(at["speeds"]);
  std::vector<MaterialId> materials;
  for (std::size_t i = 0; i < masses.size(); ++i)
    materials.push_back(system.material("material " + std::to_string(i)));
  for (std::size_t i = 0; i < e.size(); ++i) {
    system.between(materials[i], materials[i + 1],
                   {.friction = 0.0, .normal_restitution = e[i], .impact_law = law});
  }
  for (std::size_t i = 0; i < masses.size(); ++i) {
    const double x = 0.25 * static_cast<double>(i) - apart * v[i];
    add_disc(system, disc(masses[i], 0.125), 0.125, {x, 0.0}, {v[i], 0.0}, 0.0, materials[i]);
  }
  return system;
}

void expect_speeds(const Simulation& simulation, const Json& expected, const std::string& what) {
  std::size_t i = 0;
  for (const BodyId body : simulation.system().bodies()) {
    EXPECT_NEAR(simulation.state().velocity(body)[0], expected.at(i++).get<double>(), 10.0 * rounding)
        << what << ", disc " << i - 1;
  }
  EXPECT_LE(std::abs(simulation.energy().residual()), 1e-13) << what;
}

TEST(ContactsVariants, CradlesOfUnequalDiscs) {
  int sequences = 0;
  for (const Json& at : problems("cradles")) {
    const auto check = [&](ImpactLaw law, ImpactOrder order, const Json& expected) {
      const std::string what = at.dump() + " " + std::string(to_string(law));
      EventDriven events = tight();
      events.impact_rules.order = order;
      Simulation simulation(cradle(at, law, 0.1), events);
      simulation.run_until(0.1 + 1e-9);
      expect_speeds(simulation, expected, what + ", events");
      TimeStepping steps{.step = 1e-9};
      steps.impact_rules.order = order;
      Simulation stepping(cradle(at, law, 0.0), steps);
      stepping.step();
      expect_speeds(stepping, expected, what + ", steps");
    };
    check(ImpactLaw::newton, ImpactOrder::simultaneous, at["newton"]["speeds"]);
    check(ImpactLaw::poisson, ImpactOrder::simultaneous, at["poisson"]["speeds"]);
    if (!at.contains("sequential")) continue;
    ++sequences;
    check(ImpactLaw::newton, ImpactOrder::sequential, at["sequential"]["speeds"]);
    check(ImpactLaw::energetic, ImpactOrder::sequential, at["sequential"]["speeds"]);
  }
  EXPECT_GE(sequences, 4);
}

// --------------------------------------------------------------------------------------- forces at rest

TEST(ContactsVariants, TwoSmoothDiscsInATrough) {
  constexpr double step = 1e-5;
  for (const Json& at : problems("troughs")) {
    System system;
    system.set_default_law({.friction = 0.0, .normal_restitution = 0.0});
    system.add(Gravity{{0.0, -g}});
    const std::vector<double> slopes = list(at["slopes"]), radii = list(at["radii"]), m = list(at["masses"]);
    const ObstacleId walls[2] = {
        system.add(HalfPlane{.normal = {std::sin(slopes[0]), std::cos(slopes[0])}}),
        system.add(HalfPlane{.normal = {-std::sin(slopes[1]), std::cos(slopes[1])}})};
    for (std::size_t i = 0; i < 2; ++i) {
      // Larger by a hair: a gap of rounding would be a fall of a step, and a place that is not the described.
      add_disc(system, disc(m[i], radii[i]), radii[i] * (1.0 + 2e-14), vec(at["centres"][i]));
    }
    Simulation simulation(system, TimeStepping{.step = step});
    for (int i = 0; i < 20; ++i) simulation.step();
    int pairs = 0;
    for (const ContactRecord& contact : simulation.report().contacts) {
      if (!contact.other.valid()) continue;
      ++pairs;
      // The equilibrium is unstable, and found to 1e-16 m of 0.1 m.
      EXPECT_NEAR(contact.impulse[0] / step, of(at, "between"), 1e-9);
    }
    EXPECT_EQ(pairs, 1);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_NEAR(force_on(simulation.report(), walls[i]).mean_force.norm(),
                  at["wall_forces"][i].get<double>(), 1e-9);
    }
    // From event to event nothing moves: the forces balance.
    Simulation resting(system, tight());
    resting.run_until(1e-3);
    for (const double v : resting.state().v) EXPECT_NEAR(v, 0.0, 1e-11);
  }
}

TEST(ContactsVariants, BlocksSetAsideCarryTheirWeightsByLevers) {
  const Json at = problems("offset_stack");
  const std::vector<double> widths = list(at["half_widths"]), heights = list(at["heights"]),
                            masses = list(at["masses"]), centres = list(at["centres"]);
  System system;
  system.set_default_law({.friction = 0.4, .normal_restitution = 0.0});
  system.add(Gravity{{0.0, -g}});
  system.add(HalfPlane{.normal = {0.0, 1.0}});
  double y = 0.0;
  std::vector<double> levels;
  for (std::size_t i = 0; i < masses.size(); ++i) {
    levels.push_back(y);
    const BodyId body = system.add(RigidBody{.mass = box(masses[i], 2.0 * widths[i], 2.0 * heights[i]),
                                             .position = {centres[i], y + heights[i]}});
    const double w = widths[i], h = heights[i];
    system.add(Polygon{.body = body, .vertices = {{-w, -h}, {w, -h}, {w, h}, {-w, h}}});
    y += 2.0 * h;
  }
  constexpr double step = 1e-3;
  Simulation simulation(system, TimeStepping{.step = step});
  for (int i = 0; i < 100; ++i) simulation.step();
  int found = 0;
  for (const ContactRecord& contact : simulation.report().contacts) {
    for (std::size_t i = 0; i < levels.size(); ++i) {
      if (std::abs(contact.point[1] - levels[i]) > 1e-6) continue;
      const Json& points = at["levels"][i]["points"];
      const std::size_t k = std::abs(contact.point[0] - points[0].get<double>()) < 1e-6 ? 0 : 1;
      EXPECT_NEAR(contact.point[0], points[k].get<double>(), 1e-9);
      // Round-off of forces up to 98 N over levers of at least 0.6 m.
      EXPECT_NEAR(contact.impulse[0] / step, at["levels"][i]["forces"][k].get<double>(), 1e-9) << i;
      ++found;
    }
  }
  EXPECT_EQ(found, 8);
  Simulation resting(system, tight());
  resting.run_until(10.0);
  for (const double v : resting.state().v) EXPECT_EQ(v, 0.0);
}

// --------------------------------------------------------------------------------------- rocking blocks

System rocking_block(const Json& at) {
  const double b = of(at, "half_width"), h = of(at, "half_height"), tilt = of(at, "tilt"),
               slope = of(at, "slope");
  System system;
  system.add(Gravity{{g * std::sin(slope), -g * std::cos(slope)}});  // seen from the floor
  system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 2.0, .normal_restitution = 0.0});
  const Vec<2> arm(tilt > 0.0 ? b : -b, h);
  const Vec<2> place(std::cos(tilt) * arm[0] - std::sin(tilt) * arm[1],
                     std::sin(tilt) * arm[0] + std::cos(tilt) * arm[1]);
  const BodyId body =
      system.add(RigidBody{.mass = box(3.0, 2.0 * b, 2.0 * h), .position = place, .angle = tilt}, "block");
  system.add(Polygon{.body = body, .vertices = {{-b, -h}, {b, -h}, {b, h}, {-b, h}}});
  return system;
}

TEST(ContactsVariants, RockingBlocksOverManyImpacts) {
  for (const Json& at : problems("rocking_blocks")) {
    const Json& expected = at["impacts_time_spin_before_after"];
    const double end = expected.back()[0].get<double>();
    Simulation simulation(rocking_block(at), tight());
    simulation.run_until(end + 1e-3);
    std::vector<EventRecord> impacts;
    for (const EventRecord& event : events_of(simulation, EventKind::impact)) {
      if (event.impulse[0] > 0.0) impacts.push_back(event);
    }
    ASSERT_EQ(impacts.size(), expected.size()) << at;
    for (std::size_t i = 0; i < impacts.size(); ++i) {
      // The tilt is unstable: an error grows by e^(p t) in a swing of up to 1 s, p = 3.
      EXPECT_NEAR(impacts[i].time, expected[i][0].get<double>(), 1e-9) << at << i;
      EXPECT_NEAR(impacts[i].motions[0].velocity_before[2], expected[i][1].get<double>(), 1e-9) << i;
      EXPECT_NEAR(impacts[i].motions[0].velocity_after[2], expected[i][2].get<double>(), 1e-9) << i;
    }
    // Steps, behind the third impact: of first order, at every length within that of the others.
    const double time = 0.5 * (expected[2][0].get<double>() + expected[3][0].get<double>());
    Simulation exact(rocking_block(at), tight());
    exact.run_until(time);
    const auto tilt = [](const Simulation& of) { return of.state().angle(of.system().body("block")); };
    const auto error = [&](double step) {
      double sum = 0.0;
      for (const double part : {1.0, 0.97, 0.93, 0.89}) {
        Simulation stepping(rocking_block(at), TimeStepping{.step = step * part});
        stepping.run_until(time);
        sum += std::abs(tilt(stepping) - tilt(exact)) / 4.0;
      }
      return sum;
    };
    const double coarse = error(1e-3), fine = error(1e-4);
    EXPECT_LT(coarse, 0.03) << at;
    EXPECT_LT(fine, 0.3 * coarse) << at;
  }
}

// --------------------------------------------------------------------------------------- shaken columns

System column(const Json& at) {
  System system;
  const MaterialId table = system.material("table"), ball = system.material("ball");
  system.between(table, ball, {.friction = 0.0, .normal_restitution = of(at, "e_table")});
  system.between(ball, ball, {.friction = 0.0, .normal_restitution = of(at, "e_balls")});
  system.add(Gravity{{0.0, -g}});
  const double w = of(at, "w"), a = of(at, "gamma") * g / (w * w);
  system.add(HalfPlane{
      .normal = {0.0, 1.0},
      .material = table,
      .motion = {.displacement = [=](double t) { return Vec<2>(0.0, a * std::sin(w * t)); },
                 .velocity = [=](double t) { return Vec<2>(0.0, a * w * std::cos(w * t)); },
                 .acceleration = [=](double t) { return Vec<2>(0.0, -a * w * w * std::sin(w * t)); }}});
  const double radius = of(at, "radius");
  const std::vector<double> m = list(at["masses"]), y = list(at["clearances"]), v = list(at["speeds"]);
  for (std::size_t i = 0; i < m.size(); ++i) {
    add_disc(system, disc(m[i], radius), radius, {0.0, y[i] + radius * (2.0 * static_cast<double>(i) + 1.0)},
             {0.0, v[i]}, 0.0, ball);
  }
  return system;
}

TEST(ContactsVariants, ColumnsOfBallsOnAShakenTable) {
  for (const Json& at : problems("shaken_columns")) {
    const Json& expected = at["impacts_time_lower_approach_speeds"];
    const std::size_t balls = at["masses"].size();
    EventDriven events = tight();
    events.longest_step = 0.01;
    Simulation simulation(column(at), events);
    const double end = expected.back()[0].get<double>();
    simulation.run_until(end + 1e-5);
    const auto impacts = events_of(simulation, EventKind::impact);
    ASSERT_EQ(impacts.size(), expected.size()) << at;
    for (std::size_t i = 0; i < impacts.size(); ++i) {
      // Errors of 1e-12 of the search for meetings, magnified by up to 1e2 in the impacts before.
      EXPECT_NEAR(impacts[i].time, expected[i][0].get<double>(), 1e-10) << i;
      EXPECT_EQ(impacts[i].other.valid(), expected[i][1].get<int>() > 0) << i;
      EXPECT_NEAR(impacts[i].velocity_before[0], expected[i][2].get<double>(), 1e-9) << i;
    }
    // Located steps follow flights and impacts exactly, whatever their length.
    for (const double step : {3e-3, 7e-4}) {
      Simulation located(column(at),
                         TimeStepping{.step = step, .capture_speed = 1e-3, .impacts = ImpactTimes::located});
      located.run_until(end + 1e-5);
      std::size_t i = 0;
      for (const BodyId body : located.system().bodies()) {
        EXPECT_NEAR(located.state().velocity(body)[1], expected.back()[3 + i].get<double>() - g * 1e-5, 1e-9)
            << at << ", step " << step << ", ball " << i;
        ++i;
      }
      EXPECT_EQ(i, balls);
    }
  }
}

// -------------------------------------------------------------------------------------- oblique impacts

/// Expects the velocities of the first two bodies.
void expect_motion(const Simulation& simulation, const Json& velocity, const Json& spin,
                   const std::string& what) {
  std::size_t i = 0;
  for (const BodyId body : simulation.system().bodies()) {
    EXPECT_LE((Vec<2>(simulation.state().velocity(body)) - vec(velocity.at(i))).norm(), rounding)
        << what << i;
    // Spins of balls of 0.05 m are twenty times as large as velocities.
    EXPECT_NEAR(simulation.state().spin(body), spin.at(i).get<double>(), 50.0 * rounding) << what << i;
    ++i;
  }
}

template <class Expect>
void run_both(const System& system, const Expect& expect) {
  Simulation simulation(system, tight());
  simulation.run_until(1e-9);
  expect(simulation, "events");
  Simulation stepping(system, TimeStepping{.step = 1e-9});
  stepping.step();
  expect(stepping, "steps");
}

TEST(ContactsVariants, CornersThatStrikeFreeBodiesByThreeLaws) {
  int laws = 0;
  for (const Json& at : problems("corner_impacts")) {
    for (const ImpactLaw law : {ImpactLaw::newton, ImpactLaw::poisson, ImpactLaw::energetic}) {
      const std::string name{to_string(law)};
      if (!at.contains(name)) continue;
      ++laws;
      System system;
      system.set_default_law({.friction = of(at, "friction"),
                              .normal_restitution = of(at, "e_n"),
                              .tangential_restitution = of(at, "e_t"),
                              .impact_law = law});
      std::array<BodyId, 2> bodies;
      for (std::size_t i = 0; i < 2; ++i) {
        // The place of the impact is the origin, but for a hair, which is an overlap after any rounding.
        const Vec<2> lever = vec(at["lever"][i]);
        bodies[i] = system.add(RigidBody{
            .mass = {.mass = at["mass"][i].get<double>(), .inertia = at["inertia"][i].get<double>()},
            .position = -lever - Vec<2>(0.0, i == 0 ? 1e-15 : 0.0),
            .velocity = vec(at["velocity"][i]),
            .spin = at["spin"][i].get<double>()});
        if (i == 0) {
          system.add(Point{.body = bodies[i], .position = lever});
        } else {
          const double y = lever[1];
          system.add(Polygon{.body = bodies[i], .vertices = {{-0.9, -y}, {0.9, -y}, {0.9, y}, {-0.9, y}}});
        }
      }
      run_both(system, [&](const Simulation& simulation, const char* mode) {
        expect_motion(simulation, at[name]["velocity"], at[name]["spin"], at.dump() + name + mode);
      });
    }
  }
  EXPECT_EQ(laws, 11);
}

TEST(ContactsVariants, UnequalBallsWithFrictionAndResistanceToRolling) {
  for (const Json& at : problems("ball_impacts")) {
    System system;
    system.set_default_law({.friction = of(at, "friction"),
                            .normal_restitution = of(at, "e_n"),
                            .tangential_restitution = of(at, "e_t"),
                            .rolling_resistance = of(at, "rolling_resistance"),
                            .rolling_restitution = of(at, "e_r")});
    const std::vector<double> radii = list(at["radius"]), m = list(at["mass"]), inertia = list(at["inertia"]);
    for (std::size_t i = 0; i < 2; ++i) {
      add_disc(system, {.mass = m[i], .inertia = inertia[i]}, radii[i],
               {0.0, i == 0 ? radii[0] + radii[1] - 1e-17 : 0.0}, vec(at["velocity"][i]),
               at["spin"][i].get<double>());
    }
    run_both(system, [&](const Simulation& simulation, const char* mode) {
      expect_motion(simulation, at["velocity_after"], at["spin_after"], at.dump() + mode);
    });
  }
}

}  // namespace
