// The report of contacts: forces on one part against statics and momentum, in both modes, and the recorder.

#include "tests/integrators/event_driven/body_scenes.h"
#include "tests/integrators/throws.h"
#include "tests/temporary_folder.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace {

using namespace body_scenes;

TEST(ContactReport, ForcesOfAStackAreItsWeights) {
  System system;
  system.set_default_law({.friction = 0.5, .normal_restitution = 0.0});
  system.add(Gravity{{0.0, -g}});
  const ObstacleId floor =
      system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.5, .normal_restitution = 0.0});
  const BodyId lower = add_box(system, 2.0, 1.0, 0.5, {0.0, 0.25});
  const BodyId upper = add_box(system, 1.0, 0.8, 0.5, {0.0, 0.75});
  Simulation simulation(system, TimeStepping{.step = 1e-3});
  for (int i = 0; i < 5; ++i) simulation.step();
  const StepReport& report = simulation.report();
  // A certificate of 1e-12 of the largest impulse.
  EXPECT_NEAR(force_on(report, floor).mean_force[1], -3.0 * g, 1e-9);
  EXPECT_NEAR(force_on(report, upper).mean_force[1], 1.0 * g, 1e-9);
  const PartForce on_lower = force_on(report, lower);
  EXPECT_NEAR(on_lower.mean_force[1], 2.0 * g, 1e-9);
  EXPECT_NEAR(on_lower.impulse[1], 2.0 * g * 1e-3, 1e-12);
  EXPECT_NEAR(on_lower.angular_impulse, 0.0, 1e-12);
  EXPECT_EQ(on_lower.contacts, 4);
  EXPECT_EQ(force_on(report, BodyId{}).contacts, 0);
}

TEST(ContactReport, ImpulsesOfImpactsChangeTheMomentum) {
  for (const bool events : {false, true}) {
    System system;
    system.set_default_law({.friction = 0.3, .normal_restitution = 0.6, .tangential_restitution = 0.2});
    const BodyId a = add_disc(system, 1.0, 0.2, {-0.5, 0.05}, {2.0, 0.0}, 3.0);
    const BodyId b = add_box(system, 2.0, 0.4, 0.6, {0.2, 0.0}, 0.1);
    Simulation simulation = events ? Simulation(system, EventDriven{.interval = 1.0})
                                   : Simulation(system, TimeStepping{.step = 1e-3});
    Vec<2> on_a = Vec<2>::Zero(), on_b = Vec<2>::Zero();
    double spin_b = 0.0;
    const auto angular = [&](const Simulation& run) {
      const Vec<2> x = run.state().position(b), v = run.state().velocity(b);
      return 2.0 * (x[0] * v[1] - x[1] * v[0]) + 2.0 * (0.16 + 0.36) / 12.0 * run.state().spin(b);
    };
    simulation.observe([&](const Simulation& run) {
      on_a += force_on(run.report(), a).impulse;
      const PartForce of_b = force_on(run.report(), b);
      on_b += of_b.impulse;
      spin_b += of_b.angular_impulse;
      EXPECT_EQ(of_b.impulse, of_b.impact_impulse);
      for (const ContactRecord& contact : run.report().contacts) {
        EXPECT_NEAR(std::hypot(contact.normal[0], contact.normal[1]), 1.0, 1e-14);
        EXPECT_NEAR((Vec<2>(contact.point[0], contact.point[1]) - run.state().position(a)).norm(), 0.2, 1.5);
      }
    });
    simulation.run_until(1.0);
    EXPECT_GT(on_b.norm(), 0.5) << events;
    const Vec<2> gained_a = simulation.state().velocity(a) - Vec<2>(2.0, 0.0);
    const Vec<2> gained_b = 2.0 * simulation.state().velocity(b);
    EXPECT_NEAR((on_a - gained_a).norm(), 0.0, 1e-12) << events;
    EXPECT_NEAR((on_b - gained_b).norm(), 0.0, 1e-12) << events;
    EXPECT_NEAR(spin_b, angular(simulation), 1e-12) << events;
  }
}

