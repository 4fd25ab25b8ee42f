#include "validation/contact_rows.h"
#include "validation/measure.h"
#include "validation/pages.h"
#include "validation/several_bodies_runs.h"

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

constexpr double weight_step = 1e-3;  // over which weight acts [s]

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
        b.push_back(i == 0 ? -g * weight_step : 0.0);  // all fall alike: only the lowest approaches
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
      const std::size_t level = i / contacts;
      const double force = impulse[i] / weight_step, reference = expected[level].get<double>();
      forces(force, reference);
      curve.rows.push_back({static_cast<double>(level), force, reference});
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
  const std::vector<double> impulse =
      solved(problem_of(rows, {-g * weight_step, -g * weight_step, 0, 0, 0, 0}), chain);
  const std::array<std::pair<const char*, const char*>, 3> names{
      {{"floor_each", "floor"}, {"wall_each", "walls"}, {"top_pair_each", "upper disc"}}};
  for (std::size_t k = 0; k < names.size(); ++k) {
    Comparison forces;
    for (std::size_t i = 2 * k; i < 2 * k + 2; ++i)
      forces(impulse[i] / weight_step, of(data, names[k].first));
    page.rows.push_back(solver_row(
        "chain", std::string("force of the ") + names[k].second + " in a pyramid of three discs [N]", forces,
        clock.seconds()));
  }
}

}  // namespace

Page several_bodies() {
  Page page;
  page.name = "several_bodies";
  page.title = "Cradle, stacks and a pyramid";
  page.source = "enumeration of modes and statics, `contacts_planar.json`";
  page.text =
      "Newton's cradle (3 and 5 masses, four e), ten discs and ten blocks one above the other, and three "
      "smooth discs between walls. First as contact problems W P + b by themselves (impulses of a "
      "millisecond of weight, divided by it); then as simulations: discs in a row that the first one "
      "strikes, under both laws of impact (`ImpactOrder`), and bodies at rest under gravity for 0.1 s, whose "
      "forces are those of `Simulation::contact_forces()`.";
  page.figures = {{"cradles", "Velocities behind a cradle of five masses, event-driven runs."},
                  {"stacks", "Forces in the stacks by level from below; crosses: statics."}};
  SolverChain chain;
  add_cradle(page, chain);
  add_stacks(page, chain);
  add_pyramid(page, chain);
  add_runs_of_several_bodies(page);
  page.remarks =
      "For the cradle the law gives what all contacts do at once, not the passing on of the impact from mass "
      "to mass: with e = 1 three masses leave with −1/3, 2/3, 2/3 of the speed. That is the law's answer, "
      "not nature's; one contact after the other the impact is passed on, and with e = 1 the last mass "
      "leaves alone.\n\n"
      "Corners of blocks that lie exactly on corners are two contacts at one place, each a corner on the "
      "edge of the other block. How the two share the force is not unique: the rows of simulations compare "
      "their sum.\n\n"
      "Bodies at rest are run with the options as they come: the columns of options are empty. With "
      "`impacts = located` high stacks of blocks do not keep these digits: contacts that rounding opens are "
      "missing for a part of a step.";
  return page;
}

}  // namespace validation
