// Impacts of bodies on each other, event-driven: closed forms, what is conserved, and that none is missed.

#include "tests/integrators/event_driven/body_scenes.h"
#include "tests/integrators/event_run.h"
#include "tests/random.h"
#include "tests/reference/reference_data.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace {

using namespace body_scenes;
using namespace carom_test;

/// Two uniform discs in free flight, and the law of contact.
struct TwoDiscs {
  double m_a, m_b, r_a, r_b;
  Vec<2> x_a, x_b, v_a, v_b;
  double w_a, w_b;
  Surface law;

  /// When they meet; infinity: never.
  [[nodiscard]] double meeting() const {
    const Vec<2> d = x_a - x_b, v = v_a - v_b;
    const double reach = r_a + r_b, speed = v.norm(), along = -d.dot(v) / speed;
    const double across = (d[0] * v[1] - d[1] * v[0]) / speed;
    if (along <= 0.0 || std::abs(across) > reach) return std::numeric_limits<double>::infinity();
    return (along - std::sqrt((reach - across) * (reach + across))) / speed;
  }
  /// The impact (docs/method.md: the special case r_2 = 0, with reduced masses): normal and tangent decouple,
  /// 1/m_n = 1/m_a + 1/m_b, 1/m_t = 3 (1/m_a + 1/m_b), since 1/m + r^2/I = 3/m of a uniform disc.
  void collide() {
    const double time = meeting();
    const Vec<2> n = ((x_a + time * v_a) - (x_b + time * v_b)).normalized(), t(n[1], -n[0]);
    const double normal = n.dot(v_a - v_b);
    const double tangential = t.dot(v_a - v_b) + r_a * w_a + r_b * w_b;
    const double m_n = 1.0 / (1.0 / m_a + 1.0 / m_b), m_t = m_n / 3.0;
    const double p_n = -m_n * (1.0 + law.normal_restitution) * normal;
    const double sticks = -m_t * (1.0 + law.tangential_restitution) * tangential;
    const double p_t = std::clamp(sticks, -law.friction * p_n, law.friction * p_n);
    const Vec<2> impulse = p_n * n + p_t * t;
    v_a += impulse / m_a;
    v_b -= impulse / m_b;
    w_a += r_a * p_t / (0.5 * m_a * r_a * r_a);
    w_b += r_b * p_t / (0.5 * m_b * r_b * r_b);
  }
};

TEST(EventBodies, TwoDiscsFollowTheLawOfWalton) {
  Random random(11);
  int sticks = 0, slips = 0;
  for (int i = 0; i < 200; ++i) {
    TwoDiscs discs{random.uniform(0.1, 3.0),
                   random.uniform(0.1, 3.0),
                   random.uniform(0.1, 0.6),
                   random.uniform(0.1, 0.6),
                   random.vec<2>(0.2),
                   random.vec<2>(0.2),
                   random.vec<2>(0.5),
                   random.vec<2>(0.5),
                   random.uniform(-3.0, 3.0),
                   random.uniform(-3.0, 3.0),
                   {}};
    discs.x_a[0] += 1.6;
    discs.v_a[0] -= 2.0;
    discs.law = {.friction = random.uniform(0.0, 1.0),
                 .normal_restitution = random.uniform(0.0, 1.0),
                 .tangential_restitution = random.uniform(0.0, 1.0)};
    System system;
    system.set_default_law(discs.law);
    const BodyId a = add_disc(system, discs.m_a, discs.r_a, discs.x_a, discs.v_a, discs.w_a);
    const BodyId b = add_disc(system, discs.m_b, discs.r_b, discs.x_b, discs.v_b, discs.w_b);
    const double time = discs.meeting();
    Simulation simulation(system, EventDriven{});
    simulation.run_until(3.0);
    if (!(time < 3.0)) {
      EXPECT_TRUE(simulation.events().empty()) << i;
      continue;
    }
    ASSERT_FALSE(simulation.events().empty()) << i;
    const EventRecord& event = simulation.events().front();
    EXPECT_EQ(event.kind, EventKind::impact);
    // Grazing impacts are as uncertain as the root of the rounding of positions.
    if (std::abs(event.velocity_before[0]) < 1e-2) continue;
    EXPECT_NEAR(event.time, time, 1e-12) << i;
    EXPECT_EQ((event.body == a ? event.other : event.body), b);
    (event.mode == ContactMode::stick ? sticks : slips) += 1;
    discs.collide();
    const State& state = simulation.state();
    // Rounding of the place of the impact turns the normal; velocities are of order 1 to 10.
    constexpr double rounding = 1e-12;
    EXPECT_NEAR((state.velocity(a) - discs.v_a).norm(), 0.0, rounding) << i;
    EXPECT_NEAR((state.velocity(b) - discs.v_b).norm(), 0.0, rounding) << i;
    EXPECT_NEAR(state.spin(a), discs.w_a, 10.0 * rounding) << i;
    EXPECT_NEAR(state.spin(b), discs.w_b, 10.0 * rounding) << i;
  }
  EXPECT_GT(sticks, 20);
  EXPECT_GT(slips, 20);
}