TEST(ContactReport, ForcesOfContactsThatLastInBothModes) {
  // A disc with resistance to rolling that slides down an incline, a brick that sticks beside it, with a
  // smaller one on it.
  constexpr double slope = 0.2, mu = 0.5, rho = 0.01;
  System system;
  const Surface law{.friction = mu, .normal_restitution = 0.0, .rolling_resistance = rho};
  system.set_default_law(law);
  system.add(Gravity{{g * std::sin(slope), -g * std::cos(slope)}});  // seen from the floor
  const ObstacleId floor = system.add(HalfPlane{.normal = {0.0, 1.0}}, law);
  const BodyId ball = add_disc(system, 2.0, 0.1, {0.0, 0.1}, {1.0, 0.0}, 5.0);
  const BodyId lower = add_box(system, 3.0, 1.0, 0.5, {-5.0, 0.25});
  const BodyId upper = add_box(system, 1.0, 0.8, 0.5, {-5.0, 0.75});
  for (const bool events : {false, true}) {
    Simulation simulation = events ? Simulation(system, EventDriven{.interval = 1e-3})
                                   : Simulation(system, TimeStepping{.step = 1e-3});
    EXPECT_TRUE(simulation.contact_forces().empty());
    simulation.run_until(0.01);
    const std::vector<LastingContact> forces = simulation.contact_forces();
    EXPECT_EQ(forces.size(), 5U) << events;
    const double down = g * std::sin(slope), press = g * std::cos(slope);
    // Certificates of 1e-12 of impulses of 0.06 N s over 1e-3 s.
    constexpr double close = 1e-9;
    const PartForce on_ball = force_on(forces, ball);
    EXPECT_EQ(on_ball.contacts, 1);
    EXPECT_NEAR(on_ball.mean_force[1], 2.0 * press, close) << events;
    EXPECT_NEAR(on_ball.mean_force[0], -mu * 2.0 * press, close) << events;
    // About the origin: of friction none, of the normal force by its place, against the spin by rho.
    const auto of_ball =
        std::find_if(forces.begin(), forces.end(), [&](const LastingContact& at) { return at.body == ball; });
    ASSERT_NE(of_ball, forces.end());
    EXPECT_EQ(of_ball->mode, ContactMode::slip_positive);
    EXPECT_EQ(of_ball->obstacle, floor);
    EXPECT_NEAR(of_ball->rolling_moment, -rho * 2.0 * press, close);
    EXPECT_NEAR(on_ball.mean_moment, of_ball->point[0] * 2.0 * press - rho * 2.0 * press, close);
    EXPECT_NEAR(of_ball->point[0], simulation.state().position(ball)[0], 2e-3);  // when it was found
    EXPECT_NEAR(of_ball->normal[1], 1.0, 1e-15);
    EXPECT_NEAR(of_ball->velocity[1],
                simulation.state().velocity(ball)[0] + 0.1 * simulation.state().spin(ball), 1e-12);
    EXPECT_NEAR(force_on(forces, upper).mean_force[1], press, close) << events;
    EXPECT_NEAR(force_on(forces, upper).mean_force[0], -down, close) << events;
    EXPECT_NEAR(force_on(forces, lower).mean_force[1], 3.0 * press, close) << events;
    EXPECT_NEAR(force_on(forces, floor).mean_force[1], -6.0 * press, close) << events;
    // The bricks do not turn: moments of all forces on the upper one about its centre vanish.
    const Vec<2> at = simulation.state().position(upper);
    const PartForce on_upper = force_on(forces, upper);
    EXPECT_NEAR(on_upper.mean_moment - (at[0] * on_upper.mean_force[1] - at[1] * on_upper.mean_force[0]), 0.0,
                close)
        << events;
    EXPECT_EQ(force_on(forces, BodyId{}).contacts, 0);
    EXPECT_EQ(force_on(forces, ObstacleId{}).contacts, 0);
    if (!events) {
      EXPECT_NEAR(force_on(simulation.report(), ball).mean_moment, on_ball.mean_moment, 1e-12);
    }
  }
}

