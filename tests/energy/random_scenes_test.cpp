// Random models of everything there is, stepped for a while: the ledger closes, every contact problem is
// solved with its certificate, no exception. Scenes are named by their number, so that one can be repeated.
//
// A solution of the contact problem is guaranteed if no impulses in the friction cones cancel each other
// (sum H^T P = 0), or if all coefficients of restitution are equal. Obstacles whose cones all lie strictly in
// one half-plane, |slope| + atan(mu) < pi/2, can never jam a body; scenes with others get one e everywhere.
// Jammed contact with unequal e has a test of its own.

#include "tests/energy/ledger_check.h"
#include "tests/random.h"
#include "tests/shares.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::Random;

Surface random_surface(Random& random) {
  // Round values too: they are where modes meet.
  const auto coefficient = [&random] {
    const double choice = random.uniform(0.0, 1.0);
    return choice < 0.2 ? 0.0 : choice > 0.8 ? 1.0 : random.uniform(0.0, 1.0);
  };
  const double friction = random.uniform(0.0, 1.0) < 0.15 ? 0.0 : random.uniform(0.0, 1.5);
  return {.friction = friction, .normal_restitution = coefficient(), .tangential_restitution = coefficient()};
}

BodyId random_body(System& system, Random& random) {
  const Vec<2> position(random.uniform(-2.0, 2.0), random.uniform(-0.1, 1.5));
  const Vec<2> velocity = random.vec<2>(5.0);
  const double mass = std::pow(10.0, random.uniform(-1.5, 1.5));
  if (random.below(4) == 0)
    return system.add(Particle{.mass = mass, .position = position, .velocity = velocity});
  const double size = random.uniform(0.1, 0.6);
  const double spin = random.uniform(-10.0, 10.0);
  const double angle = random.below(5) == 0 ? 0.0 : random.uniform(-3.0, 3.0);
  const auto body = [&](const MassProperties<2>& properties) {
    return system.add(RigidBody{
        .mass = properties, .position = position, .angle = angle, .velocity = velocity, .spin = spin});
  };
  switch (random.below(3)) {
    case 0: {
      const BodyId id = body(disc(mass, size));
      system.add(Disc{.body = id, .radius = size});
      return id;
    }
    case 1: {
      const BodyId id = body(rod(mass, 2.0 * size));
      system.add(Segment{.body = id, .from = {-size, 0.0}, .to = {size, 0.0}});
      return id;
    }
    default: {
      std::vector<Vec<2>> vertices;
      const unsigned corners = 3 + random.below(3);
      for (unsigned i = 0; i < corners; ++i) {
        const double at = 6.283185307179586 * (i + random.uniform(0.0, 0.5)) / corners;
        vertices.emplace_back(size * std::cos(at), size * std::sin(at));
      }
      const MassProperties<2> properties = polygon(mass, vertices);
      for (Vec<2>& vertex : vertices) vertex -= properties.centre;
      const BodyId id = body(centred(properties));
      system.add(Polygon{.body = id, .vertices = vertices});
      return id;
    }
  }
}

/// Whether scenes are sure to have solutions, or may jam.
enum class Jamming { excluded, allowed };

void random_obstacles(System& system, Random& random, Jamming jamming) {
  struct Wall {
    double slope;
    Surface surface;
  };
  std::vector<Wall> walls(1 + random.below(3));
  bool may_jam = false;
  for (Wall& wall : walls) {
    wall = {&wall == walls.data() ? random.uniform(-0.3, 0.3) : random.uniform(-1.4, 1.4),
            random_surface(random)};
    may_jam = may_jam || std::abs(wall.slope) + std::atan(wall.surface.friction) > 1.5;
  }
  for (Wall& wall : walls) {
    if (may_jam && jamming == Jamming::excluded) {
      const double e = walls[0].surface.normal_restitution;
      wall.surface.normal_restitution = wall.surface.tangential_restitution = e;
    }
    system.add(HalfPlane{.point = {0.0, -0.2}, .normal = incline(wall.slope)}, wall.surface);
  }
}

System random_scene(std::uint64_t seed, Jamming jamming) {
  Random random(seed);
  System system;
  if (random.below(5) != 0) system.add(Gravity{{random.uniform(-2.0, 2.0), -9.81}});
  random_obstacles(system, random, jamming);
  const unsigned count = 1 + random.below(5);
  std::vector<BodyId> bodies;
  for (unsigned i = 0; i < count; ++i) bodies.push_back(random_body(system, random));
  for (unsigned i = 0; i + 1 < count; ++i) {
    if (random.below(2) == 0) continue;
    const auto end = [&](BodyId id) {
      return system.has_orientation(id) && random.below(2) == 0 ? End<2>(id, random.vec<2>(0.3)) : End<2>(id);
    };
    system.add(
        SpringDamper{.from = random.below(6) == 0 ? End<2>(ground, random.vec<2>(1.0)) : end(bodies[i]),
                     .to = end(bodies[i + 1]),
                     .stiffness = std::pow(10.0, random.uniform(0.0, 3.0)),
                     .damping = random.below(2) == 0 ? 0.0 : random.uniform(0.0, 2.0),
                     .free_length = random.uniform(0.0, 1.0)});
  }
  if (random.below(3) == 0) {
    const double size = random.uniform(0.0, 20.0), rate = random.uniform(1.0, 30.0);
    system.add(AppliedForce{.on = bodies[0],
                            .force = [=](double t) { return Vec<2>(size * std::sin(rate * t), size); }});
  }
  return system;
}

