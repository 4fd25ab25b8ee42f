#include "tests/analytic/rotating_spring_pair.h"
#include "validation/measure.h"
#include "validation/pages.h"

namespace validation {
namespace {

/// Bodies on springs, and the numbers to compare: places, then velocities.
struct Springs {
  System system;
  std::vector<BodyId> bodies;
};

std::vector<double> numbers(const State& state, const std::vector<BodyId>& bodies) {
  std::vector<double> all;
  for (const BodyId body : bodies) all.insert(all.end(), {state.position(body)[0], state.position(body)[1]});
  for (const BodyId body : bodies) all.insert(all.end(), {state.velocity(body)[0], state.velocity(body)[1]});
  return all;
}

void add(Page& page, const std::string& name, const Springs& springs, const std::string& time,
         const std::vector<double>& expected) {
  const double end = std::stod(time);
  const auto compare = [&](const Mode& mode) {
    Simulation simulation(springs.system, mode);
    simulation.run_until(end);
    Comparison values;
    const std::vector<double> found = numbers(simulation.state(), springs.bodies);
    for (std::size_t i = 0; i < found.size(); ++i) values(found[i], expected[i]);
    return values;
  };
  const std::string quantity = "places and velocities of the " + name + " at " + time + " s [m, m/s]";
  for (const ForceRule rule : {ForceRule::trapezoidal, ForceRule::energy_momentum}) {
    Comparison last;
    TimeStepping stepping{.tolerance = 1e-14, .force_rule = rule};
    const Halvings errors = halve(1e-3, 4, [&](double h) {
      stepping.step = h;
      last = compare(stepping);
      return std::abs(last.obtained() - last.reference());
    });
    Row line = row(stepping, quantity, last, errors.cost, errors.order());
    line.setting += ", " + std::string(to_string(rule));
    page.rows.push_back(line);
  }
  const Clock clock;
  const Comparison values = compare(tight());
  page.rows.push_back(row(tight(), quantity, values, clock.seconds()));
}

Springs spring_pendulum(double mass, double stiffness, double length, const std::vector<double>& start) {
  Springs springs;
  springs.system.add(Gravity{{0.0, -g}});
  springs.bodies.push_back(springs.system.add(
      Particle{.mass = mass, .position = {start[0], start[1]}, .velocity = {start[2], start[3]}}));
  springs.system.add(
      SpringDamper{.from = ground, .to = springs.bodies[0], .stiffness = stiffness, .free_length = length});
  return springs;
}

Curve pendulum_course() {
  const Springs springs = spring_pendulum(1.0, 40.0, 1.0, {1.0, 0.0, 0.0, 0.0});
  Simulation simulation(springs.system, tight());
  Curve curve{.name = "spring_pendulum", .columns = {"x [m]", "y [m]"}, .rows = {{1.0, 0.0}}};
  for (int i = 1; i <= 1000; ++i) {
    simulation.run_until(0.01 * i);
    const auto x = simulation.state().position(springs.bodies[0]);
    curve.rows.push_back({x[0], x[1]});
  }
  return curve;
}

}  // namespace

Page springs() {
  Page page;
  page.name = "springs";
  page.title = "Bodies on springs";
  page.source = "closed forms; two formulations with two methods, `smooth_planar.json`, `open_variants.json`";
  page.text =
      "A particle on a spring that swings, two masses with spring and dashpot in free fall, a pair that "
      "turns about its centre at constant distance, and four random spring pendulums. Time stepping with "
      "both rules for the coupling forces.";
  page.figures = {
      {"spring_pendulum", "Path of the spring pendulum over 10 s, event-driven; dots: reference."}};
  const Json data = reference_data("smooth_planar.json");
  Curve points{.name = "spring_pendulum_reference", .columns = {"x [m]", "y [m]"}, .rows = {}};
  const Json& swinging = data.at("spring_pendulum").at("reference");
  for (const auto& [time, at] : swinging.items()) points.rows.push_back({of(at, "x"), of(at, "y")});
  const Json& last = swinging.at("10");
  add(page, "spring pendulum", spring_pendulum(1.0, 40.0, 1.0, {1.0, 0.0, 0.0, 0.0}), "10",
      {of(last, "x"), of(last, "y"), of(last, "vx"), of(last, "vy")});

  Springs masses;
  masses.system.add(Gravity{{0.0, -g}});
  masses.bodies = {
      masses.system.add(Particle{.mass = 1.0, .position = {0.0, 10.0}, .velocity = {0.0, 2.0}}),
      masses.system.add(Particle{.mass = 2.0, .position = {0.0, 11.0}, .velocity = {0.0, -1.0}})};
  masses.system.add(SpringDamper{.from = masses.bodies[0],
                                 .to = masses.bodies[1],
                                 .stiffness = 100.0,
                                 .damping = 3.0,
                                 .free_length = 0.5});
  const Json& falling = data.at("two_mass_spring_dashpot").at("reference").at("1");
  add(page, "two masses with spring and dashpot", masses, "1",
      {0.0, of(falling, "y1"), 0.0, of(falling, "y2"), 0.0, of(falling, "v1"), 0.0, of(falling, "v2")});

  const analytic::RotatingSpringPair exact{1.0, 1000.0, 2.0, 10.0};
  Springs turning;
  const auto x0 = exact.position(0.0), v0 = exact.velocity(0.0), x = exact.position(1.0),
             v = exact.velocity(1.0);
  turning.bodies = {turning.system.add(Particle{.mass = 1.0, .position = x0, .velocity = v0}),
                    turning.system.add(Particle{.mass = 1.0, .position = -x0, .velocity = -v0})};
  turning.system.add(SpringDamper{
      .from = turning.bodies[0], .to = turning.bodies[1], .stiffness = 1000.0, .free_length = 2.0});
  add(page, "turning pair", turning, "1", {x[0], x[1], -x[0], -x[1], v[0], v[1], -v[0], -v[1]});

  const Clock clock;
  Comparison random;
  for (const auto& at : reference("open_variants.json", "spring_pendulum")) {
    const Springs pendulum =
        spring_pendulum(of(at, "m"), of(at, "k"), of(at, "l0"), at.at("start").get<std::vector<double>>());
    Simulation simulation(pendulum.system, tight());
    simulation.run_until(4.0);
    const std::vector<double> found = numbers(simulation.state(), pendulum.bodies);
    for (std::size_t i = 0; i < found.size(); ++i) random(found[i], at.at("t4")[i].get<double>());
  }
  page.rows.push_back(row(tight(), "places and velocities of random spring pendulums at 4 s [m, m/s]", random,
                          clock.seconds()));
  page.curves = {pendulum_course(), points};
  page.remarks =
      "Both rules are of order 2; `energy_momentum` keeps the energy to rounding, which makes the phase no "
      "better.";
  return page;
}

}  // namespace validation