TEST(ContactReport, SharesOfStepsByCertificate) {
  System system;
  const Surface law{.friction = 0.3, .normal_restitution = 0.0};
  system.add(Gravity{{0.0, -g}});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, law);
  add_disc(system, 1.0, 0.1, {0.0, 0.1 + 0.5 * g * 0.0104 * 0.0104});  // in the air for ten steps
  Simulation simulation(system, TimeStepping{.step = 1e-3});
  EXPECT_EQ(simulation.statistics().certified_share(1e-8), 1.0);
  simulation.run_until(0.03);
  const Statistics& statistics = simulation.statistics();
  std::int64_t with_contact = 0;
  for (const std::int64_t count : statistics.certified_steps) with_contact += count;
  EXPECT_EQ(with_contact, statistics.contact_steps);  // one contact
  EXPECT_LT(with_contact, statistics.steps);
  EXPECT_GT(with_contact, 10);
  EXPECT_EQ(statistics.certified_share(1e-10), 1.0);
  ContactCounts counts;
  for (const double residual : {1e-13, 1e-11, 1e-9, 1e-3}) counts.count_step(residual);
  EXPECT_EQ(counts.certified_share(1e-12), 0.25);
  EXPECT_EQ(counts.certified_share(2e-10), 0.5);
  EXPECT_EQ(counts.certified_share(1e-8), 0.75);
  EXPECT_EQ(counts.certified_share(1.0), 0.75);  // of the last nothing is known
  EXPECT_EQ(counts.certified_share(1e-13), 0.0);
  // They go through a checkpoint.
  const carom_test::TemporaryFolder folder;
  simulation.save(folder / "checkpoint");
  Simulation again(system, TimeStepping{.step = 1e-3});
  again.load(folder / "checkpoint");
  EXPECT_EQ(again.statistics().certified_steps, statistics.certified_steps);
}

TEST(ContactReport, RecorderWritesARowForEveryContact) {
  const carom_test::TemporaryFolder folder;
  const std::string path = folder / "contacts.csv";
  System system;
  system.add(Gravity{{0.0, -g}});
  const ObstacleId floor = system.add(HalfPlane{.normal = {0.0, 1.0}},
                                      Surface{.friction = 0.5, .normal_restitution = 0.0}, "floor");
  const BodyId body = system.add(
      RigidBody{.mass = box(1.0, 1.0, 0.5), .position = Vec<2>(0.0, 0.25), .velocity = Vec<2>(1.0, -1.0)},
      "box");
  system.add(Polygon{.body = body, .vertices = corners_of(1.0, 0.5)});
  Simulation simulation(system, TimeStepping{.step = 1e-3});
  ContactRecorder recorder(simulation, path);
  double weight = 0.0;
  for (int i = 0; i < 4; ++i) {
    simulation.step();
    weight -= force_on(simulation.report(), floor).mean_force[1];
  }
  recorder.detach(simulation);
  EXPECT_EQ(recorder.rows(), 8);
  std::ifstream file(path);
  std::string line;
  ASSERT_TRUE(std::getline(file, line));
  const auto cells = [](const std::string& text) {
    std::vector<std::string> found;
    std::stringstream in(text);
    for (std::string cell; std::getline(in, cell, ',');) found.push_back(cell);
    return found;
  };
  const std::vector<std::string> header = cells(line);
  const auto column = [&](const std::string& name) {
    const auto at = std::find(header.begin(), header.end(), name);
    EXPECT_NE(at, header.end()) << name;
    return static_cast<std::size_t>(at - header.begin());
  };
  double sum = 0.0;
  int impacts = 0;
  while (std::getline(file, line)) {
    const std::vector<std::string> row = cells(line);
    ASSERT_EQ(row.size(), header.size());
    EXPECT_NE(row[column("part")].find("box"), std::string::npos);
    EXPECT_NE(row[column("other part")].find("floor"), std::string::npos);
    const std::string& force = row[column("normal mean force [N]")];
    EXPECT_EQ(force.empty(), row[column("kind")] == "impact");
    impacts += force.empty() ? 1 : 0;
    if (!force.empty()) sum += std::stod(force);
  }
  EXPECT_EQ(impacts, 2);
  EXPECT_NEAR(sum, weight, 1e-12);
  EXPECT_NEAR(sum, 3.0 * g, 1e-9);
  EXPECT_THROWS(FileError, ContactRecorder(simulation, folder / "none/contacts.csv"), "contacts.csv");
}

