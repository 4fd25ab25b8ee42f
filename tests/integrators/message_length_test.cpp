// Messages of errors: as long as one reads, in both modes, whatever the scene.

#include "tests/integrators/event_driven/body_scenes.h"
#include "tests/random.h"

#include <carom/carom.h>
#include <carom/core/listed.h>

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace {

using namespace body_scenes;
using carom_test::Random;

/// True of text in UTF-8 without a part of a character at a cut: names in it are of two bytes, 0xC3 0xA4.
bool has_whole_characters(std::string_view text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool first = text[i] == '\xC3', second = text[i] == '\xA4';
    if (first && (i + 1 == text.size() || text[i + 1] != '\xA4')) return false;
    if (second && (i == 0 || text[i - 1] != '\xC3')) return false;
  }
  return true;
}

std::string long_name(int number) {
  std::string name = "body " + std::to_string(number) + " ";
  for (int i = 0; i < 200; ++i) name += "\xC3\xA4";
  return name;
}

/// A row of 4 to 23 discs that touch each other and two walls, which close: nothing has room. To an impact of
/// eight and more impulses without bound were an answer, which left discs as fast as before: ten thousand of
/// them at one instant, for minutes.
System pressed_row(std::uint64_t seed) {
  constexpr double radius = 0.1;
  Random random(seed);
  System system;
  system.set_default_law({.friction = random.uniform(0.0, 0.8), .normal_restitution = 0.0});
  const int count = 4 + static_cast<int>(random.below(20));
  const double speed = random.uniform(0.1, 3.0);
  const bool long_names = random.below(2) == 0;
  for (const double side : {-1.0, 1.0}) {
    system.add(HalfPlane{.point = {radius * count * side, 0.0},
                         .normal = {-side, 0.0},
                         .motion = {.displacement = [=](double t) { return Vec<2>(-side * speed * t, 0.0); }},
                         .surface_speed = random.uniform(-2.0, 2.0)});
  }
  for (int i = 0; i < count; ++i) {
    const double mass = random.below(4) == 0 ? 1e9 : 1.0;
    const BodyId body =
        system.add(RigidBody{.mass = disc(mass, radius), .position = {radius * (2 * i + 1 - count), 0.0}},
                   long_names ? long_name(i) : std::string{});
    system.add(Disc{.body = body, .radius = radius});
  }
  return system;
}

/// Runs into an error, and looks at its message. True if there was one.
bool fails(const System& system, const Mode& mode) {
  try {
    Simulation simulation(system, mode);
    simulation.run_until(0.1);
  } catch (const SolverError& error) {
    const std::string_view what = error.what();
    EXPECT_LE(what.size(), longest_message) << what;
    EXPECT_TRUE(has_whole_characters(what)) << what;
    EXPECT_FALSE(error.failure().parts.empty()) << what;
    return true;
  }
  return false;
}

void run(std::uint64_t seeds) {
  int event_driven = 0, stepped = 0;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    SCOPED_TRACE(seed);
    const System system = pressed_row(seed);
    event_driven += fails(system, EventDriven{.record_events = false}) ? 1 : 0;
    stepped += fails(system, TimeStepping{.step = 2e-3}) ? 1 : 0;
  }
  EXPECT_GT(event_driven + stepped, 0);
  testing::Test::RecordProperty("event_driven", std::to_string(event_driven));
  testing::Test::RecordProperty("stepped", std::to_string(stepped));
}

TEST(MessageLength, OfRowsThatArePressed) { run(8); }
TEST(MessageLengthLong, OfRowsThatArePressed) { run(100); }

// Of a contact problem of thirty contacts the message names three, the failure all.
TEST(MessageLength, ThreePartsAreNamedAndTheOthersCounted) {
  const std::vector<std::string> names(30, "polygon #1 (feature 1) of rigid body #1 on half-plane #0");
  EXPECT_TRUE(listed(names).ends_with(" and 27 more"));
  EXPECT_LT(listed(names).size(), 250U);
}

TEST(MessageLength, WorstIsNamedFirst) {
  EXPECT_EQ(listed(worst_first({"a", "b", "c", "d"}, 2)), "c, a, b and 1 more");
  EXPECT_EQ(listed(worst_first({"a", "b"}, -1)), "a, b");
  EXPECT_EQ(listed(worst_first({"a", "b"}, 7)), "a, b");
}

TEST(MessageLength, LongTextsLoseTheirMiddle) {
  EXPECT_EQ(shortened("short", 16), "short");
  const std::string text = shortened("begin " + std::string(1000, '-') + " end", 100);
  EXPECT_EQ(text.size(), 100U);
  EXPECT_TRUE(text.starts_with("begin "));
  EXPECT_TRUE(text.ends_with(" end"));
  std::string umlauts;
  for (int i = 0; i < 500; ++i) umlauts += "\xC3\xA4";
  for (std::size_t most = 16; most < 40; ++most) {
    EXPECT_LE(shortened(umlauts, most).size(), most);
    EXPECT_TRUE(has_whole_characters(shortened(umlauts, most)));
  }
  const SolverError error(std::string(2000, 'x'), {});
  EXPECT_EQ(std::string_view(error.what()).size(), longest_message);
}

}  // namespace
