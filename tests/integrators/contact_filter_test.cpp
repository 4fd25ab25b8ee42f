// Filters of contacts in motion, in both modes.

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

constexpr double g = 9.81, low = 0.0, high = 0.5, length = 2.0;
constexpr ContactFilter first{.groups = 1, .touches = 1}, second{.groups = 2, .touches = 2};

/// A bar whose left end touches the low floor only and whose right end the high one only.
struct Steps {
  Steps(double height, double angle, double friction) {
    const Surface rough{.friction = friction, .normal_restitution = 0.0};
    system.add(Gravity{{0.0, -g}});
    system.add(HalfPlane{.point = {0.0, low}, .normal = {0.0, 1.0}, .filter = first}, rough, "low");
    system.add(HalfPlane{.point = {0.0, high}, .normal = {0.0, 1.0}, .filter = second}, rough, "high");
    bar = system.add(RigidBody{.mass = rod(1.0, length), .position = {0.0, height}, .angle = angle}, "bar");
    system.add(Point{.body = bar, .position = {-0.5 * length, 0.0}, .filter = first}, "left");
    right = system.add(Point{.body = bar, .position = {0.5 * length, 0.0}, .filter = second}, "right");
  }

  System system;
  BodyId bar;
  ShapeId right;
};

/// Heights of the ends.
std::vector<double> heights(const Simulation& simulation, BodyId bar) {
  const double y = simulation.state().position(bar)[1],
               rise = 0.5 * length * std::sin(simulation.state().angle(bar));
  return {y - rise, y + rise};
}

TEST(ContactFilters, ABarRestsOnFloorsOfDifferentHeights) {
  const double angle = std::asin((high - low) / length), height = 0.5 * (high + low);
  const Steps steps(height, angle, 0.0);
  EXPECT_TRUE(steps.system.check().empty());
  Simulation stepping(steps.system, TimeStepping{.step = 1e-3});
  for (int i = 0; i < 100; ++i) {
    const StepReport& report = stepping.step();
    ASSERT_EQ(report.contacts.size(), 2U);
    // Half of the weight on each end, where friction does not hold them apart.
    for (const ContactRecord& contact : report.contacts)
      EXPECT_NEAR(contact.impulse[0], 0.5 * g * 1e-3, 1e-12);
  }
  Simulation events(steps.system, EventDriven{});
  events.run_until(0.1);
  for (const Simulation* simulation : {&stepping, &events}) {
    EXPECT_NEAR(heights(*simulation, steps.bar)[0], low, 1e-12);
    EXPECT_NEAR(heights(*simulation, steps.bar)[1], high, 1e-12);
    EXPECT_NEAR(simulation->state().position(steps.bar)[0], 0.0, 1e-12);
  }
}

TEST(ContactFilters, EachEndFallsToItsOwnFloor) {
  constexpr double start = 1.0;
  const Steps steps(start, 0.0, 0.8);
  Simulation events(steps.system, EventDriven{});
  events.run_until(2.0);
  const EventRecord& hit = events.events().front();
  EXPECT_EQ(hit.kind, EventKind::impact);
  EXPECT_EQ(events.name(hit), "point 'right' (feature 0) of rigid body 'bar' on half-plane 'high'");
  EXPECT_NEAR(hit.time, std::sqrt(2.0 * (start - high) / g), 1e-9);
  for (const EventRecord& event : events.events()) {
    const std::string name = events.name(event);
    EXPECT_NE(name.find("left") == std::string::npos, name.find("low") != std::string::npos) << name;
  }
  Simulation stepping(steps.system, TimeStepping{.step = 1e-3, .project_gaps = true});
  stepping.run_until(2.0);
  for (const Simulation* simulation : {&events, &stepping}) {
    EXPECT_NEAR(heights(*simulation, steps.bar)[0], low, 1e-8);
    EXPECT_NEAR(heights(*simulation, steps.bar)[1], high, 1e-8);
  }
}

TEST(ContactFilters, AnEditMayChangeThem) {
  const double angle = std::asin((high - low) / length), height = 0.5 * (high + low);
  Steps steps(height, angle, 0.8);
  const auto lower = [&](System& system) {
    system.remove(steps.right);
    system.add(Point{.body = steps.bar, .position = {0.5 * length, 0.0}, .filter = first});
  };
  Simulation stepping(steps.system, TimeStepping{.step = 1e-3, .project_gaps = true});
  Simulation events(steps.system, EventDriven{});
  for (Simulation* simulation : {&stepping, &events}) {
    simulation->run_until(0.1);
    EXPECT_NEAR(heights(*simulation, steps.bar)[1], high, 1e-12);
    const std::uint64_t print = simulation->system().fingerprint();
    simulation->edit(lower);
    EXPECT_NE(simulation->system().fingerprint(), print);
    simulation->run_until(2.0);
    EXPECT_NEAR(heights(*simulation, steps.bar)[0], low, 1e-8);
    EXPECT_NEAR(heights(*simulation, steps.bar)[1], low, 1e-8);
    ASSERT_EQ(simulation->report().findings.size(), 1U);  // the high floor
    EXPECT_EQ(simulation->report().findings[0].kind, FindingKind::hidden_by_filter);
  }
}

