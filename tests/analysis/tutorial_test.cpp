// The page docs/tutorial.md: its programs, what they print, and why those numbers are right.

#include <carom/carom.h>

#include "tests/page_blocks.h"
#include "tests/temporary_folder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <numbers>
#include <sstream>
#include <string>

using namespace carom;
using namespace carom::planar;

namespace {

// The page shows these.
System floor_with_gravity() {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.set_default_law(Surface{.friction = 0.5, .normal_restitution = 0.6});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, "floor");
  return system;
}

void drop_a_ball(std::ostream& out) {
  System system = floor_with_gravity();
  system.add(Particle{.mass = 1.0, .position = {0.0, 1.0}}, "ball");

  Simulation simulation(system, EventDriven{});
  simulation.run_until(2.0);
  for (const EventRecord& event : simulation.events()) {
    out << event.time << " s: " << to_string(event.kind) << " of " << simulation.name(event) << ", "
        << event.velocity_before[0] << " -> " << event.velocity_after[0] << " m/s\n";
  }
  out << simulation.energy();
}

void throw_a_disc(std::ostream& out) {
  System system = floor_with_gravity();
  const BodyId wheel = system.add(RigidBody{.mass = disc(1.0, 0.1),
                                            .position = {0.0, 1.1},
                                            .velocity = {2.0, 0.0},
                                            .spin = 60.0});  // counter-clockwise: backspin
  system.add(Disc{.body = wheel, .radius = 0.1}, "disc");

  Simulation simulation(system, EventDriven{});
  simulation.run_until(3.0);
  const EventRecord& first = simulation.events().front();
  out << first.time << " s: " << to_string(first.mode) << ", impulse " << first.impulse[0] << " N s normal, "
      << first.impulse[1] << " N s tangential\n";
  const State& state = simulation.state();
  out << state.time << " s: at " << state.position(wheel)[0] << " m, " << state.velocity(wheel)[0] << " m/s, "
      << state.spin(wheel) << " rad/s\n";
}

constexpr double slope = 0.3;  // [rad]

System block_on_incline() {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.set_default_law(Surface{.friction = 0.2, .normal_restitution = 0.0});
  system.add(HalfPlane{.normal = incline(slope)}, "incline");
  const BodyId block = system.add(
      RigidBody{.mass = box(2.0, 0.4, 0.2), .position = 0.1 * incline(slope), .angle = slope}, "block");
  system.add(Polygon{.body = block, .vertices = {{-0.2, -0.1}, {0.2, -0.1}, {0.2, 0.1}, {-0.2, 0.1}}},
             "block");
  return system;
}

void slide_down(std::ostream& out) {
  Simulation simulation(block_on_incline(), TimeStepping{.step = 1e-4});
  simulation.run_until(1.0);
  const BodyId block = simulation.system().body("block");
  out << "slid " << (simulation.state().position(block) - 0.1 * incline(slope)).norm() << " m\n";
  const StepReport& report = simulation.report();
  for (const ContactRecord& contact : report.contacts) {
    out << simulation.name(contact.key) << ": " << to_string(contact.mode) << ", "
        << contact.impulse[0] / report.step << " N normal, " << contact.impulse[1] / report.step
        << " N tangential\n";
  }
}

void hang_on_a_spring(std::ostream& out) {
  System system = block_on_incline();
  const BodyId block = system.body("block");
  const Vec<2> uphill(std::cos(slope), std::sin(slope)), start = 0.1 * incline(slope);
  system.add(SpringDamper{.from = {ground, start + 1.2 * uphill},
                          .to = {block, {0.2, 0.0}},
                          .stiffness = 200.0,
                          .damping = 2.0,
                          .free_length = 1.0},
             "spring");

  Simulation simulation(system, TimeStepping{.step = 1e-3});
  simulation.run_until(2.0);
  const double way = (start - simulation.state().position(block)).dot(uphill);
  out << "at rest after " << way << " m, the spring pulls with " << 200.0 * way << " N\n"
      << simulation.energy();
}

void let_swing(std::ostream& out) {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  const BodyId bar = system.add(RigidBody{.mass = rod(2.0, 1.0), .position = {0.5, 0.0}}, "bar");
  const JointId pin = system.add(Revolute{.from = ground, .to = {bar, {-0.5, 0.0}}}, "pin");

  Simulation simulation(system, EventDriven{});
  out << "degrees of freedom: " << simulation.mobility().degrees_of_freedom << "\n";
  for (const double time : {0.0, 0.25, 0.5}) {
    simulation.run_until(time);
    const JointReaction reaction = simulation.reaction(pin);
    out << time << " s: " << simulation.state().coordinate(pin) << " rad, " << simulation.state().rate(pin)
        << " rad/s, the pin pushes with " << reaction.force[0] << " N, " << reaction.force[1] << " N\n";
  }
}

