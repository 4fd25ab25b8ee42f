// The pages docs/modelling.md, contact_law.md, energy.md, two_modes.md and errors.md: the code they show, the
// names they explain, what they claim.

#include <carom/carom.h>

#include "tests/model_error.h"
#include "tests/page_blocks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>
#include <optional>
#include <sstream>
#include <stop_token>
#include <string>
#include <utility>
#include <variant>
#include <vector>

using namespace carom;
using namespace carom::planar;

namespace {

// The pages show these.
System curling() {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  const MaterialId ice = system.material("ice"), granite = system.material("granite");
  system.between(granite, ice, Surface{.friction = 0.01, .normal_restitution = 0.1});
  system.between(system.material("rubber"), ice, Surface{.friction = 0.5, .normal_restitution = 0.0});

  system.add(HalfPlane{.normal = {0.0, 1.0}, .material = ice}, "sheet");
  const BodyId stone = system.add(
      RigidBody{.mass = box(19.0, 0.28, 0.12), .position = {0.0, 0.06}, .velocity = {2.0, 0.0}}, "stone");
  system.add(Segment{.body = stone, .from = {-0.07, -0.06}, .to = {0.07, -0.06}, .material = granite});
  return system;
}

System mill() {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.set_default_law(Surface{.friction = 0.4, .normal_restitution = 0.1});
  for (const Wall& wall : hopper({0.0, 1.2}, 0.3, 1.0, 0.5, 0.02)) system.add(wall);
  system.add(stairs({-2.6, 0.8}, 3, 0.4, -0.2), "stairs");
  system.add(Peg{.centre = {0.4, 0.7}, .radius = 0.05}, "peg");
  system.add(HalfPlane{.normal = {0.0, 1.0}, .surface_speed = 0.5}, "belt");
  const BodyId grain = system.add(RigidBody{.mass = disc(0.1, 0.05), .position = {0.1, 1.6}}, "grain");
  system.add(Disc{.body = grain, .radius = 0.05});
  return system;
}

System bar_on_steps() {
  constexpr ContactFilter lower{.groups = 1, .touches = 1}, upper{.groups = 2, .touches = 2};
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.set_default_law(Surface{.friction = 0.8, .normal_restitution = 0.0});
  system.add(HalfPlane{.normal = {0.0, 1.0}, .filter = lower}, "lower step");
  system.add(HalfPlane{.point = {0.0, 0.5}, .normal = {0.0, 1.0}, .filter = upper}, "upper step");
  const BodyId bar = system.add(RigidBody{.mass = rod(1.0, 2.0), .position = {0.0, 1.0}}, "bar");
  system.add(Point{.body = bar, .position = {-1.0, 0.0}, .filter = lower});
  system.add(Point{.body = bar, .position = {1.0, 0.0}, .filter = upper});
  return system;
}

BodyId add_hammer(System& system, const Vec<2>& place) {
  // Described with the middle of the handle at the origin.
  const MassProperties<2> parts = compose({rod(0.3, 0.4), shifted(box(0.8, 0.04, 0.12), {0.2, 0.0})});
  const BodyId hammer =
      system.add(RigidBody{.mass = centred(parts), .position = place + parts.centre}, "hammer");
  system.add(Point{.body = hammer, .position = Vec<2>(-0.2, 0.0) - parts.centre}, "end of the handle");
  system.add(Polygon{.body = hammer,
                     .vertices = {Vec<2>(0.18, -0.06) - parts.centre, Vec<2>(0.22, -0.06) - parts.centre,
                                  Vec<2>(0.22, 0.06) - parts.centre, Vec<2>(0.18, 0.06) - parts.centre}},
             "head");
  return hammer;
}

void list_findings(const System& system, std::ostream& out) {
  for (const ModelFinding& finding : system.check()) {
    out << to_string(finding.kind) << ": " << finding.text << "\n";
  }
}

void cut_the_rope(Simulation& simulation) {
  simulation.edit([](System& system) { system.remove(system.element("rope")); });
}

System strikes_at_its_corner(double normal_restitution, double tangential_restitution) {
  System system;
  system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 1.0,
                                                      .normal_restitution = normal_restitution,
                                                      .tangential_restitution = tangential_restitution});
  const BodyId body = system.add(
      RigidBody{.mass = {.mass = 1.0, .inertia = 1.0}, .position = {1.0, 1.0}, .velocity = {1.0, -2.0}});
  system.add(Point{.body = body, .position = {-1.0, -1.0}}, "corner");
  return system;
}

