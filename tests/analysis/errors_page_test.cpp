// The page docs/errors.md: the code that it shows, the messages that it explains.

#include <carom/carom.h>

#include "tests/model_error.h"
#include "tests/page_blocks.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <variant>
#include <vector>

using namespace carom;
using namespace carom::planar;

namespace {

// The page shows these.
void run_unless_stopped(Simulation& simulation, double end, const std::stop_token& token) {
  simulation.stop_when([token] { return token.stop_requested(); });
  simulation.run_until(end);  // or throws Cancelled: simulation.time() tells how far it came
}

void run_with_shorter_steps(Simulation& simulation, double end) {
  while (simulation.time() < end) {
    try {
      simulation.run_until(end);
    } catch (const SolverError& error) {
      const double step = error.failure().suggested_step;
      if (!(step > 0.0)) throw;  // shorter steps would not help
      TimeStepping options = std::get<TimeStepping>(simulation.mode());
      options.step = step;
      simulation.switch_to(options);  // from the last good state
    }
  }
}
// The page shows until here.

using carom_test::text_of;

TEST(ErrorsPage, ShowsWhatIsTestedHere) {
  const std::string source = text_of("tests/analysis/errors_page_test.cpp");
  const std::vector<std::string> blocks = carom_test::code_blocks("docs/errors.md", "cpp");
  EXPECT_EQ(blocks.size(), 2U);
  for (const std::string& block : blocks) EXPECT_NE(source.find(block), std::string::npos) << block;
}

System strut(double stiffness) {
  System system;
  const BodyId left = system.add(Particle{.mass = 1.0}, "left");
  const BodyId right = system.add(Particle{.mass = 1.0, .position = {1.1, 0.0}}, "right");
  system.add(SpringDamper{.from = left, .to = right, .stiffness = stiffness, .free_length = 1.0}, "strut");
  return system;
}

TEST(ErrorsPage, StepsBecomeShorterUntilTheySucceed) {
  Simulation simulation(strut(1e6), TimeStepping{.step = 1e-2, .iteration = Iteration::fixed_point});
  EXPECT_THROW(simulation.step(), SolverError);
  EXPECT_EQ(simulation.time(), 0.0);  // it stands where it stood
  run_with_shorter_steps(simulation, 0.02);
  EXPECT_EQ(simulation.time(), 0.02);
  EXPECT_LT(std::get<TimeStepping>(simulation.mode()).step, 1e-3);
  std::stop_source source;
  source.request_stop();
  EXPECT_THROW(run_unless_stopped(simulation, 0.1, source.get_token()), Cancelled);
}

/// A ball over a floor with or without a law.
System ball_over_floor(double height, const std::optional<Surface>& surface) {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.add(Particle{.mass = 1.0, .position = {0.0, height}}, "ball");
  const HalfPlane floor{.normal = {0.0, 1.0}};
  surface ? system.add(floor, *surface, "floor") : system.add(floor, "floor");
  return system;
}

/// A pinned bar that is described with a spin but its centre at rest.
System contradictory_bar() {
  System system;
  const BodyId bar = system.add(RigidBody{.mass = rod(1.0, 1.0), .position = {0.5, 0.0}, .spin = 1.0}, "bar");
  system.add(Revolute{.from = ground, .to = {bar, {-0.5, 0.0}}}, "axle");
  system.keep_place(bar);
  return system;
}

/// A body that strikes a rough floor with a corner; its restitutions, of 1 and 0, add energy.
System gaining() {
  System system;
  system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 1.0, .normal_restitution = 1.0});
  const BodyId body = system.add(
      RigidBody{.mass = {.mass = 1.0, .inertia = 1.0}, .position = {1.0, 1.0}, .velocity = {1.0, -2.0}});
  system.add(Point{.body = body, .position = {-1.0, -1.0}});
  return system;
}

System blown_up() {
  System system = ball_over_floor(1.0, Surface{.friction = 0.0, .normal_restitution = 0.0});
  system.add(AppliedForce{.on = system.body("ball"),
                          .force = [](double time) { return Vec<2>(0.0, 1.0 / (time < 0.1 ? 1.0 : 0.0)); }},
             "wind");
  return system;
}

