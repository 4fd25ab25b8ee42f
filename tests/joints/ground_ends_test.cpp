// Ends of joints on ground. One without a point is where the other end is described: no body is moved. One at
// a point that leaves the joint far open is an error that names the point which would close it.

#include "tests/model_error.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <regex>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

constexpr double length = 0.4;

class GroundEnds : public testing::Test {
protected:
  double number(double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random_);
  }
  Vec<2> vector(double most) { return {number(-most, most), number(-most, most)}; }
  BodyId bar(System& system, double scale = 1.0) {
    return system.add(
        RigidBody{
            .mass = rod(1.0, length * scale), .position = vector(10.0 * scale), .angle = number(-3.0, 3.0)},
        "bar");
  }
  /// An end on a bar, away from its centre half of the time.
  End<2> end(BodyId body, double scale = 1.0) {
    return number(0.0, 1.0) < 0.5 ? End<2>(body) : End<2>(body, vector(0.5 * length * scale));
  }

private:
  std::mt19937 random_{7};
};

using Add = std::function<JointId(System&, const End<2>& from, const End<2>& to)>;

/// Joints of every kind between points, in a random direction.
std::vector<Add> kinds(const Vec<2>& axis, double radius) {
  return {
      [](System& s, const End<2>& from, const End<2>& to) { return s.add(Revolute{.from = from, .to = to}); },
      [](System& s, const End<2>& from, const End<2>& to) { return s.add(Weld{.from = from, .to = to}); },
      [=](System& s, const End<2>& from, const End<2>& to) {
        return s.add(Prismatic{.from = from, .to = to, .axis = axis});
      },
      [=](System& s, const End<2>& from, const End<2>& to) {
        return s.add(PointOnLine{.from = from, .to = to, .axis = axis});
      },
      [=](System& s, const End<2>& from, const End<2>& to) {
        return s.add(Rolling{.from = from, .to = to, .normal = axis, .radius = radius});
      }};
}
constexpr std::size_t rolling = 4;

TEST_F(GroundEnds, WithoutAPointAreWhereTheOtherEndIs) {
  for (int seed = 0; seed < 40; ++seed) {
    const Vec<2> axis = vector(1.0);
    const std::vector<Add> all = kinds(axis, number(0.01, 1.0));
    for (std::size_t kind = 0; kind < all.size(); ++kind) {
      for (const bool ground_is_from : {true, false}) {
        if (kind == rolling && !ground_is_from) continue;  // discs roll on lines of `from`
        System system;
        const BodyId body = bar(system);
        const End<2> on_bar = end(body);
        const JointId joint =
            ground_is_from ? all[kind](system, ground, on_bar) : all[kind](system, on_bar, ground);
        for (const Mode& mode : {Mode(TimeStepping{}), Mode(EventDriven{})}) {
          const Simulation simulation(system, mode);
          // Rounding of places of 10 m.
          EXPECT_LE(simulation.report().projected, 1e-14) << kind << " " << ground_is_from;
          EXPECT_TRUE(simulation.report().findings.empty());
          if (kind != 1) {
            EXPECT_NEAR(simulation.state().coordinate(joint), 0.0, 1e-14);
          }
        }
      }
    }
  }
}

TEST_F(GroundEnds, OfALineAreNearestToTheOriginSoThatLengthsAreMeasuredFromThere) {
  for (int seed = 0; seed < 40; ++seed) {
    const Vec<2> axis = vector(1.0).normalized();
    System system;
    const BodyId body = bar(system);
    const Vec<2> place = Simulation(system, EventDriven{}).state().position(body);
    const JointId joint =
        system.add(Prismatic{.from = ground, .to = body, .axis = axis, .zero_distance = 0.25});
    const Simulation simulation(system, EventDriven{});
    EXPECT_NEAR(simulation.state().coordinate(joint), place.dot(axis) - 0.25, 1e-13);
  }
}

TEST_F(GroundEnds, AtAPointStayThere) {
  System system;
  const BodyId body = system.add(RigidBody{.mass = rod(1.0, length), .position = {0.5 * length, 0.0}});
  system.add(Weld{.from = {ground, {0.0, 0.0}}, .to = {body, {-0.5 * length, 0.0}}});
  EXPECT_EQ(Simulation(system, EventDriven{}).report().projected, 0.0);
  // A rod without a point would have no direction: its end is the origin.
  System pendulum;
  const BodyId bob = pendulum.add(Particle{.mass = 1.0, .position = {3.0, 4.0}});
  pendulum.add(Rod{.from = ground, .to = bob, .length = 5.0});
  EXPECT_EQ(Simulation(pendulum, EventDriven{}).report().projected, 0.0);
}