/// Cells of one column of a file without quoted commas.
std::vector<std::string> column_of(const std::string& path, const std::string& name) {
  std::ifstream file(path);
  std::vector<std::string> cells;
  std::size_t place = 0, at = 0;
  for (std::string line, cell; std::getline(file, line); at = 0) {
    const bool is_header = cells.empty();
    for (std::stringstream in(line); std::getline(in, cell, ','); ++at) {
      if (is_header && cell == name) place = at;
      if (!is_header && at == place) cells.push_back(cell);
    }
    if (is_header) cells.emplace_back(name);
  }
  cells.erase(cells.begin());
  return cells;
}

// A step of step control has two records of a contact that lasts, each with the impulse of half of the step.
TEST(ContactReport, RecorderWritesTheMeanForceOfStepsInParts) {
  const carom_test::TemporaryFolder folder;
  const std::string path = folder / "contacts.csv";
  System system;
  system.add(Gravity{{0.0, -g}});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.5, .normal_restitution = 0.0});
  for (const double x : {0.0, 1.0}) {
    const BodyId body = system.add(RigidBody{.mass = disc(2.0, 0.1), .position = {x, 0.1}});
    system.add(Disc{.body = body, .radius = 0.1});
  }
  Simulation simulation(system, TimeStepping{.step = 1e-3, .control = StepControl{}});
  ContactRecorder recorder(simulation, path);
  for (int i = 0; i < 3; ++i) simulation.step();
  recorder.detach(simulation);
  const std::vector<std::string> forces = column_of(path, "normal mean force [N]");
  EXPECT_EQ(forces.size(), 3U * 2U * 2U);
  for (const std::string& force : forces) EXPECT_NEAR(std::stod(force), 2.0 * g, 1e-9);
  for (const LastingContact& contact : simulation.contact_forces()) {
    EXPECT_NEAR(contact.force[0], 2.0 * g, 1e-9);
  }
}

// Where impacts are located a step may have several parts, with a record of each contact in each of them.
TEST(ContactReport, ContactsThatLastHaveOneForceEach) {
  System system;
  system.set_default_law({.friction = 0.3, .normal_restitution = 0.5});
  system.add(Gravity{{0.0, -g}});
  system.add(HalfPlane{.normal = {0.0, 1.0}});
  for (const double x : {0.0, 0.5, 1.0}) add_disc(system, 1.0, 0.1, {x, 0.1}, {2.0 - 2.0 * x, 0.0});
  Simulation simulation(system, TimeStepping{.step = 1e-2, .impacts = ImpactTimes::located});
  bool parted = false;
  for (int i = 0; i < 50; ++i) {
    simulation.step();
    const std::vector<LastingContact> forces = simulation.contact_forces();
    std::size_t lasting = 0;
    for (const ContactRecord& contact : simulation.report().contacts) lasting += contact.impact ? 0U : 1U;
    parted = parted || lasting > forces.size();
    double weight = 0.0;
    for (const LastingContact& contact : forces) {
      const auto same = [&](const LastingContact& other) { return other.key == contact.key; };
      EXPECT_EQ(std::count_if(forces.begin(), forces.end(), same), 1);
      if (contact.obstacle.valid()) weight += contact.force[0];
    }
    EXPECT_GT(weight, 0.0);
  }
  EXPECT_TRUE(parted);
}

}  // namespace
