// Bounds of contact in time stepping: more contacts than memory allows are refused by number, and answers
// that are not those of the law are never taken silently.

#include "tests/integrators/falling_polygon.h"
#include "tests/integrators/throws.h"
#include "tests/random.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::add_falling_polygon;
using carom_test::Random;

constexpr double g = 9.81;

/// A bar that stands on the ground with many feet. \param arms rods that hang at it, with friction in their
/// pins
System bar_with_feet(int feet, int arms = 0) {
  System system;
  system.add(Gravity{{0.0, -g}});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.3, .normal_restitution = 0.0});
  const BodyId body = system.add(RigidBody{.mass = box(1.0, 2.0, 0.1), .position = {0.0, 0.01}}, "bar");
  for (int i = 0; i < feet; ++i) {
    system.add(Disc{.body = body, .radius = 0.01, .centre = {-1.0 + 2.0 * i / feet, 0.0}});
  }
  for (int i = 0; i < arms; ++i) {
    const BodyId arm = system.add(RigidBody{.mass = rod(0.1, 0.2), .position = {0.0, -0.09}});
    const JointId pin = system.add(Revolute{.from = body, .to = {arm, {0.0, 0.1}}});
    system.add(JointFriction{.joint = pin, .bound = 0.1});
  }
  return system;
}

TEST(ContactBounds, MoreContactsThanMemoryAllowsAreRefusedByNumber) {
  // Two rows each; 8192 are allowed.
  const System system = bar_with_feet(4097);
  Simulation stepping(bar_with_feet(4097, 12), TimeStepping{.step = 1e-3});
  EXPECT_THROWS(SolverError, stepping.step(), "time stepping at t = 0 s, step 0.001 s",
                "more contacts than memory allows", "4109 constraints", "8206 rows", "at most 8192");
  EXPECT_EQ(stepping.time(), 0.0);
  EXPECT_EQ(stepping.statistics().steps, 0);
  // Sweeps need no room for W: those of one body, and of few pins with friction.
  for (const int arms : {0, 2}) {
    Simulation swept(bar_with_feet(4097, arms), TimeStepping{.step = 1e-3});
    swept.step();
    double impulse = 0.0;
    for (const ContactRecord& contact : swept.report().contacts) impulse += contact.impulse[0];
    EXPECT_NEAR(impulse, (1.0 + 0.1 * arms) * g * 1e-3, 1e-9);
  }
  Simulation events(system, EventDriven{});
  EXPECT_THROWS(SolverError, events.run_until(0.1), "event-driven at t = 0 s",
                "more contacts than memory allows", "4097 constraints");
  EXPECT_EQ(events.time(), 0.0);
}

/// Blocks of several shapes that fall into a trough of steep walls, where they wedge.
System trough(std::uint64_t seed, int bodies) {
  Random random(seed);
  System system;
  system.add(Gravity{{0.0, -g}});
  const Surface law{.friction = random.uniform(0.3, 0.8), .normal_restitution = 0.3};
  system.set_default_law(law);
  system.add(Wall{.from = {-0.05, 0.0}, .to = {-0.6, 2.0}, .radius = 0.05}, "left");
  system.add(Wall{.from = {0.05, 0.0}, .to = {0.6, 2.0}, .radius = 0.05}, "right");
  for (int i = 0; i < bodies; ++i) add_falling_polygon(system, random, 0.9 + 0.35 * i);
  return system;
}

/// Counts the warnings of a run that have a text.
struct Warnings {
  explicit Warnings(Simulation& simulation) {
    simulation.log() =
        Log([this](LogLevel, std::string_view text) { all.emplace_back(text); }, LogLevel::warning);
  }
  [[nodiscard]] std::int64_t with(const std::string& part) const {
    return std::count_if(all.begin(), all.end(),
                         [&](const std::string& text) { return text.find(part) != std::string::npos; });
  }
  std::vector<std::string> all;
};

/// Discs that fall on each other in a box: more than 50 contacts, which sweeps alone solve.
System collapse() {
  Random random(7);
  System system;
  system.add(Gravity{{0.0, -g}});
  system.set_default_law({.friction = 0.5, .normal_restitution = 0.0});
  system.add(BoxInside{.lower = {-0.9, 0.0}, .upper = {0.9, 9.0}});
  for (int i = 0; i < 64; ++i) {
    const Vec<2> place(0.21 * (i % 8) - 0.75 + random.uniform(-0.005, 0.005), 0.11 + 0.21 * (i / 8));
    const BodyId body = system.add(RigidBody{.mass = disc(1.0, 0.1), .position = place});
    system.add(Disc{.body = body, .radius = 0.1});
  }
  return system;
}

struct Told {
  std::int64_t capped = 0, jams = 0;  // steps
};

/// Runs a scene, and expects one warning in every step with such answers.
Told expect_told(const System& system, const TimeStepping& options, double end) {
  Simulation simulation(system, options);
  Warnings warnings(simulation);
  Told told;
  simulation.observe([&](const Simulation& now) {
    const std::vector<ContactRecord>& contacts = now.report().contacts;
    const auto any = [&](auto&& is) { return std::any_of(contacts.begin(), contacts.end(), is) ? 1 : 0; };
    told.capped += any([](const ContactRecord& c) { return c.outcome == Outcome::accepted_at_cap; });
    told.jams += any([](const ContactRecord& c) { return c.restitution_factor == 0.0; });
  });
  simulation.run_until(end);
  EXPECT_EQ(warnings.with("accepted at the cap"), told.capped);
  EXPECT_EQ(warnings.with("jam, as that of"), told.jams);
  EXPECT_GE(simulation.contact_statistics().accepted_at_cap, told.capped);
  EXPECT_GE(simulation.statistics().plastic_jams, told.jams);
  return told;
}

TEST(ContactBounds, AnswersAtTheCapAreToldInEveryStep) {
  TimeStepping options{.step = 1e-3};
  options.contact_budget.sweeps = 4;  // so that they end early
  EXPECT_GT(expect_told(collapse(), options, 0.3).capped, 10);
}

TEST(ContactBounds, JamsAreToldInEveryStep) {
  std::int64_t jams = 0;
  for (const std::uint64_t seed : {0U, 1U, 2U})
    jams += expect_told(trough(seed, 8), {.step = 1e-3}, 0.7).jams;
  EXPECT_GT(jams, 0);
}

// From 12 contacts on sweeps may end before it shows that contacts jam.
TEST(ContactBounds, WhereJamsAreRefusedNoAnswerAtTheCapIsTaken) {
  int refused = 0;
  for (const std::uint64_t seed : {0U, 1U, 2U}) {
    TimeStepping options{.step = 1e-3, .impact_rules = {.refuse_jams = true}};
    Simulation simulation(trough(seed, 8), options);
    try {
      simulation.run_until(1.0);
    } catch (const SolverError& error) {
      ++refused;
      EXPECT_TRUE(error.has_problem()) << error.what();
      EXPECT_NE(std::string(error.what()).find("refuse_jams"), std::string::npos) << error.what();
    }
    EXPECT_EQ(simulation.contact_statistics().accepted_at_cap, 0) << seed;
    EXPECT_EQ(simulation.statistics().plastic_jams, 0) << seed;
  }
  EXPECT_GT(refused, 0);
  TimeStepping options{.step = 1e-3, .impact_rules = {.refuse_jams = true}};
  options.contact_budget.sweeps = 4;
  Simulation simulation(collapse(), options);
  EXPECT_THROWS(SolverError, simulation.run_until(0.3), "refuse_jams", "budget of sweeps");
}

}  // namespace
