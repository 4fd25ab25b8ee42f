#include "tests/integrators/joint_scenes.h"
#include "validation/measure.h"
#include "validation/pages.h"

#include <functional>

namespace validation {
namespace {

using joint_scenes::Scene;
using Read = std::function<std::vector<double>(const State&, const std::vector<BodyId>&)>;

EventDriven fine() { return {.relative_tolerance = 1e-12, .absolute_tolerance = 1e-12}; }

/// A mechanism with its reference: what is read at a time, against what, and in which scale.
struct Mechanism {
  std::string name, unit;
  std::function<Scene()> make;
  Read read;
  std::function<std::vector<double>(const std::string& time)> reference;
  std::vector<std::string> times;  // of event-driven runs
  std::string stepping_time;       // of time stepping
  double step = 0.0;               // the largest of three halvings
};

std::vector<double> angles_of(const State& state, const std::vector<BodyId>& bodies) {
  std::vector<double> numbers;
  for (const BodyId body : bodies) numbers.push_back(state.angle(body));
  return numbers;
}

std::vector<double> named(const Json& at, const std::vector<const char*>& names) {
  std::vector<double> numbers;
  for (const char* name : names) numbers.push_back(of(at, name));
  return numbers;
}

Mechanism chain(int links, const char* problem, const std::string& name, std::vector<std::string> times,
                const std::string& stepping_time) {
  return {name,
          "angles [rad]",
          [links] { return joint_scenes::rod_pendulum(links); },
          angles_of,
          [problem](const std::string& time) {
            std::vector<double> numbers;
            const Json at = reference("smooth_planar.json", problem, "reference", time);
            for (const auto& angle : at.at("theta"))
              numbers.push_back(angle.get<double>() - joint_scenes::quarter);
            return numbers;
          },
          std::move(times),
          stepping_time,
          2e-3};
}

std::vector<Mechanism> mechanisms_of_the_files() {
  std::vector<Mechanism> all;
  all.push_back({"Andrews' squeezing mechanism",
                 "angles [rad]",
                 joint_scenes::squeezing_mechanism,
                 [](const State& state, const std::vector<BodyId>& bodies) {
                   std::array<double, 7> angle{};
                   for (std::size_t i = 0; i < 7; ++i) angle[i] = state.angle(bodies[i]);
                   return joint_scenes::relative(angle);
                 },
                 [](const std::string& time) {
                   return reference("andrews.json", "recomputed", time, "q").get<std::vector<double>>();
                 },
                 {"0.01", "0.02", "0.03"},
                 "0.03",
                 1e-5});
  all.push_back({"the slider-crank",
                 "angles and place [rad, m]",
                 joint_scenes::slider_crank,
                 [](const State& state, const std::vector<BodyId>& bodies) {
                   return std::vector<double>{state.angle(bodies[0]), state.angle(bodies[1]),
                                              state.position(bodies[2])[0]};
                 },
                 [](const std::string& time) {
                   return named(reference("smooth_planar.json", "slider_crank", "reference", time),
                                {"crank_angle", "rod_angle", "slider_x"});
                 },
                 {"0.01", "0.05", "0.1"},
                 "0.1",
                 5e-5});
  all.push_back(
      {"the pendulum A01",
       "place [m]",
       joint_scenes::particle_pendulum,
       [](const State& state, const std::vector<BodyId>& bodies) {
         return std::vector<double>{state.position(bodies[0])[0], state.position(bodies[0])[1]};
       },
       [](const std::string& time) {
         return named(reference("smooth_planar.json", "A01_simple_pendulum", "reference", time), {"x", "y"});
       },
       {"1", "2", "3", "4", "5", "6", "7", "8", "9", "10"},
       "10",
       4e-3});
  all.push_back(chain(2, "double_pendulum_rods", "the double pendulum", {"0.5", "1", "2", "3"}, "1"));
  all.push_back(
      chain(10, "ten_link_pendulum_rods", "the pendulum of ten rods", {"0.5", "1", "1.5", "2"}, "0.5"));
  return all;
}

void add_mechanism(Page& page, const Mechanism& at) {
  const Scene scene = at.make();
  const Clock clock;
  Comparison values;
  EventDriven options = fine();
  Simulation simulation(scene.system, options);
  for (const std::string& time : at.times) {
    simulation.run_until(std::stod(time));
    const std::vector<double> expected = at.reference(time),
                              found = at.read(simulation.state(), scene.bodies);
    for (std::size_t i = 0; i < found.size(); ++i) values(found[i], expected[i]);
  }
  page.rows.push_back(
      row(options, at.unit + " of " + at.name + " up to " + at.times.back() + " s", values, clock.seconds()));

  const std::vector<double> expected = at.reference(at.stepping_time);
  add_with_options(page, TimeStepping{}, [&](Page& to, const Mode& mode) {
    Comparison last;
    const Halvings errors = halve(at.step, 3, [&](double h) {
      Simulation stepped(scene.system, with_step(mode, h));
      stepped.run_until(std::stod(at.stepping_time));
      const std::vector<double> found = at.read(stepped.state(), scene.bodies);
      last = {};
      for (std::size_t i = 0; i < found.size(); ++i) last(found[i], expected[i]);
      return std::abs(last.obtained() - last.reference());
    });
    to.rows.push_back(row(with_step(mode, errors.steps.back()),
                          at.unit + " of " + at.name + " at " + at.stepping_time + " s", last, errors.cost,
                          errors.order()));
  });
}

/// \param until end of the event-driven run [s]
void add_windows(Page& page, int number, const char* problem, double until,
                 const std::function<void(Simulation&)>& watch) {
  const std::vector<std::string> times{"0.5", "1", "2", "5", "10"};
  const Scene scene = joint_scenes::windows(number);
  const Json data = reference("smooth_planar.json", problem, "reference");
  const Clock clock;
  Comparison angle, spin;
  Simulation simulation(scene.system, fine());
  if (watch) watch(simulation);
  std::string last;
  for (const std::string& time : times) {
    if (std::stod(time) > until) break;
    last = time;
    simulation.run_until(std::stod(time));
    for (std::size_t i = 0; i <= static_cast<std::size_t>(number); ++i) {
      angle(joint_scenes::quarter - simulation.state().angle(scene.bodies[i]), of(data.at(time), "phi"));
      spin(-simulation.state().spin(scene.bodies[i]), of(data.at(time), "phidot"));
    }
  }
  const std::string name = " of " + std::to_string(number) + " four-bars A02 up to " + last + " s";
  page.rows.push_back(row(fine(), "angle" + name + " [rad]", angle, clock.seconds()));
  page.rows.push_back(row(fine(), "spin" + name + " [rad/s]", spin, clock.seconds()));

  add_with_options(page, TimeStepping{.step = 1e-3}, [&](Page& to, const Mode& mode) {
    const Clock of_steps;
    Simulation stepped(scene.system, mode);
    stepped.run_until(std::stod(times.back()));
    Comparison at_end;
    for (std::size_t i = 0; i <= static_cast<std::size_t>(number); ++i) {
      at_end(joint_scenes::quarter - stepped.state().angle(scene.bodies[i]),
             of(data.at(times.back()), "phi"));
    }
    to.rows.push_back(
        row(mode, "angle of " + std::to_string(number) + " four-bars A02 at " + times.back() + " s [rad]",
            at_end, of_steps.seconds()));
  });
}

Curve slider_course() {
  const Scene scene = joint_scenes::slider_crank();
  Simulation simulation(scene.system, fine());
  Curve curve{
      .name = "slider_course", .columns = {"time [s]", "slider [m]", "crank speed [rad/s]"}, .rows = {}};
  for (int i = 0; i <= 300; ++i) {
    const double time = 0.1 * i / 300.0;
    if (i > 0) simulation.run_until(time);
    curve.rows.push_back(
        {time, simulation.state().position(scene.bodies[2])[0], simulation.state().spin(scene.bodies[0])});
  }
  return curve;
}

}  // namespace

Page mechanisms() { return mechanisms({}); }

Page mechanisms(const std::function<void(Simulation&)>& watch, double forty_until) {
  Page page;
  page.name = "mechanisms";
  page.title = "Mechanisms";
  page.source =
      "Hairer and Wanner 1996, VII.7; IFToMM benchmarks A01 and A02; two formulations with two methods, "
      "`andrews.json`, `smooth_planar.json`";
  page.text =
      "Smooth motion with joints: Andrews' squeezing mechanism, a slider-crank, pendulums of one to ten "
      "links, and the four-bar windows of the IFToMM library, which pass through positions where all rods "
      "are in line and their joints depend on each other.";
  page.figures = {
      {"mechanisms",
       "Slider-crank: place of the slider and speed of the crank, event-driven; dots: reference."}};
  for (const Mechanism& at : mechanisms_of_the_files()) add_mechanism(page, at);
  add_windows(page, 2, "A02_double_fourbar_N2", 10.0, watch);
  add_windows(page, 40, "A02_fourbar_N40", forty_until, watch);
  Curve points{
      .name = "slider_reference", .columns = {"time [s]", "slider [m]", "crank speed [rad/s]"}, .rows = {}};
  const Json known = reference("smooth_planar.json", "slider_crank", "reference");
  for (const auto& [time, at] : known.items())
    points.rows.push_back({std::stod(time), of(at, "slider_x"), of(at, "crank_speed")});
  page.curves = {slider_course(), points};
  page.remarks =
      "Time stepping is of order 2. In the positions in line of A02, where rows of the joints depend on each "
      "other, both modes magnify rounding at each passage, but the motion stays on its branch. The chains "
      "are "
      "chaotic: they are compared up to times at which references of two methods still agree.";
  return page;
}

}  // namespace validation
