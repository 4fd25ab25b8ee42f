#include "validation/measure.h"
#include "validation/pages.h"
#include "validation/scenes.h"

#include <carom/contact/solvers/single_contact.h>

#include <algorithm>

namespace validation {
namespace {

scenes::PainleveRod rod_of(const Json& at) {
  return {.theta = of(at, "theta"),
          .friction = of(at, "mu"),
          .omega = of(at, "omega"),
          .tip_speed = of(at, "tip_velocity_sign")};
}

/// Effect of the forces of a state of the reference.
std::string answer_of(const Json& at) {
  const Json& solutions = at.at("force_level_solutions");
  if (solutions.empty()) return "none: impact without collision";
  if (solutions.size() > 1) return "two: open is taken";
  return solutions[0].at("kind").get<std::string>();
}

/// And what the library made of it, from its first event.
std::string found(const Simulation& simulation) {
  if (simulation.events().empty()) return "detach";
  const EventRecord& event = simulation.events()[0];
  if (event.kind == EventKind::impact_without_collision) return "none: impact without collision";
  if (event.kind == EventKind::several_accelerations)
    return event.mode == ContactMode::open ? "two: open is taken" : "two: slip is taken";
  return event.mode == ContactMode::stick ? "stick" : "slide";
}

constexpr double short_time = 1e-6;  // [s]

void add_states(Page& page, const Json& data) {
  Comparison stiffness, acceleration, impulses;
  const Clock clock;
  for (const auto& at : data.at("states")) {
    const Clock one;
    scenes::BodyScene scene = scenes::painleve_rod(rod_of(at));
    Simulation simulation(std::move(scene.system), tight());
    simulation.run_until(short_time);
    page.rows.push_back(statement(tight(), "accelerations, " + at.at("name").get<std::string>(),
                                  answer_of(at), found(simulation), one.seconds()));
    if (simulation.events().empty()) continue;
    const EventRecord& event = simulation.events()[0];
    if (event.kind == EventKind::impact_without_collision || event.kind == EventKind::several_accelerations) {
      stiffness(event.stiffness, of(at, "p"));
      acceleration(event.free_acceleration, of(at, "b"));
    }
    if (event.kind != EventKind::impact_without_collision) continue;
    const Json& law = at.at("impact_law_solutions_tip_speed_1_normal_0")[1];
    impulses(event.impulse[1], law[1].get<double>());
    impulses(event.impulse[0], law[2].get<double>());
  }
  const double cost = clock.seconds();
  page.rows.push_back(
      row(tight(), "p = W_nn − s μ W_nt where no or two accelerations exist [1/kg]", stiffness, cost));
  page.rows.push_back(row(tight(), "normal acceleration without contact there [m/s²]", acceleration, cost));
  page.rows.push_back(row(tight(), "impulses of the impact without collision [N s]", impulses, cost));
}

/// Time stepping returns that impulse in its first step, in the limit of small steps.
void add_stepping(Page& page, const Json& at) {
  const Json& law = at.at("impact_law_solutions_tip_speed_1_normal_0")[1];
  scenes::PainleveRod rod = rod_of(at);
  rod.depth = 1e-12;
  add_with_options(page, TimeStepping{}, [&](Page& to, const Mode& mode) {
    Comparison smallest;
    const Halvings errors = halve(1e-4, 5, [&](double h) {
      scenes::BodyScene scene = scenes::painleve_rod(rod);
      Simulation simulation(std::move(scene.system), with_step(mode, h));
      simulation.step();
      const auto& impulse = simulation.report().contacts.at(0).impulse;
      smallest = {};
      smallest(impulse[0], law[2].get<double>());
      smallest(impulse[1], law[1].get<double>());
      return std::abs(smallest.obtained() - smallest.reference());
    });
    to.rows.push_back(row(with_step(mode, errors.steps.back()),
                          "impulses of the first step, " + at.at("name").get<std::string>() + " [N s]",
                          smallest, errors.cost, errors.order()));
  });
}

double critical_friction(double theta) {
  double low = 1.0, high = 3.0;
  for (int i = 0; i < 45; ++i) {
    const double middle = 0.5 * (low + high);
    scenes::BodyScene scene = scenes::painleve_rod({.theta = theta, .friction = middle, .tip_speed = -1.0});
    Simulation simulation(std::move(scene.system), tight());
    simulation.run_until(1e-12);
    (events_of(simulation, EventKind::impact_without_collision).empty() ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// A uniform rod (1 kg, 2 m) touching with its lower left tip, scaled by e = 0.
PlanarContact rod_contact(double theta, double friction, double b_n, double b_t) {
  const double c = std::cos(theta), s = std::sin(theta);
  return {.w_nn = 1.0 + 3.0 * c * c,
          .w_nt = -3.0 * c * s,
          .w_tt = 1.0 + 3.0 * s * s,
          .b_n = b_n,
          .b_t = b_t,
          .friction = friction};
}

/// Share of the directions of b for which the contact has three solutions.
double share_of_three(double theta, double friction, int directions) {
  int three = 0;
  for (int i = 0; i < directions; ++i) {
    const double angle = 2.0 * pi * (i + 0.5) / directions;
    if (solve_planar_contact(rod_contact(theta, friction, std::sin(angle), std::cos(angle))).count > 2)
      ++three;
  }
  return 1.0 * three / directions;
}

/// The largest number of solutions for directions of b with b_n < 0, which no open contact answers.
int most_solutions_pressed(double theta, double friction, int directions) {
  int most = 0;
  for (int i = 0; i < directions; ++i) {
    const double angle = -pi * (i + 0.5) / directions;
    most = std::max(
        most, solve_planar_contact(rod_contact(theta, friction, std::sin(angle), std::cos(angle))).count);
  }
  return most;
}

double least_friction_for_three(double theta) {
  double low = 1.0, high = 4.0;
  constexpr int directions = 20000;  // the sector of directions opens from nothing
  for (int i = 0; i < 16; ++i) {
    const double middle = 0.5 * (low + high);
    (share_of_three(theta, middle, directions) > 0.0 ? high : low) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

Page painleve() {
  Page page;
  page.name = "painleve";
  page.title = "Painlevé's rod";
  page.source =
      "Painlevé 1895; Génot and Brogliato, Eur. J. Mech. A/Solids 18 (1999) 653; closed form, "
      "`contacts_planar.json`";
  page.text =
      "A uniform rod slides with its tip on a rough floor. Where p = W_nn − s μ W_nt < 0 the forces that "
      "keep the contact may not exist, or there are two answers. The library names such states, with p and "
      "the free acceleration b, and goes on with an impact without collision or by its rule. Seven states "
      "with all their answers, and the least friction for which such states exist, 4/3 at tan θ = 2.";
  page.figures = {{"painleve",
                   "p over the angle of the rod and the friction, as the library reports it (white: p ≥ 0, "
                   "regular); marks: the seven states. Black: p = 0 by the formula."}};
  const Json data = reference("contacts_planar.json", "painleve_rod");
  add_states(page, data);
  for (const auto& at : data.at("states")) {
    if (at.at("force_level_solutions").empty()) add_stepping(page, at);
  }
  const Clock clock;
  page.rows.push_back(row(tight(), "critical friction at tan θ = 2",
                          critical_friction(of(data, "critical_theta")), of(data, "critical_mu"),
                          clock.seconds()));
  Curve map{.name = "painleve_map", .columns = {"theta [rad]", "friction", "p [1/kg]"}, .rows = {}};
  for (int i = 1; i < 60; ++i) {
    for (int j = 0; j <= 40; ++j) {
      const double theta = 0.5 * pi * i / 60, friction = 1.0 + 0.05 * j;
      scenes::BodyScene scene =
          scenes::painleve_rod({.theta = theta, .friction = friction, .tip_speed = -1.0});
      Simulation simulation(std::move(scene.system), tight());
      simulation.run_until(1e-12);
      const auto impacts = events_of(simulation, EventKind::impact_without_collision);
      map.rows.push_back({theta, friction, impacts.empty() ? unknown : impacts[0].stiffness});
    }
  }
  Curve states{.name = "painleve_states", .columns = {"theta [rad]", "friction", "solutions"}, .rows = {}};
  for (const auto& at : data.at("states"))
    states.rows.push_back(
        {of(at, "theta"), of(at, "mu"), 1.0 * static_cast<double>(at.at("force_level_solutions").size())});
  page.curves = {map, states};
  page.remarks =
      "Time stepping needs no such decision: its first step returns the impulse of the impact without "
      "collision but for a part that falls with the step.";
  return page;
}

Page three_solutions() {
  Page page;
  page.name = "three_solutions";
  page.title = "One contact with three solutions";
  page.source = "docs/method.md, section 3: a condition for uniqueness; `open_variants.json`";
  page.text =
      "One contact always has a solution, and only one if μ |W_nt| ≤ W_nn; otherwise there can be three: "
      "open, stick and slip. Shown for a uniform rod that touches with its tip, over its angle and the "
      "friction: the share of the directions of b = γ_f + E γ⁻ for which the contact has three solutions, as "
      "the library lists them.";
  page.figures = {{"three_solutions",
                   "Share of all directions of b with three solutions. Black: μ |W_nt| = W_nn, below which "
                   "the solution is unique; its lowest point is μ = 4/3 at tan θ = 2."}};
  const Clock clock;
  Comparison borders;
  for (const double theta : {0.6, std::atan(2.0), 1.3}) {
    const double c = std::cos(theta), s = std::sin(theta);
    borders(least_friction_for_three(theta), (1.0 + 3.0 * c * c) / (3.0 * c * s));
  }
  page.rows.push_back(solver_row("all modes in closed form", "least friction with three solutions", borders,
                                 clock.seconds()));
  const Clock later;
  Comparison pressed;
  Curve map{.name = "three_solutions_map", .columns = {"theta [rad]", "friction", "share"}, .rows = {}};
  for (int i = 1; i < 90; ++i) {
    for (int j = 0; j <= 80; ++j) {
      const double theta = 0.5 * pi * i / 90, friction = 0.05 * j;
      map.rows.push_back({theta, friction, share_of_three(theta, friction, 2880)});
      pressed(most_solutions_pressed(theta, friction, 360), 1.0);
    }
  }
  page.rows.push_back(solver_row("all modes in closed form",
                                 "solutions of a direction with b_n < 0, the most", pressed,
                                 later.seconds()));
  page.curves = {map};
  page.remarks =
      "The sector of such directions opens from nothing at the border, so that the bisection over 20,000 "
      "directions finds it a little late. Where b_n < 0, as in an impact without load, the solution is "
      "unique all the same.";
  return page;
}

}  // namespace validation