TEST(EventBodies, FastDiscsDoNotPassThroughEachOther) {
  // A long flight of small discs: they are in touch for 1e-5 of the step, and touch at all for 1e-7 of the
  // offsets.
  constexpr double radius = 1e-3, speed = 100.0, distance = 50.0;
  for (const double share : {0.0, 0.5, 0.99, 0.999999, 1.000001, 1.01, 1.5}) {
    System system;
    system.set_default_law({.friction = 0.0, .normal_restitution = 1.0});
    TwoDiscs discs{
        1.0,          2.0,        radius, radius, {-distance, share * 2.0 * radius},           {0.0, 0.0},
        {speed, 0.0}, {0.0, 0.0}, 0.0,    0.0,    {.friction = 0.0, .normal_restitution = 1.0}};
    add_disc(system, 1.0, radius, discs.x_a, discs.v_a);
    add_disc(system, 2.0, radius, discs.x_b, discs.v_b);
    Simulation simulation(system, EventDriven{});
    simulation.run_until(1.0);
    if (share > 1.0) {
      EXPECT_TRUE(simulation.events().empty()) << share;
      continue;
    }
    ASSERT_EQ(simulation.statistics().impacts, 1) << share;
    // Rounding of places, 50 m times 256 epsilon, over the speed of approach.
    const double approach = speed * std::sqrt(1.0 - share * share);
    EXPECT_NEAR(simulation.events().front().time, discs.meeting(), 1e-11 / approach + 1e-15) << share;
  }
}

TEST(EventBodies, NewtonsCradleByTheSimultaneousLaw) {
  const Json data = reference_data("contacts_planar.json").at("newton_cradle");
  for (const Json& at : data.at("cases")) {
    const int count = at.at("N").get<int>();
    const double e = at.at("e").get<double>();
    System system;
    system.set_default_law({.friction = 0.0, .normal_restitution = e});
    std::vector<BodyId> discs;
    for (int i = 0; i < count; ++i) {
      // The first one arrives from afar.
      const double x = i == 0 ? -0.5 : 0.25 * i;
      discs.push_back(add_disc(system, 1.0, 0.125, {x, 0.0}, {i == 0 ? 1.0 : 0.0, 0.0}));
    }
    Simulation simulation(system, EventDriven{});
    simulation.run_until(0.6);
    const Json& expected = at.at("simultaneous_velocities").at(0);
    for (std::size_t i = 0; i < discs.size(); ++i) {
      EXPECT_NEAR(simulation.state().velocity(discs[i])[0], expected.at(i).get<double>(), 1e-12)
          << count << " discs, e = " << e << ", disc " << i;
    }
  }
}

TEST(EventBodies, MomentumIsConservedToRounding) {
  Random random(5);
  int impacts = 0;
  for (int i = 0; i < 40; ++i) {
    System system;
    system.set_default_law({.friction = random.uniform(0.0, 0.8),
                            .normal_restitution = random.uniform(0.3, 1.0),
                            .tangential_restitution = random.uniform(0.0, 1.0)});
    std::vector<double> masses, inertias;
    for (int k = 0; k < 2; ++k) {
      const double mass = random.uniform(0.2, 3.0), sign = k == 0 ? 1.0 : -1.0;
      const Vec<2> place = random.vec<2>(0.3) - sign * Vec<2>(1.2, 0.0);
      const Vec<2> velocity = random.vec<2>(0.4) + sign * Vec<2>(1.0, 0.0);
      masses.push_back(mass);
      if (random.below(2) == 0) {
        const double radius = random.uniform(0.1, 0.4);
        add_disc(system, mass, radius, place, velocity, random.uniform(-5.0, 5.0));
        inertias.push_back(0.5 * mass * radius * radius);
      } else {
        const double w = random.uniform(0.2, 0.8), h = random.uniform(0.2, 0.8);
        add_box(system, mass, w, h, place, random.uniform(-3.0, 3.0), velocity, random.uniform(-5.0, 5.0));
        inertias.push_back(mass * (w * w + h * h) / 12.0);
      }
    }
    Simulation simulation(system, EventDriven{});
    const std::array<double, 3> before = momentum(simulation, masses, inertias);
    simulation.run_until(2.0);
    const std::array<double, 3> after = momentum(simulation, masses, inertias);
    impacts += static_cast<int>(simulation.statistics().impacts);
    // Terms of order 10, and a few hundred roundings of places in flight.
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(after[k], before[k], 1e-13 * 10.0) << i << ", " << k;
    EXPECT_LE(std::abs(simulation.energy().residual()), 1e-12) << i;
  }
  EXPECT_GT(impacts, 25);
}

