// The page docs/events.md: the code it shows, the names it explains, and what it and docs/method.md claim.

#include <carom/carom.h>

#include "examples/scenes/shaker.h"
#include "tests/page_blocks.h"
#include "tests/temporary_folder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iostream>
#include <regex>
#include <sstream>
#include <string>

using namespace carom;
using namespace carom::planar;

// The page shows from here...
System bouncing_bar() {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.set_default_law(Surface{.friction = 0.1, .normal_restitution = 0.7, .tangential_restitution = 0.7});
  system.add(HalfPlane{.normal = incline(0.1)}, "plane");
  const BodyId bar = system.add(
      RigidBody{.mass = rod(2.0, 2.0), .position = {0.0, 2.0}, .angle = 0.3, .velocity = {1.0, 0.0}}, "bar");
  system.add(Segment{.body = bar, .from = {0.0, -1.0}, .to = {0.0, 1.0}}, "bar");
  return system;
}

void tell_what_happens(std::ostream& out, const std::string& file) {
  Simulation simulation(bouncing_bar(), EventDriven{.relative_tolerance = 1e-10, .interval = 0.02});
  simulation.run_until(4.0);
  for (const EventRecord& event : simulation.events()) {
    out << event.time << " s: " << to_string(event.kind) << ", " << simulation.name(event) << ", "
        << to_string(event.mode) << ", P_n = " << event.impulse[0] << " N s\n";
  }
  out << simulation.energy();
  simulation.write_events(file);
}
// ... to here, and from here...
void compare_modes(std::ostream& out) {
  CrossCheckOptions options;
  options.end = 1.5;
  options.steps = spread_steps(8e-3, 2.5e-4, 10);
  out << cross_check(bouncing_bar(), options);
}
// ... to here, and from here...
void step_then_follow_events(Simulation& simulation) {
  simulation.switch_to(TimeStepping{.step = 1e-3});
  simulation.run_until(3.0);
  simulation.switch_to(EventDriven{});
  std::cout << "moved out of obstacles by at most " << simulation.report().projected << " m, took "
            << simulation.energy().flow(EnergyFlow::mode_switch) << " J\n";
  simulation.run_until(4.0);
}
// ... to here.

namespace {

using carom_test::text_of;

const std::string page = "docs/events.md";

TEST(EventsPage, ShowsWhatIsTestedHere) {
  const std::string source = text_of("tests/integrators/events_page_test.cpp");
  const auto blocks = carom_test::code_blocks(page, "cpp");
  for (const std::string& block : blocks) EXPECT_NE(source.find(block), std::string::npos) << block;
  EXPECT_EQ(blocks.size(), 3U);
}

TEST(EventsPage, NamesEveryKindOfEvent) {
  const std::string text = text_of(page);
  for (std::size_t kind = 0; kind < event_kind_count; ++kind) {
    const std::string name(to_string(static_cast<EventKind>(kind)));
    EXPECT_NE(text.find("| " + name + " |"), std::string::npos) << name;
  }
}

TEST(EventsPage, NamesEveryOptionAndMethod) {
  const std::string text = text_of(page);
  const auto expect_all = [&](const std::string& header, const std::string& begin, const std::regex& member) {
    const std::string source = text_of(header);
    const std::size_t from = source.find(begin);
    const std::string part = source.substr(from, source.find("\n};", from) - from);
    int count = 0;
    for (std::sregex_iterator at(part.begin(), part.end(), member), end; at != end; ++at, ++count) {
      EXPECT_NE(text.find("`" + at->str(1) + "`"), std::string::npos) << at->str(1);
    }
    return count;
  };
  EXPECT_EQ(
      expect_all("integrators/run/event_driven.h", "struct EventDriven {",
                 std::regex(R"(\n  (?:double|bool|EventRecords|FlowMethod|std::int64_t|std::string) (\w+))")),
      14);
  EXPECT_EQ(expect_all("integrators/flow/flow_method.h", "enum class FlowMethod",
                       std::regex(R"(\n  (\w+),? +///<)")),
            4);
}

TEST(EventsPage, TheProgramRuns) {
  const carom_test::TemporaryFolder folder;
  std::ostringstream out;
  tell_what_happens(out, folder / "events.csv");
  EXPECT_NE(out.str().find("impact, "), std::string::npos);
  EXPECT_NE(out.str().find("closing, "), std::string::npos);
  const std::string table = folder.text_of("events.csv"), text = text_of(page);
  // The page explains every column.
  std::istringstream head(table.substr(0, table.find('\n')));
  for (std::string column; std::getline(head, column, ',');) {
    EXPECT_NE(text.find("`" + column + "`"), std::string::npos) << column;
  }
}

TEST(EventsPage, TheModesAreCompared) {
  std::ostringstream out;
  compare_modes(out);
  const std::string text = text_of(page);
  // Steps do not depend on rounding, errors may in their last digit.
  std::istringstream lines(out.str());
  int levels = 0;
  for (std::string line; std::getline(lines, line);) {
    const std::string step = line.substr(0, 10);
    if (step.find("0.0") == std::string::npos) continue;
    EXPECT_NE(text.find(step), std::string::npos) << step;
    ++levels;
  }
  EXPECT_EQ(levels, 10);
}

TEST(EventsPage, TheModeIsSwitched) {
  Simulation simulation(bouncing_bar(), EventDriven{});
  step_then_follow_events(simulation);
  EXPECT_EQ(simulation.time(), 4.0);
  EXPECT_NEAR(simulation.energy().residual(), 0.0, 1e-8);
}

// docs/method.md: the sums of impulses do not know of the restitution.
TEST(MethodPage, CaptureSpeedDoesNotChangeWhereSlidingLeads) {
  const auto place = [](double capture_speed) {
    System system;
    system.add(Gravity{{0.0, -9.81}});
    system.set_default_law(Surface{.friction = 0.02, .normal_restitution = 0.5});
    system.add(HalfPlane{.normal = {0.0, 1.0}});
    const BodyId ball =
        system.add(RigidBody{.mass = disc(1.0, 0.1), .position = {0.0, 0.2}, .velocity = {3.0, 0.0}});
    system.add(Disc{.body = ball, .radius = 0.1});
    Simulation simulation(system, EventDriven{.relative_tolerance = 1e-12,
                                              .absolute_tolerance = 1e-13,
                                              .capture_speed = capture_speed});
    simulation.run_until(1.0);
    return simulation.state().position(ball)[0];
  };
  const double limit = place(1e-6);
  // It slides all the time. Gap and normal velocity at the end say: the moments of all normal impulses are
  // those of gravity, less the height that it fell.
  EXPECT_NEAR(limit, 3.0 - 0.02 * (0.5 * 9.81 - 0.1), 1e-12);
  for (const double speed : {1e-4, 1e-2, 1e-1}) EXPECT_NEAR(place(speed), limit, 1e-13) << speed;
}

// docs/method.md: looking changes nothing.
TEST(MethodPage, LookingDoesNotChangeTheRun) {
  System shaken;
  scenes::add_shaker(shaken, {});
  for (const System& system : {bouncing_bar(), shaken}) {
    for (const FlowMethod method :
         {FlowMethod::explicit_runge_kutta, FlowMethod::one_step, FlowMethod::adams, FlowMethod::bdf}) {
      Simulation often(system, EventDriven{.method = method, .interval = 3e-3});
      Simulation once(system, EventDriven{.method = method, .interval = 10.0});
      often.run_until(1.5);
      once.run_until(1.5);
      EXPECT_EQ(often.state().q, once.state().q);
      EXPECT_EQ(often.state().v, once.state().v);
    }
  }
}

}  // namespace
