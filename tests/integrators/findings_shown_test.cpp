// Findings of a model are seen without asking: on the standard error stream, once for every model, unless the
// user has taken the log.

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

/// Two discs above a floor that has the only law.
System ghosts() {
  System system;
  system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.3, .normal_restitution = 0.5});
  for (const double height : {1.0, 2.0}) {
    const BodyId body = system.add(RigidBody{.mass = disc(1.0, 0.1), .position = {0.0, height}});
    system.add(Disc{.body = body, .radius = 0.1});
  }
  return system;
}

template <class F>
std::string shown(F&& run) {
  testing::internal::CaptureStderr();
  run();
  return testing::internal::GetCapturedStderr();
}

std::size_t count(const std::string& text, std::string_view part) {
  std::size_t found = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

TEST(FindingsShown, OnceByTheFirstStepInBothModes) {
  for (const Mode& mode : {Mode(TimeStepping{}), Mode(EventDriven{})}) {
    Simulation simulation(ghosts(), mode);
    const std::string text = shown([&] {
      simulation.step();
      simulation.run_until(0.1);
    });
    EXPECT_EQ(count(text, "carom: contact without a law: disc #0 and another one"), 1U) << text;
    // An edit that leaves the finding as it was does not show it again; one with another finding does.
    const auto edit_and_run = [&](double time, const auto& change) {
      return shown([&] {
        simulation.edit(change);
        simulation.run_until(time);
      });
    };
    EXPECT_EQ(edit_and_run(0.2, [](System& system) { system.add(Gravity{{0.0, -1.0}}); }), "");
    const std::string other = edit_and_run(0.3, [](System& system) {
      system.remove(system.shapes().front());
      system.add(Disc{.body = system.bodies().front(), .radius = 0.1});
    });
    EXPECT_EQ(count(other, "disc #1 and another one"), 1U) << other;
  }
}

TEST(FindingsShown, NotOfAModelWithoutOne) {
  System system = ghosts();
  system.set_default_law(Surface{.friction = 0.3, .normal_restitution = 0.5});
  Simulation simulation(system, EventDriven{});
  EXPECT_EQ(shown([&] { simulation.run_until(0.1); }), "");
}

TEST(FindingsShown, InTheLogOfWhoeverTookIt) {
  std::vector<std::string> lines;
  Simulation simulation(ghosts(), TimeStepping{});
  simulation.log() = Log([&](LogLevel, std::string_view line) { lines.emplace_back(line); });
  EXPECT_EQ(shown([&] { simulation.run_until(0.1); }), "");
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines.front().find("contact without a law: "), 0U) << lines.front();
  Simulation quiet(ghosts(), TimeStepping{});
  quiet.log() = Log();
  EXPECT_EQ(shown([&] { quiet.run_until(0.1); }), "");
}

}  // namespace