System slider_crank() {
  System system;
  const BodyId crank = system.add(RigidBody{.mass = rod(1.0, 0.3),
                                            .position = {0.0, 0.15},
                                            .angle = std::numbers::pi / 2.0,
                                            .velocity = {1.5, 0.0},
                                            .spin = -10.0},
                                  "crank");
  const BodyId link =
      system.add(RigidBody{.mass = rod(0.5, 0.5), .position = {0.2, 0.15}, .angle = -std::asin(0.6)}, "link");
  const BodyId slider = system.add(RigidBody{.mass = box(1.0, 0.2, 0.1), .position = {0.4, 0.0}}, "slider");

  const JointId axle = system.add(Revolute{.from = ground, .to = {crank, {-0.15, 0.0}}}, "axle");
  system.add(Revolute{.from = {crank, {0.15, 0.0}}, .to = {link, {-0.25, 0.0}}}, "crank pin");
  system.add(Revolute{.from = {link, {0.25, 0.0}}, .to = slider}, "slider pin");
  system.add(Prismatic{.from = ground, .to = slider, .axis = {1.0, 0.0}}, "guide");
  system.keep_place(crank);

  system.set_default_law(Surface{.friction = 0.0, .normal_restitution = 0.7});
  system.add(HalfPlane{.point = {0.8, 0.0}, .normal = {-1.0, 0.0}}, "wall");
  system.add(Point{.body = slider, .position = {0.1, 0.0}}, "head");
  system.add(JointFriction{.joint = axle, .bound = 0.3}, "bearing");  // [N m]
  return system;
}

void knock_at_the_wall(std::ostream& out) {
  Simulation simulation(slider_crank(), EventDriven{});
  simulation.run_until(3.0);
  for (const EventRecord& event : simulation.events()) {
    out << event.time << " s: " << to_string(event.kind) << " of " << simulation.name(event);
    if (event.kind == EventKind::impact) out << ", P = " << event.impulse[0] << " N s";
    out << "\n";
  }
  const JointId axle = simulation.system().joint("axle");
  out << "the crank stands at " << simulation.state().coordinate(axle) << " rad\n" << simulation.energy();
}

void compare_the_modes(std::ostream& out) {
  CrossCheckOptions options;
  options.end = 0.5;
  options.steps = spread_steps(4e-3, 2.5e-4, 8);
  out << cross_check(slider_crank(), options);
}

bool record_and_go_on(const std::string& folder) {
  const TimeStepping mode{.step = 1e-3};
  Simulation simulation(slider_crank(), mode);
  const CsvRecorder recorder(simulation, folder + "/run.csv", {.every_steps = 10});
  simulation.run_until(0.5);
  simulation.save(folder + "/half.checkpoint");
  simulation.run_until(1.0);

  Simulation again(slider_crank(), mode);
  again.load(folder + "/half.checkpoint");
  again.run_until(1.0);
  return again.state().q == simulation.state().q && again.state().v == simulation.state().v;
}
// The page shows until here.

constexpr double g = 9.81;
const std::string page = "docs/tutorial.md";

using carom_test::prints;
using carom_test::text_of;

TEST(Tutorial, ShowsWhatIsTestedHere) {
  const std::string source = text_of("tests/analysis/tutorial_test.cpp");
  const auto blocks = carom_test::code_blocks(page, "cpp");
  for (const std::string& block : blocks) EXPECT_NE(source.find(block), std::string::npos) << block;
  EXPECT_EQ(blocks.size(), 8U);
}

TEST(Tutorial, PrintsWhatItSays) {
  std::size_t number = 0;
  for (const auto program : {drop_a_ball, throw_a_disc, slide_down, hang_on_a_spring, let_swing,
                             knock_at_the_wall, compare_the_modes}) {
    std::ostringstream out;
    program(out);
    EXPECT_TRUE(prints(page, number, out.str()));
    ++number;
  }
  EXPECT_EQ(carom_test::code_blocks(page, "text").size(), 7U);
}

/// The numbers of a line, found by the text before them.
double number_after(const std::string& output, const std::string& text) {
  const std::size_t at = output.find(text);
  EXPECT_NE(at, std::string::npos) << text << " in\n" << output;
  return at == std::string::npos ? std::nan("") : std::stod(output.substr(at + text.size()));
}

std::string output_of(void (*program)(std::ostream&)) {
  std::ostringstream out;
  program(out);
  return out.str();
}

// Output has six digits.
constexpr double printed = 1e-5;

TEST(Tutorial, TheBallFallsAndBounces) {
  const std::string out = output_of(drop_a_ball);
  const double fall = std::sqrt(2.0 / g);
  double time = fall, flight = 2.0 * fall;
  std::istringstream lines(out);
  int impacts = 0;
  for (std::string line; std::getline(lines, line) && line.find("impact of") != std::string::npos;) {
    EXPECT_NEAR(std::stod(line), time, printed);
    flight *= 0.6;
    time += flight;
    ++impacts;
  }
  // 0.6^k of 4.4 m/s is below the capture speed, 1e-4 m/s, from k = 21 on.
  EXPECT_EQ(impacts, 21);
  // The series ends at fall (1 + e)/(1 - e); the flights cut off last 2 * 1e-4/g/(1 - e), 5e-5 s.
  const std::size_t closing = out.rfind('\n', out.find("closing")) + 1;
  EXPECT_NEAR(std::stod(out.substr(closing)), 4.0 * fall, 5e-5 + printed);
}