/// Discs and particles that fall to the floor of their own parity. \param parity -1: of both, else of one
System rain(int parity, std::vector<BodyId>& bodies) {
  System system;
  system.add(Gravity{{0.0, -g}});
  for (int floor = 0; floor < 2; ++floor) {
    const ContactFilter filter = floor == 0 ? first : second;
    system.add(HalfPlane{.point = {0.0, -0.5 * floor}, .normal = {0.1, 1.0}, .filter = filter},
               Surface{.friction = 0.3, .normal_restitution = 0.5});
  }
  for (int i = 0; i < 200; ++i) {
    if (parity >= 0 && i % 2 != parity) continue;
    const ContactFilter filter = i % 2 == 0 ? first : second;
    const Vec<2> place(0.1 * i, 0.3 + 0.002 * i);
    if (i >= 100) {
      bodies.push_back(system.add(Particle{.mass = 1.0, .position = place, .filter = filter}));
      continue;
    }
    bodies.push_back(system.add(RigidBody{.mass = disc(1.0, 0.05), .position = place, .spin = 1.0}));
    system.add(Disc{.body = bodies.back(), .radius = 0.05, .filter = filter});
  }
  return system;
}

// Bodies that do not meet move as if each half were alone, to the bit.
TEST(ContactFilters, NeighboursWithOtherFiltersMoveAsIfAlone) {
  std::vector<BodyId> all, alone[2];
  Simulation together(rain(-1, all), TimeStepping{.step = 1e-3});
  Simulation even(rain(0, alone[0]), TimeStepping{.step = 1e-3});
  Simulation odd(rain(1, alone[1]), TimeStepping{.step = 1e-3});
  std::size_t touched = 0;
  for (int i = 0; i < 600; ++i) touched += together.step().contacts.size(), even.step(), odd.step();
  EXPECT_GT(touched, 200U);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Simulation& half = i % 2 == 0 ? even : odd;
    const BodyId same = alone[i % 2][i / 2];
    EXPECT_EQ(together.state().position(all[i]), half.state().position(same)) << i;
    EXPECT_EQ(together.state().velocity(all[i]), half.state().velocity(same)) << i;
  }
}

/// A box that lands on a slope; and, if so, obstacles that it does not touch, all around.
System landing(bool hidden) {
  System system;
  system.add(Gravity{{0.0, -g}});
  system.add(HalfPlane{.normal = incline(0.2)}, Surface{.friction = 0.2, .normal_restitution = 0.4}, "slope");
  const BodyId box_body =
      system.add(RigidBody{.mass = box(1.0, 0.2, 0.1), .position = {0.0, 0.5}, .angle = 0.3});
  system.add(Polygon{.body = box_body, .vertices = {{-0.1, -0.05}, {0.1, -0.05}, {0.1, 0.05}, {-0.1, 0.05}}});
  if (!hidden) return system;
  // Without laws: none is needed.
  system.add(HalfPlane{.point = {0.0, 0.3}, .normal = {0.0, 1.0}, .filter = second});
  system.add(HalfPlane{.point = {0.0, 2.0}, .normal = {0.0, 1.0}, .filter = {.groups = 2, .touches = 4}});
  return system;
}

TEST(ContactFilters, HiddenObstaclesChangeNoBit) {
  for (const bool driven_by_events : {false, true}) {
    const auto end = [&](bool hidden) {
      Simulation simulation = driven_by_events ? Simulation(landing(hidden), EventDriven{})
                                               : Simulation(landing(hidden), TimeStepping{.step = 1e-3});
      simulation.run_until(1.5);
      return simulation.state();
    };
    const State plain = end(false), with_hidden = end(true);
    EXPECT_EQ(plain.q, with_hidden.q);
    EXPECT_EQ(plain.v, with_hidden.v);
  }
}

/// Discs of two materials beside each other; steel has a law with steel, wood with nothing but the floor.
struct TwoMaterials {
  System system;
  BodyId one, other;

  explicit TwoMaterials(const ContactFilter& of_wood = {}) {
    const Surface law{.friction = 0.3, .normal_restitution = 0.5};
    const MaterialId steel = system.material("steel"), wood = system.material("wood");
    system.between(steel, steel, law);
    system.add(HalfPlane{.normal = {0.0, 1.0}}, law, "floor");
    one = add("ball", 0.0, steel, {});
    add("second ball", 1.0, steel, {});
    other = add("log", 2.0, wood, of_wood);
  }
  BodyId add(const char* name, double x, MaterialId material, const ContactFilter& filter) {
    const BodyId body = system.add(RigidBody{.mass = disc(1.0, 0.2), .position = {x, 0.5}}, name);
    system.add(Disc{.body = body, .radius = 0.2, .material = material, .filter = filter});
    return body;
  }
};

TEST(ContactFilters, TwoMaterialsOfBodiesThatMayMeetWithoutALawAreFound) {
  const auto without_law = [](const System& system) {
    std::vector<ModelFinding> found;
    for (const ModelFinding& finding : system.check()) {
      if (finding.kind == FindingKind::contact_without_law) found.push_back(finding);
    }
    return found;
  };
  const System system = TwoMaterials().system;
  const auto found = without_law(system);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].parts, std::vector<std::string>{"disc #0 and disc #2"});
  EXPECT_NE(found[0].text.find("pass through each other"), std::string::npos) << found[0].text;
  EXPECT_NE(found[0].text.find("disc #0 and disc #2 (material '"), std::string::npos) << found[0].text;
  EXPECT_EQ(Simulation(system, TimeStepping{}).report().findings.size(), system.check().size());
  // Apart by a filter no law is needed, nor where there is one.
  EXPECT_TRUE(without_law(TwoMaterials({.groups = 2, .touches = 2}).system).empty());
  TwoMaterials given;
  given.system.set_default_law({.friction = 0.1, .normal_restitution = 0.0});
  EXPECT_TRUE(without_law(given.system).empty());
}

}  // namespace