void where_did_it_go(std::ostream& out, const EnergyLedger& energy) {
  const double struck = energy.flow(EnergyFlow::impact_normal) + energy.flow(EnergyFlow::impact_tangential);
  out << struck << " J of " << energy.initial() << " J were lost in impacts, "
      << energy.flow(EnergyFlow::sliding) << " J in sliding\n";
  if (std::abs(energy.residual()) > 1e-12 * energy.scale()) {  // in time stepping
    throw std::logic_error("the ledger does not close");
  }
}

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
// The pages show until here.

using carom_test::text_of;

TEST(ConceptPages, ShowWhatIsTestedHere) {
  const std::string source = text_of("tests/analysis/concept_pages_test.cpp");
  std::size_t count = 0;
  for (const char* page : {"modelling", "contact_law", "energy", "two_modes", "errors"}) {
    for (const std::string& block : carom_test::code_blocks("docs/" + std::string(page) + ".md", "cpp")) {
      EXPECT_NE(source.find(block), std::string::npos) << page << ":\n" << block;
      ++count;
    }
  }
  EXPECT_EQ(count, 10U);
}

// docs/modelling.md

TEST(ModellingPage, TheLawIsThatOfTheMaterials) {
  const System system = curling();
  const BodyId stone = system.body("stone");
  for (const Mode& mode : {Mode(TimeStepping{}), Mode(EventDriven{})}) {
    Simulation simulation(system, mode);
    simulation.run_until(1.0);
    // It slides with mu = 0.01, in time stepping perhaps not in the first of a thousand steps.
    EXPECT_NEAR(simulation.state().velocity(stone)[0], 2.0 - 0.01 * 9.81, 1e-3 * 0.01 * 9.81);
  }
}

TEST(ModellingPage, FindsTheLawOfRubber) {
  std::ostringstream out;
  list_findings(curling(), out);
  EXPECT_EQ(
      out.str(),
      "law without effect: surface between 'ice' and 'rubber': an obstacle is of 'ice', but nothing that "
      "can touch it is of 'rubber'\n");
  const std::string page = text_of("docs/modelling.md");
  for (const char* const name :
       {"law_without_effect", "contact_without_law", "touches_nothing", "untouched_obstacle",
        "body_without_shape", "keep_without_joint", "hidden_by_filter"}) {
    EXPECT_NE(page.find("| `" + std::string(name) + "` |"), std::string::npos) << name;
  }
}

// It rolls out of the hopper and leaves with the belt.
TEST(ModellingPage, TheGrainComesToTheBelt) {
  const System system = mill();
  for (const Mode& mode : {Mode(TimeStepping{}), Mode(EventDriven{})}) {
    Simulation simulation(system, mode);
    simulation.run_until(6.0);
    EXPECT_NEAR(simulation.state().position(system.body("grain"))[1], 0.05, 1e-3);
    EXPECT_GT(simulation.energy().flow(EnergyFlow::external), 0.0);
  }
}

TEST(ModellingPage, TheBarRestsOnTwoSteps) {
  const System system = bar_on_steps();
  EXPECT_TRUE(system.check().empty());
  Simulation simulation(system, EventDriven{});
  simulation.run_until(2.0);
  EXPECT_NEAR(simulation.state().position(system.body("bar"))[1], 0.25, 1e-8);
  EXPECT_NEAR(simulation.state().angle(system.body("bar")), std::asin(0.25), 1e-8);
}

TEST(ModellingPage, TheHammerIsWhereItWasDescribed) {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.3, .normal_restitution = 0.3}, "floor");
  const BodyId hammer = add_hammer(system, {0.0, 1.0});
  system.add(Cable{.from = {ground, {0.0, 3.0}}, .to = hammer, .stiffness = 1e3, .free_length = 1.9}, "rope");
  Simulation simulation(system, TimeStepping{});
  // 0.8 kg at 0.2 m and 0.3 kg at 0.
  EXPECT_NEAR(simulation.state().position(hammer)[0], 0.8 * 0.2 / 1.1, 1e-15);
  simulation.run_until(0.01);  // it was stretched from the start
  const double held = simulation.energy().stored(StoredEnergy::elastic);
  EXPECT_GT(held, 0.0);
  cut_the_rope(simulation);
  EXPECT_EQ(simulation.energy().stored(StoredEnergy::elastic), 0.0);
  EXPECT_DOUBLE_EQ(simulation.energy().flow(EnergyFlow::intervention), -held);
  EXPECT_EQ(simulation.system().name(hammer), "rigid body 'hammer'");
}