struct Findings {
  int scenes_with_contact = 0;
  std::int64_t contact_steps = 0;
  double worst_residual = 0.0;
  std::vector<std::string> failures;
};

Findings run_scenes(const carom_test::SeedRange& seeds) {
  Findings findings;
  for (std::uint64_t seed = seeds.first; seed < seeds.last; ++seed) {
    const std::string name = "scene " + std::to_string(seed) + ": ";
    try {
      // A step at which every coupling of the scene contracts: 1000 N/m on 0.03 kg with levers.
      Simulation simulation(random_scene(seed, Jamming::excluded), TimeStepping{.step = 1e-3});
      simulation.run_until(0.2);
      const Statistics& statistics = simulation.statistics();
      if (statistics.contact_steps > 0) ++findings.scenes_with_contact;
      findings.contact_steps += statistics.contact_steps;
      findings.worst_residual = std::max(findings.worst_residual, statistics.worst_residual);
      const auto closes = carom_test::ledger_closes(simulation.energy());
      if (!closes) findings.failures.push_back(name + closes.message());
      if (!(statistics.worst_residual <= 1e-10)) {
        findings.failures.push_back(name + "contact residual " + to_text(statistics.worst_residual));
      }
    } catch (const std::exception& error) {
      findings.failures.push_back(name + error.what());
    }
  }
  return findings;
}

void expect_sound(const Findings& findings, int count) {
  EXPECT_TRUE(findings.failures.empty()) << findings.failures.size() << " of " << count << " scenes";
  for (const std::string& failure : findings.failures) ADD_FAILURE() << failure;
  // Else nothing would have been tried.
  EXPECT_GE(findings.scenes_with_contact, count / 2);
}

TEST(RandomScenes, AccountClosesAndContactIsSolved) { expect_sound(run_scenes({0, 50}), 50); }

TEST(RandomScenes, FixedPointSettlesWhereContactHasSeveralSolutions) {
  // In these scenes the iteration over the couplings meets contact problems with several solutions; it would
  // jump between them for ever if each sweep chose anew.
  for (const std::uint64_t scene : {13092u, 14458u, 17538u, 24846u, 40569u, 43537u, 45375u}) {
    expect_sound(run_scenes({scene, scene + 1}), 1);
  }
}

TEST(RandomScenesLong, AccountClosesAndContactIsSolved) {
  const carom_test::SeedRange seeds = carom_test::seeds_from(1000, 5000);
  const Findings findings = run_scenes(seeds);
  expect_sound(findings, seeds.count());
  RecordProperty("contact_steps", std::to_string(findings.contact_steps));
  RecordProperty("worst_residual", to_text(findings.worst_residual));
}

TEST(RandomScenesLong, JammedContactWithUnequalRestitutionIsSolvedOrSaidToHaveNoSolution) {
  // About one scene in 400 meets a jammed contact without a solution. It must say so, name the contacts, hand
  // over the problem, and stand where it stood; up to three contacts the absence is proved.
  int without = 0;
  for (std::uint64_t seed = 20000; seed < 24000; ++seed) {
    Simulation simulation(random_scene(seed, Jamming::allowed),
                          TimeStepping{.step = 1e-3, .impact_rules = {.refuse_jams = true}});
    State last = simulation.state();
    simulation.observe([&](const Simulation& now) { last = now.state(); });
    try {
      simulation.run_until(0.2);
      EXPECT_LE(simulation.statistics().worst_residual, 1e-10) << seed;
    } catch (const SolverError& error) {
      ++without;
      ASSERT_TRUE(error.has_problem()) << seed << error.what();
      const std::size_t contacts = error.problem().groups().size();
      EXPECT_GE(contacts, 2u) << seed << error.what();
      EXPECT_EQ(error.failure().parts.size(), contacts) << seed;
      if (contacts <= 3) {
        EXPECT_NE(std::string(error.what()).find("no solution"), std::string::npos) << error.what();
      }
    }
    EXPECT_EQ(simulation.state().q, last.q) << seed;
    EXPECT_EQ(simulation.state().v, last.v) << seed;
    EXPECT_TRUE(carom_test::ledger_closes(simulation.energy())) << seed;
    // Without restitution it has one.
    if (simulation.time() == 0.2) continue;
    simulation.switch_to(TimeStepping{.step = 1e-3});
    EXPECT_NO_THROW(simulation.run_until(0.2)) << seed;
    EXPECT_GT(simulation.statistics().plastic_jams, 0) << seed;
    EXPECT_TRUE(carom_test::ledger_closes(simulation.energy())) << seed;
  }
  EXPECT_GE(without, 1);  // else the scenes do not jam and prove nothing
  EXPECT_LE(without, 40);
}

}  // namespace