TEST(ErrorsPage, CommonFailuresSayWhatItSays) {
  const Surface hard{.friction = 0.0, .normal_restitution = 1.0};
  const auto run = [](const System& system, const Mode& mode) {
    Simulation simulation(system, mode);
    simulation.run_until(4.0);
  };
  const std::vector<std::pair<std::string, std::function<void()>>> failures{
      {"law is not given", [&] { run(ball_over_floor(1.0, {}), TimeStepping{}); }},
      {"is -0.1 m at the start", [&] { run(ball_over_floor(-0.1, hard), EventDriven{}); }},
      {"cannot be kept closed", [&] { run(contradictory_bar(), EventDriven{}); }},
      {"cannot be removed",
       [&] {
         System system = strut(1.0);
         system.remove(system.body("left"));
       }},
      {"is not in this model",
       [&] {
         Simulation simulation(strut(1.0), TimeStepping{});
         static_cast<void>(simulation.state().position(strut(1.0).body("left")));
       }},
      {"does not contract",
       [&] { run(strut(1e6), TimeStepping{.step = 1e-2, .iteration = Iteration::fixed_point}); }},
      {"are not finite", [&] { run(blown_up(), TimeStepping{}); }},
      {"impact_rules.energy_gain",
       [&] { run(gaining(), TimeStepping{.impact_rules = {.energy_gain = EnergyGain::refuse}}); }},
      {"events per second", [&] { run(ball_over_floor(1e-5, hard), EventDriven{.event_limit = 100.0}); }},
      {"at the smallest step",
       [&] {
         TimeStepping controlled{.step = 1e-3};
         controlled.control = StepControl{.tolerance = 1e-15, .smallest = 1e-3};
         run(strut(1e3), controlled);
       }},
  };
  const std::string page = text_of("docs/errors.md");
  for (const auto& [text, failure] : failures) {
    EXPECT_NE(page.find("| `" + text + "`"), std::string::npos) << text;
    try {
      failure();
      ADD_FAILURE() << "nothing was thrown: " << text;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(text), std::string::npos) << error.what();
    }
  }
}

TEST(ErrorsPage, OwnExceptionsComeOutUnchanged) {
  struct Mine {};
  for (const Mode& mode : {Mode(TimeStepping{}), Mode(EventDriven{})}) {
    System system = ball_over_floor(1.0, {});
    system.remove(system.obstacle("floor"));
    const BodyId ball = system.body("ball");
    bool broken = false;
    system.add(AppliedForce{.on = ball, .force = [&](double) {
                              if (broken) throw Mine();
                              return Vec<2>(0.0, 0.0);
                            }});
    Simulation simulation(system, mode);
    simulation.run_until(0.1);
    const State before = simulation.state();
    broken = true;
    EXPECT_THROW(simulation.run_until(0.5), Mine);
    EXPECT_EQ(simulation.time(), 0.1);
    EXPECT_EQ(simulation.state().q, before.q);
    broken = false;
    bool watched = true;
    simulation.observe([&](const Simulation&) {
      if (watched) throw Mine();
    });
    EXPECT_THROW(simulation.step(), Mine);
    EXPECT_GT(simulation.time(), 0.1);  // the step stays
    watched = false;
    simulation.run_until(0.5);
    EXPECT_NEAR(simulation.state().position(ball)[1], 1.0 - 0.5 * 9.81 * 0.25, 1e-9);
  }
}

TEST(ErrorsPage, MessagesAreAsShown) {
  const std::vector<std::string> shown = carom_test::code_blocks("docs/errors.md", "text");
  ASSERT_EQ(shown.size(), 2U);
  System system;
  EXPECT_MODEL_ERROR(system.add(Particle{.mass = -1.0}, "ball"), shown[0].substr(0, shown[0].size() - 1));
  Simulation simulation(strut(1e6), TimeStepping{.step = 1e-2, .iteration = Iteration::fixed_point});
  try {
    simulation.step();
    ADD_FAILURE() << "nothing was thrown";
  } catch (const SolverError& error) {
    std::string one_line = shown[1];
    for (std::size_t at; (at = one_line.find('\n')) != std::string::npos;) one_line.replace(at, 1, " ");
    const std::string end = one_line.substr(one_line.find("limited most by"));
    EXPECT_NE((std::string(error.what()) + " ").find(end), std::string::npos) << error.what();
    EXPECT_EQ(error.failure().parts.front(), "spring-damper 'strut'");
  }
}

}  // namespace
