#include "validation/several_bodies_runs.h"

#include "validation/measure.h"

namespace validation {
namespace {

/// A disc of 1 kg. \param radius [m]
BodyId add_disc(System& system, double radius, const Vec<2>& place, double speed = 0.0) {
  const BodyId body =
      system.add(RigidBody{.mass = disc(1.0, radius), .position = place, .velocity = {speed, 0.0}});
  system.add(Disc{.body = body, .radius = radius});
  return body;
}

/// A square block of 1 kg. \param half half its side [m]
BodyId add_block(System& system, double half, const Vec<2>& place) {
  const BodyId body = system.add(RigidBody{.mass = box(1.0, 2.0 * half, 2.0 * half), .position = place});
  system.add(Polygon{.body = body, .vertices = {{-half, -half}, {half, -half}, {half, half}, {-half, half}}});
  return body;
}

/// Velocities behind a cradle: smooth discs in a row that touch, all but the first, which arrives with 1 m/s.
std::vector<double> behind_cradle(std::size_t discs, double restitution, const Mode& mode) {
  // Powers of two: the discs touch exactly.
  constexpr double radius = 0.125, way = 0.5, arrival = 0.5, afterwards = 0.1;
  System system;
  system.set_default_law({.friction = 0.0, .normal_restitution = restitution});
  std::vector<BodyId> bodies{add_disc(system, radius, {-way, 0.0}, 1.0)};
  for (std::size_t i = 1; i < discs; ++i)
    bodies.push_back(add_disc(system, radius, {2.0 * radius * static_cast<double>(i), 0.0}));
  Simulation simulation(std::move(system), mode);
  simulation.run_until(arrival + afterwards);
  std::vector<double> velocities;
  velocities.reserve(discs);
  for (const BodyId body : bodies) velocities.push_back(simulation.state().velocity(body)[0]);
  return velocities;
}

constexpr std::size_t drawn_discs = 5;

/// Velocities behind a cradle by the number of the disc.
Curve cradle_curve(ImpactOrder order, double restitution, const std::vector<double>& found,
                   const Json& expected) {
  Curve curve{.name = "cradle_" + std::string(to_string(order)) + "_e" + short_text(restitution),
              .columns = {"mass", "velocity [m/s]", "reference [m/s]"},
              .rows = {}};
  for (std::size_t i = 0; i < found.size(); ++i)
    curve.rows.push_back({static_cast<double>(i + 1), found[i], expected.at(i).get<double>()});
  return curve;
}

void add_cradles(Page& page, Mode mode, ImpactOrder order) {
  std::visit([order](auto& options) { options.impact_rules.order = order; }, mode);
  const bool sequential = order == ImpactOrder::sequential;
  const Clock clock;
  Comparison velocities;
  for (const auto& at : reference("contacts_planar.json", "newton_cradle", "cases")) {
    const Json& expected =
        sequential ? at.at("sequential_velocities") : at.at("simultaneous_velocities").at(0);
    const std::vector<double> found = behind_cradle(at.at("N").get<std::size_t>(), of(at, "e"), mode);
    for (std::size_t i = 0; i < found.size(); ++i) velocities(found[i], expected.at(i).get<double>());
    if (found.size() == drawn_discs && std::holds_alternative<EventDriven>(mode))
      page.curves.push_back(cradle_curve(order, of(at, "e"), found, expected));
  }
  const char* const law = sequential ? "one contact after the other" : "all contacts at once";
  page.rows.push_back(row(mode, std::string("velocities behind Newton's cradle, ") + law + " [m/s]",
                          velocities, clock.seconds()));
}

/// Normal forces between the bodies of a stack and under it, by level from below and by side. Corners that
/// meet exactly are two contacts at one place, each a corner on the edge of the other block: how they share
/// the force there is not unique, its sum is.
std::vector<double> forces_by_place(const std::vector<LastingContact>& contacts, std::size_t levels,
                                    std::size_t sides, double height) {
  std::vector<double> sums(levels * sides);
  for (const LastingContact& contact : contacts) {
    const auto level = static_cast<std::size_t>(std::lround(contact.point[1] / height));
    const std::size_t side = sides == 2 && contact.point[0] > 0.0 ? 1 : 0;
    sums.at(level * sides + side) += contact.force[0];  // all normals are vertical
  }
  return sums;
}

void add_stack(Page& page, const Mode& mode, bool blocks) {
  constexpr double half = 0.1, duration = 0.1;
  constexpr std::size_t n = 10;
  System system;
  system.add(Gravity{{0.0, -g}});
  system.set_default_law({.friction = 0.3, .normal_restitution = 0.0});
  system.add(HalfPlane{.normal = {0.0, 1.0}});
  for (std::size_t i = 0; i < n; ++i) {
    const Vec<2> place{0.0, (2.0 * static_cast<double>(i) + 1.0) * half};
    blocks ? add_block(system, half, place) : add_disc(system, half, place);
  }
  const Clock clock;
  Simulation simulation(std::move(system), mode);
  simulation.run_until(duration);
  const std::size_t sides = blocks ? 2 : 1;
  const std::vector<double> found = forces_by_place(simulation.contact_forces(), n, sides, 2.0 * half);
  const Json data = reference("contacts_planar.json", "static_stack");
  const Json& expected = data.at(blocks ? "block_corner_forces_bottom_up" : "disc_contact_forces_bottom_up");
  Comparison forces;
  for (std::size_t i = 0; i < found.size(); ++i) forces(found[i], expected.at(i / sides).get<double>());
  page.rows.push_back(row(
      mode, blocks ? "forces at corners of a stack of ten blocks [N]" : "forces in a stack of ten discs [N]",
      forces, clock.seconds()));
}

/// Three smooth discs between walls, described at rest.
void add_pyramid(Page& page, const Mode& mode) {
  constexpr double r = 0.1, x = r + 0.5e-3 * r, duration = 0.1;
  System system;
  system.add(Gravity{{0.0, -g}});
  system.set_default_law({.friction = 0.0, .normal_restitution = 0.0});
  const ObstacleId floor = system.add(HalfPlane{.normal = {0.0, 1.0}});
  for (const double side : {1.0, -1.0})
    system.add(HalfPlane{.point = {-side * (x + r), 0.0}, .normal = {side, 0.0}});
  std::vector<BodyId> bodies;
  for (const double side : {1.0, -1.0}) bodies.push_back(add_disc(system, r, {-side * x, r}));
  const BodyId top = add_disc(system, r, {0.0, r + std::sqrt(4.0 * r * r - x * x)});
  const Clock clock;
  Simulation simulation(std::move(system), mode);
  simulation.run_until(duration);
  const std::vector<LastingContact> contacts = simulation.contact_forces();
  // Zero where a contact is missing.
  const auto force_between = [&](BodyId body, auto&& touches) {
    double sum = 0.0;
    for (const LastingContact& at : contacts) {
      if ((at.body == body || at.other == body) && touches(at)) sum += at.force[0];
    }
    return sum;
  };
  const Json data = reference("contacts_planar.json", "three_disc_pyramid");
  Comparison forces;
  for (const BodyId body : bodies) {
    forces(force_between(body, [&](const auto& at) { return at.obstacle == floor; }), of(data, "floor_each"));
    forces(force_between(body, [&](const auto& at) { return at.obstacle.valid() && at.obstacle != floor; }),
           of(data, "wall_each"));
    forces(force_between(body, [&](const auto& at) { return at.body == top || at.other == top; }),
           of(data, "top_pair_each"));
  }
  page.rows.push_back(row(mode, "forces in a pyramid of three discs [N]", forces, clock.seconds()));
}

}  // namespace

void add_runs_of_several_bodies(Page& page) {
  const TimeStepping stepping{.step = 1e-3};
  add_in_both_modes(page, stepping, tight(), [](Page& to, const Mode& mode) {
    for (const ImpactOrder order : {ImpactOrder::simultaneous, ImpactOrder::sequential})
      add_cradles(to, mode, order);
  });
  // Without options: where impacts are located, forces at corners depend on rounding (remarks of the page).
  for (const Mode& mode : {Mode(stepping), Mode(tight())}) {
    for (const bool blocks : {false, true}) add_stack(page, mode, blocks);
    add_pyramid(page, mode);
  }
}

}  // namespace validation
