// The pages docs/modelling.md, contact_law.md, energy.md and two_modes.md: the code they show, the
// names they explain, what they claim.

#include <carom/carom.h>

#include "tests/model_error.h"
#include "tests/page_blocks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <sstream>
#include <string>
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
  system.set_default_law(Surface{.friction = 1.0,
                                 .normal_restitution = normal_restitution,
                                 .tangential_restitution = tangential_restitution});
  system.add(HalfPlane{.normal = {0.0, 1.0}});
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

// The pages show until here.

using carom_test::text_of;

TEST(ConceptPages, ShowWhatIsTestedHere) {
  const std::string source = text_of("tests/analysis/concept_pages_test.cpp");
  std::size_t count = 0;
  for (const char* page : {"modelling", "contact_law", "energy", "two_modes"}) {
    for (const std::string& block : carom_test::code_blocks("docs/" + std::string(page) + ".md", "cpp")) {
      EXPECT_NE(source.find(block), std::string::npos) << page << ":\n" << block;
      ++count;
    }
  }
  EXPECT_EQ(count, 8U);
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
  system.set_default_law(Surface{.friction = 0.3, .normal_restitution = 0.3});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, "floor");
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
  system.set_default_law(Surface{.friction = 0.3, .normal_restitution = 0.5});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, "floor");
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

}  // namespace