TEST(ModellingPage, NamesEveryShapeAndObstacle) {
  const std::string page = text_of("docs/modelling.md");
  for (const char* name :
       {"Particle",     "RigidBody", "Point",        "Disc",       "Segment",  "Polygon",
        "HalfPlane",    "Wall",      "Block",        "Peg",        "Terrain",  "BoxInside",
        "CircleInside", "stairs",    "hopper",       "drum",       "open_box", "surface_speed",
        "disc",         "ring",      "solid_sphere", "thin_shell", "rod",      "box",
        "polygon",      "compose",   "shifted",      "centred",    "to_dot",   "keep_place",
        "ContactFilter"}) {
    EXPECT_NE(page.find("`" + std::string(name) + "`"), std::string::npos) << name;
  }
}

// docs/contact_law.md

TEST(ContactLawPage, UnequalCoefficientsGainEnergyAsItSays) {
  struct Row {
    double normal, tangential, part;
  };
  for (const Row& row :
       {Row{1.0, 0.0, 2.0 / 15.0}, Row{1.0, 0.5, 1.0 / 30.0}, Row{1.0, 1.0, 0.0}, Row{0.5, 0.5, -0.3}}) {
    Simulation simulation(strikes_at_its_corner(row.normal, row.tangential), EventDriven{});
    simulation.step();
    const EnergyLedger& energy = simulation.energy();
    EXPECT_NEAR(energy.total() / energy.initial() - 1.0, row.part, 1e-14);
    EXPECT_NEAR(simulation.report().energy_gain, std::max(row.part, 0.0) * energy.initial(), 1e-14);
  }
  Simulation refused(strikes_at_its_corner(1.0, 0.0),
                     EventDriven{.impact_rules = {.energy_gain = EnergyGain::refuse}});
  EXPECT_THROW(refused.step(), SolverError);
}

TEST(ContactLawPage, ABlockThatFallsFlatRisesFlat) {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.3, .normal_restitution = 0.5}, "floor");
  const BodyId block = system.add(RigidBody{.mass = box(1.0, 0.4, 0.2), .position = {0.0, 0.2}}, "block");
  system.add(Segment{.body = block, .from = {-0.2, -0.1}, .to = {0.2, -0.1}});
  Simulation simulation(system, EventDriven{});
  const double fall = std::sqrt(0.2 / 9.81);
  simulation.run_until(1.5 * fall);  // the top of the flight after the impact
  EXPECT_NEAR(simulation.state().velocity(block)[1], 0.0, 1e-8);
  EXPECT_NEAR(simulation.state().position(block)[1], 0.1 + 0.25 * 0.1, 1e-8);
  EXPECT_NEAR(simulation.state().spin(block), 0.0, 1e-12);
}

// docs/energy.md

TEST(EnergyPage, ExplainsEveryLine) {
  const std::string page = text_of("docs/energy.md");
  for (std::size_t i = 0; i < stored_energy_count; ++i) {
    const std::string name(to_string(static_cast<StoredEnergy>(i)));
    EXPECT_NE(page.find("`" + name + "`"), std::string::npos) << name;
  }
  for (std::size_t i = 0; i < energy_flow_count; ++i) {
    const std::string name(to_string(static_cast<EnergyFlow>(i)));
    EXPECT_NE(page.find("| `" + name + "` |"), std::string::npos) << name;
  }
}

TEST(EnergyPage, TheAccountIsRead) {
  Simulation simulation(curling(), TimeStepping{});
  simulation.run_until(1.0);
  std::ostringstream out;
  where_did_it_go(out, simulation.energy());
  EXPECT_NE(out.str().find("J were lost in impacts"), std::string::npos);
}

// docs/errors.md

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
       [&] {
         run(strikes_at_its_corner(1.0, 0.0),
             TimeStepping{.impact_rules = {.energy_gain = EnergyGain::refuse}});
       }},
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