void run_in_a_box(int count, double end, int impacts) {
  System system;
  const Surface law{.friction = 0.0, .normal_restitution = 1.0};
  system.set_default_law(law);
  add_walls(system, 2.0, law);
  Random random(3);
  std::vector<double> radii;
  std::vector<BodyId> discs;
  for (int i = 0; i < count; ++i) {
    // Some are small and fast.
    const bool small = i % 5 == 0;
    radii.push_back(small ? 0.01 : random.uniform(0.03, 0.15));
    const Vec<2> place(-1.75 + 0.385 * (i % 10), -1.75 + 0.385 * (i / 10));
    discs.push_back(add_disc(system, 100.0 * radii.back() * radii.back(), radii.back(), place,
                             random.vec<2>(small ? 20.0 : 2.0)));
  }
  Simulation simulation(system, EventDriven{.interval = 0.01});
  const double energy = simulation.energy().total();
  double least = 1.0;
  simulation.observe([&](const Simulation& now) {
    for (std::size_t i = 0; i < discs.size(); ++i) {
      const Vec<2> at = now.state().position(discs[i]);
      for (int k = 0; k < 2; ++k) least = std::min(least, 2.0 - std::abs(at[k]) - radii[i]);
      for (std::size_t j = 0; j < i; ++j) {
        least = std::min(least, (at - now.state().position(discs[j])).norm() - radii[i] - radii[j]);
      }
    }
  });
  simulation.run_until(end);
  EXPECT_GT(simulation.statistics().impacts, impacts);
  EXPECT_NEAR(simulation.energy().total(), energy, 1e-9 * energy);
  EXPECT_GT(least, -1e-12);
}

TEST(EventBodies, DiscsInABoxKeepTheirEnergyAndNeverOverlap) { run_in_a_box(20, 3.0, 100); }
TEST(EventBodiesLong, AHundredDiscsInABoxKeepTheirEnergyAndNeverOverlap) { run_in_a_box(100, 2.0, 800); }

TEST(EventBodies, TurningBoxesInABoxKeepTheirEnergyAndNeverOverlap) {
  System system;
  const Surface law{.friction = 0.0, .normal_restitution = 1.0};
  system.set_default_law(law);
  add_walls(system, 1.0, law);
  Random random(8);
  std::vector<std::vector<Vec<2>>> corners;
  std::vector<BodyId> boxes;
  for (int i = 0; i < 6; ++i) {
    const double w = random.uniform(0.1, 0.4), h = random.uniform(0.05, 0.3);
    corners.push_back(corners_of(w, h));
    boxes.push_back(add_box(system, w * h, w, h, {-0.6 + 0.6 * (i % 3), -0.4 + 0.8 * (i / 3)},
                            random.uniform(-3.0, 3.0), random.vec<2>(2.0), random.uniform(-10.0, 10.0)));
  }
  Simulation simulation(system, EventDriven{.interval = 0.005});
  const double energy = simulation.energy().total();
  double least = 1.0;
  simulation.observe([&](const Simulation& now) {
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      const auto a = placed(now.state(), boxes[i], corners[i]);
      for (std::size_t j = 0; j < i; ++j) {
        least = std::min(least, separation(a, placed(now.state(), boxes[j], corners[j])));
      }
    }
  });
  simulation.run_until(2.0);
  EXPECT_GT(simulation.statistics().impacts, 20);
  EXPECT_NEAR(simulation.energy().total(), energy, 1e-9 * energy);
  EXPECT_GT(least, -1e-11);  // places at outputs within a step are interpolated
}

TEST(EventBodies, AStartWithBodiesInEachOtherNamesBoth) {
  System system;
  system.set_default_law({.friction = 0.1, .normal_restitution = 0.0});
  const BodyId a = system.add(RigidBody{.mass = disc(1.0, 0.5)}, "left");
  system.add(Disc{.body = a, .radius = 0.5}, "rim");
  const BodyId b = system.add(RigidBody{.mass = disc(1.0, 0.5), .position = {0.9, 0.0}}, "right");
  system.add(Disc{.body = b, .radius = 0.5}, "tyre");
  try {
    const Simulation simulation(system, EventDriven{});
    FAIL() << "accepted";
  } catch (const ModelError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("'left'"), std::string::npos) << text;
    EXPECT_NE(text.find("'right'"), std::string::npos) << text;
    EXPECT_NE(text.find("-gap_tolerance"), std::string::npos) << text;
  }
}

}  // namespace
