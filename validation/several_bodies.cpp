#include "validation/contact_rows.h"
#include "validation/measure.h"
#include "validation/pages.h"

#include <carom/contact/solvers/solver_chain.h>

namespace validation {
namespace {

std::vector<double> solved(const ContactProblem& problem, SolverChain& chain) {
  std::vector<double> impulse(static_cast<std::size_t>(problem.rows()));
  const ContactReport report = chain.solve(problem, impulse);
  if (!report.usable())
    throw std::runtime_error("a contact problem of the report was not solved: " + std::string(report.reason));
  return impulse;
}

void add_cradle(Page& page, SolverChain& chain) {
  const Clock clock;
  Comparison impulses, velocities;
  for (const auto& at : reference("contacts_planar.json", "newton_cradle", "cases")) {
    const auto n = at.at("N").get<std::size_t>();
    Rows rows{.h = std::vector(n - 1, std::vector<double>(n)), .inverse_mass = std::vector(n, 1.0)};
    std::vector<double> b(n - 1), after(n);
    for (std::size_t i = 0; i + 1 < n; ++i) {
      rows.h[i][i] = -1.0;
      rows.h[i][i + 1] = 1.0;
    }
    after[0] = 1.0;
    b[0] = -(1.0 + of(at, "e"));  // the first two approach
    const std::vector<double> impulse = solved(problem_of(rows, b), chain);
    for (std::size_t i = 0; i + 1 < n; ++i) {
      after[i] -= impulse[i];
      after[i + 1] += impulse[i];
      impulses(impulse[i], at.at("simultaneous_impulses")[0][i].get<double>());
    }
    for (std::size_t i = 0; i < n; ++i)
      velocities(after[i], at.at("simultaneous_velocities")[0][i].get<double>());
  }
  page.rows.push_back(solver_row("chain", "impulses of Newton's cradle, all contacts at once [N s]", impulses,
                                 clock.seconds()));
  page.rows.push_back(solver_row("chain", "velocities after it [m/s]", velocities, clock.seconds()));
}

constexpr double step = 1e-3;  // over which weight acts [s]

void add_stacks(Page& page, SolverChain& chain) {
  const Json data = reference("contacts_planar.json", "static_stack");
  constexpr std::size_t n = 10;
  constexpr double width = 0.1,
                   inertia = 1.0 / 6.0 * 4.0 * width * width;  // half width of blocks; of squares of 1 kg
  for (const bool blocks : {false, true}) {
    const Clock clock;
    Rows rows{.h = {}, .inverse_mass = std::vector(2 * n, 1.0)};  // vertical velocity, spin
    std::vector<double> b;
    for (std::size_t i = 0; i < n; ++i) rows.inverse_mass[2 * i + 1] = 1.0 / inertia;
    for (std::size_t i = 0; i < n; ++i) {
      for (const double x : blocks ? std::vector{-width, width} : std::vector{0.0}) {
        std::vector<double> line(2 * n);
        line[2 * i] = 1.0;
        line[2 * i + 1] = x;
        if (i > 0) {
          line[2 * i - 2] = -1.0;
          line[2 * i - 1] = -x;
        }
        rows.h.push_back(line);
        b.push_back(i == 0 ? -g * step : 0.0);  // all fall alike: only the lowest approaches
      }
    }
    const std::vector<double> impulse = solved(problem_of(rows, b), chain);
    Comparison forces;
    Curve curve{.name = blocks ? "stack_blocks" : "stack_discs",
                .columns = {"level", "force [N]", "reference [N]"},
                .rows = {}};
    const Json& expected =
        data.at(blocks ? "block_corner_forces_bottom_up" : "disc_contact_forces_bottom_up");
    const std::size_t contacts = blocks ? 2 : 1;
    for (std::size_t i = 0; i < impulse.size(); ++i) {
      const double force = impulse[i] / step, reference = expected[i / contacts].get<double>();
      forces(force, reference);
      curve.rows.push_back({1.0 * static_cast<double>(i / contacts), force, reference});
    }
    page.rows.push_back(solver_row(
        "chain",
        blocks ? "forces at corners of a stack of ten blocks [N]" : "forces in a stack of ten discs [N]",
        forces, clock.seconds()));
    page.curves.push_back(curve);
  }
}

void add_pyramid(Page& page, SolverChain& chain) {
  const Json data = reference("contacts_planar.json", "three_disc_pyramid");
  const Clock clock;
  constexpr double gap = 1e-3;  // between the lower discs, in radii
  const double s = (2.0 + gap) / 4.0,
               c = std::sqrt(1.0 - s * s);  // of the angle of the upper contacts from the vertical
  // Discs: left, right, top; velocities x, y of each. Contacts: floor, floor, wall, wall, top left, top
  // right.
  const Rows rows{.h = {{0, 1, 0, 0, 0, 0},
                        {0, 0, 0, 1, 0, 0},
                        {1, 0, 0, 0, 0, 0},
                        {0, 0, -1, 0, 0, 0},
                        {-s, -c, 0, 0, s, c},
                        {0, 0, s, -c, -s, c}},
                  .inverse_mass = std::vector(6, 1.0)};
  const std::vector<double> impulse = solved(problem_of(rows, {-g * step, -g * step, 0, 0, 0, 0}), chain);
  const std::array<std::pair<const char*, const char*>, 3> names{
      {{"floor_each", "floor"}, {"wall_each", "walls"}, {"top_pair_each", "upper disc"}}};
  for (std::size_t k = 0; k < names.size(); ++k) {
    Comparison forces;
    for (std::size_t i = 2 * k; i < 2 * k + 2; ++i) forces(impulse[i] / step, of(data, names[k].first));
    page.rows.push_back(solver_row(
        "chain", std::string("force of the ") + names[k].second + " in a pyramid of three discs [N]", forces,
        clock.seconds()));
  }
}

/// A disc or a block of 1 kg. \param half its radius, or half its sides [m]
BodyId add_body(System& system, bool block, double half, const Vec<2>& place, double speed = 0.0) {
  const BodyId body = system.add(RigidBody{.mass = block ? box(1.0, 2.0 * half, 2.0 * half) : disc(1.0, half),
                                           .position = place,
                                           .velocity = {speed, 0.0}});
  if (block) {
    system.add(
        Polygon{.body = body, .vertices = {{-half, -half}, {half, -half}, {half, half}, {-half, half}}});
  } else {
    system.add(Disc{.body = body, .radius = half});
  }
  return body;
}

/// The cradle as a simulation: all discs touch but the first, which arrives; together, or one after the
/// other.
void simulate_cradles(Page& page, Mode mode, ImpactOrder order) {
  constexpr double radius = 0.125;
  const bool sequential = order == ImpactOrder::sequential,
             events = std::holds_alternative<EventDriven>(mode);
  std::visit([order](auto& options) { options.impact_rules.order = order; }, mode);
  const Clock clock;
  Comparison velocities;
  for (const auto& at : reference("contacts_planar.json", "newton_cradle", "cases")) {
    System system;
    system.set_default_law({.friction = 0.0, .normal_restitution = of(at, "e")});
    std::vector<BodyId> discs;
    for (int i = 0; i < at.at("N").get<int>(); ++i) {
      const double x = i == 0 && events ? -0.5 : 2.0 * radius * i;
      discs.push_back(add_body(system, false, radius, {x, 0.0}, i == 0 ? 1.0 : 0.0));
    }
    Simulation simulation(std::move(system), mode);
    simulation.run_until(events ? 0.5 + 1e-9 : 1e-9);
    const Json& expected =
        sequential ? at.at("sequential_velocities") : at.at("simultaneous_velocities").at(0);
    for (std::size_t i = 0; i < discs.size(); ++i)
      velocities(simulation.state().velocity(discs[i])[0], expected[i].get<double>());
  }
  page.rows.push_back(row(mode,
                          std::string("velocities behind Newton's cradle, ") +
                              (sequential ? "one contact after the other" : "all contacts at once") +
                              " [m/s]",
                          velocities, clock.seconds()));
}

/// Forces on the floor and between bodies of a stack, by level from below.
void simulate_stack(Page& page, const Mode& mode, bool blocks) {
  const Json data = reference("contacts_planar.json", "static_stack");
  const Json& expected = data.at(blocks ? "block_corner_forces_bottom_up" : "disc_contact_forces_bottom_up");
  constexpr double half = 0.1;
  constexpr std::size_t n = 10;
  System system;
  system.add(Gravity{{0.0, -g}});
  system.set_default_law({.friction = 0.3, .normal_restitution = 0.0});
  system.add(HalfPlane{.normal = {0.0, 1.0}});
  for (std::size_t i = 0; i < n; ++i)
    add_body(system, blocks, half, {0.0, (2.0 * static_cast<double>(i) + 1.0) * half});
  const Clock clock;
  Simulation simulation(std::move(system), mode);
  simulation.run_until(0.1);
  Comparison forces;
  for (const LastingContact& contact : simulation.contact_forces()) {
    const auto level = static_cast<std::size_t>(std::lround(contact.point[1] / (2.0 * half)));
    forces(contact.force[0], expected.at(level).get<double>());
  }
  page.rows.push_back(row(
      mode, blocks ? "forces at corners of a stack of ten blocks [N]" : "forces in a stack of ten discs [N]",
      forces, clock.seconds()));
}

/// Three smooth discs between walls, described at rest.
void simulate_pyramid(Page& page, const Mode& mode) {
  const Json data = reference("contacts_planar.json", "three_disc_pyramid");
  constexpr double r = 0.1, x = r + 0.5e-3 * r;
  System system;
  system.add(Gravity{{0.0, -g}});
  system.set_default_law({.friction = 0.0, .normal_restitution = 0.0});
  const ObstacleId floor = system.add(HalfPlane{.normal = {0.0, 1.0}});
  for (const double side : {1.0, -1.0})
    system.add(HalfPlane{.point = {-side * (x + r), 0.0}, .normal = {side, 0.0}});
  for (const double side : {1.0, -1.0}) add_body(system, false, r, {-side * x, r});
  add_body(system, false, r, {0.0, r + std::sqrt(4.0 * r * r - x * x)});
  const Clock clock;
  Simulation simulation(std::move(system), mode);
  simulation.run_until(2e-3);
  Comparison forces;
  for (const LastingContact& contact : simulation.contact_forces()) {
    const char* const name = contact.other.valid()       ? "top_pair_each"
                             : contact.obstacle == floor ? "floor_each"
                                                         : "wall_each";
    forces(contact.force[0], of(data, name));
  }
  page.rows.push_back(row(mode, "forces in a pyramid of three discs [N]", forces, clock.seconds()));
}

}  // namespace

Page several_bodies() {
  Page page;
  page.name = "several_bodies";
  page.title = "Cradle, stacks and a pyramid";
  page.source = "enumeration of modes and statics, `contacts_planar.json`";
  page.text =
      "Newton's cradle (3 and 5 masses, four e), ten discs and ten blocks one above the other, and three "
      "smooth discs between walls: as contact problems W P + b by themselves (impulses of a millisecond of "
      "weight, divided by it), and as simulations, whose forces are those of the contacts that last "
      "(`Simulation::contact_forces()`).";
  page.figures = {{"stacks", "Forces in the stacks by level from below; crosses: statics."}};
  SolverChain chain;
  add_cradle(page, chain);
  add_stacks(page, chain);
  add_pyramid(page, chain);
  for (const Mode& mode : {Mode(TimeStepping{.step = 1e-9}), Mode(tight())}) {
    for (const ImpactOrder order : {ImpactOrder::simultaneous, ImpactOrder::sequential})
      simulate_cradles(page, mode, order);
  }
  for (const Mode& mode : {Mode(TimeStepping{.step = 1e-4}), Mode(tight())}) {
    for (const bool blocks : {false, true}) simulate_stack(page, mode, blocks);
    simulate_pyramid(page, mode);
  }
  page.remarks =
      "For the cradle the law gives what all contacts do at once, not the passing on of the impact from mass "
      "to mass: with e = 1 three masses leave with −1/3, 2/3, 2/3 of the speed. That is the law's answer, "
      "not nature's; the sequential law passes the impact on.";
  return page;
}

}  // namespace validation