TEST(Tutorial, TheDiscComesBack) {
  const std::string out = output_of(throw_a_disc);
  // It sticks: the point of contact, at 2 + 60 * 0.1 = 8 m/s, is stopped by 8/W_tt, W_tt = 3/m.
  EXPECT_NEAR(number_after(out, "normal, "), -8.0 / 3.0, printed);
  EXPECT_NEAR(number_after(out, "impulse "), 1.6 * std::sqrt(2.0 * g), printed);
  EXPECT_NEAR(number_after(out, " m, "), 2.0 - 8.0 / 3.0, printed);
  EXPECT_NEAR(number_after(out, " m/s, "), 20.0 / 3.0, printed);
}

TEST(Tutorial, TheBlockSlidesAsItShould) {
  const std::string out = output_of(slide_down);
  const double friction = 0.2 * g * std::cos(slope), acceleration = g * std::sin(slope) - friction;
  // One step of the start may pass without friction, its time lasts.
  EXPECT_NEAR(number_after(out, "slid "), 0.5 * acceleration, 1e-4 * friction + printed);
  const double near = number_after(out, "slip-, "), weight = 2.0 * g * std::cos(slope);
  const double far = number_after(out.substr(out.find("feature 1")), "slip-, ");
  EXPECT_NEAR(near + far, weight, 2e-4);  // of six digits each
  // Moments about the centre of mass, 0.1 m above the plane: friction against the difference.
  EXPECT_NEAR(0.2 * (near - far), 0.1 * 0.2 * weight, 1e-4);
}

TEST(Tutorial, TheSpringHoldsTheBlockWithTheHelpOfFriction) {
  const std::string out = output_of(hang_on_a_spring);
  const double pull = number_after(out, "pulls with "), weight = 2.0 * g;
  EXPECT_LT(std::abs(pull - weight * std::sin(slope)), 0.2 * weight * std::cos(slope));
  EXPECT_NEAR(number_after(out, "elastic "), pull * pull / 400.0, printed);
}

TEST(Tutorial, TheBarSwingsAsARod) {
  const std::string out = output_of(let_swing);
  EXPECT_NE(out.find("degrees of freedom: 1\n"), std::string::npos);
  // A rod that is let go carries a quarter of its weight in the pin.
  EXPECT_NEAR(number_after(out, "pushes with 0 N, "), 2.0 * g / 4.0, printed);
  // 3 g sin(a)/l is the square of its rate after the fall by a.
  const std::string last = out.substr(out.find("0.5 s: "));
  const double angle = number_after(last, "0.5 s: "), rate = number_after(last, "rad, ");
  EXPECT_NEAR(rate * rate, 3.0 * g * std::sin(-angle), 10.0 * printed);
}

TEST(Tutorial, TheMechanismKnocksAndStands) {
  Simulation simulation(slider_crank(), EventDriven{});
  simulation.run_until(3.0);
  const JointId axle = simulation.system().joint("axle");
  EXPECT_EQ(simulation.state().rate(axle), 0.0);
  // The head is at 0.8 m when the slider is at 0.7 m: by the law of cosines, counted from the start, upright.
  const double touch = std::acos((0.09 + 0.49 - 0.25) / (2.0 * 0.3 * 0.7));
  std::vector<double> angles;
  Simulation replay(simulation.system(), EventDriven{});
  double turned = 0.0, before = 0.0;
  for (const EventRecord& event : simulation.events()) {
    if (event.kind != EventKind::impact) continue;
    replay.run_until(event.time);
    const double angle = replay.state().coordinate(axle);
    turned += std::abs(angle - before);
    before = angle;
    angles.push_back(angle + std::numbers::pi / 2.0);
  }
  turned += std::abs(simulation.state().coordinate(axle) - before);
  ASSERT_EQ(angles.size(), 2U);
  EXPECT_NEAR(angles[0], touch, 1e-8);
  EXPECT_NEAR(angles[1], 2.0 * std::numbers::pi - touch, 1e-8);
  // Friction takes 0.3 N m times the way; tolerances of the integrator are 1e-9 of each step.
  EXPECT_NEAR(simulation.energy().flow(EnergyFlow::joint_friction), 0.3 * turned, 1e-7);
}

TEST(Tutorial, TheRunIsRecordedAndGoesOn) {
  const carom_test::TemporaryFolder folder;
  EXPECT_TRUE(record_and_go_on(folder / ""));
  EXPECT_EQ(folder.text_of("run.csv").substr(0, 8), "time [s]");
}

}  // namespace