/// The point that an error recommends.
Vec<2> recommended(const std::string& text) {
  std::smatch found;
  const std::regex point("at the point \\(([^,]+), ([^)]+)\\) of");
  if (!std::regex_search(text, found, point)) throw std::invalid_argument(text);
  return {std::stod(found[1]), std::stod(found[2])};
}

TEST_F(GroundEnds, FarFromTheOtherEndAreRefusedWithThePointThatWouldDo) {
  int refused = 0;
  for (int seed = 0; seed < 40; ++seed) {
    const double scale = std::pow(10.0, number(-4.0, 4.0));
    const Vec<2> axis = vector(1.0);
    const std::vector<Add> all = kinds(axis, number(0.01, 1.0) * scale);
    for (const Add& add : all) {
      System system;
      const BodyId body = bar(system, scale);
      const End<2> on_bar = end(body, scale);
      System mended = system, asked = system;
      add(system, {ground, {0.0, 0.0}}, on_bar);
      std::string text;
      try {
        const Simulation simulation(system, EventDriven{});
        // Drawn nearly closed: a line may go past the body.
        EXPECT_LE(simulation.report().projected, 0.1 * length * scale);
        continue;
      } catch (const ModelError& error) {
        text = error.what();
      }
      ++refused;
      EXPECT_NE(text.find("which is more than a tenth of their size"), std::string::npos) << text;
      EXPECT_NE(text.find("System::close_joints()"), std::string::npos) << text;
      add(mended, {ground, recommended(text)}, on_bar);
      EXPECT_LE(Simulation(mended, EventDriven{}).report().projected, 1e-14 * scale) << text;
      add(asked, {ground, {0.0, 0.0}}, on_bar);
      asked.close_joints();
      EXPECT_GT(Simulation(asked, TimeStepping{}).report().projected, 0.0);
      asked.close_joints(false);
      EXPECT_THROW(Simulation(asked, TimeStepping{}), ModelError);
    }
  }
  EXPECT_GT(refused, 150);  // of 200
}

TEST_F(GroundEnds, FarAreTwoBodiesToo) {
  for (int seed = 0; seed < 40; ++seed) {
    System system;
    const BodyId a = bar(system);
    const BodyId b =
        system.add(RigidBody{.mass = rod(1.0, length), .position = vector(10.0), .angle = number(-3.0, 3.0)});
    const End<2> from(a, vector(0.2)), to(b, vector(0.2));
    System mended = system;
    system.add(Revolute{.from = from, .to = to});
    try {
      const Simulation simulation(system, EventDriven{});
      ADD_FAILURE() << "accepted";
    } catch (const ModelError& error) {
      mended.add(Revolute{.from = {a, recommended(error.what())}, .to = to});
      EXPECT_LE(Simulation(mended, EventDriven{}).report().projected, 1e-14);
    }
  }
}

TEST_F(GroundEnds, OpenByLessThanATenthAreAFinding) {
  for (const double part : {0.05, 0.09, 0.11, 0.5}) {
    for (const double scale : {1e-3, 1.0, 1e3}) {
      System pin;  // its lever is the size of the bar
      const BodyId body =
          pin.add(RigidBody{.mass = rod(1.0, 2.0 * scale), .position = {scale, part * scale}});
      pin.add(Revolute{.from = {ground, {0.0, 0.0}}, .to = {body, {-scale, 0.0}}});
      System rods;
      const BodyId bob = rods.add(Particle{.mass = 1.0, .position = {scale * (1.0 + part), 0.0}});
      rods.add(Rod{.from = ground, .to = bob, .length = scale});
      for (const System& system : {pin, rods}) {
        if (part > 0.1) {
          EXPECT_MODEL_ERROR(Simulation(system, EventDriven{}), "drawn", "allowed");
        } else {
          const Simulation simulation(system, EventDriven{});
          ASSERT_EQ(simulation.report().findings.size(), 1U);
          EXPECT_EQ(simulation.report().findings[0].kind, FindingKind::open_joint);
        }
      }
    }
  }
}

TEST_F(GroundEnds, AnEditThatDrawsAJointOpenChangesNothing) {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  const BodyId body = system.add(RigidBody{.mass = rod(1.0, length), .position = {5.0, 3.0}}, "bar");
  Simulation simulation(system, TimeStepping{});
  simulation.run_until(0.5);
  const State before = simulation.state();
  EXPECT_MODEL_ERROR(simulation.edit([&](System& edited) {
    edited.add(Weld{.from = {ground, {0.0, 0.0}}, .to = body}, "nail");
  }),
                     "weld 'nail'", "m from where it closes", "allowed");
  EXPECT_EQ(simulation.state().q, before.q);
  EXPECT_TRUE(simulation.system().joints().empty());
}

}  // namespace
