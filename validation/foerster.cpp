#include "validation/measure.h"
#include "validation/pages.h"
#include "validation/scenes.h"

namespace validation {
namespace {

/// A round body that strikes a wall with the unit normal speed: tangential speed of the contact after.
struct Struck {
  double tangential = 0.0, normal = 0.0;
  ContactMode mode = ContactMode::open;
};
Struck struck(double inertia_factor, const Surface& surface, double psi1, const Mode& mode) {
  constexpr double mass = 4.0e-5, radius = 1.59e-3;
  scenes::BodyScene scene =
      scenes::round_body({.mass = mass, .inertia = inertia_factor * mass * radius * radius}, radius, surface,
                         0.0, {psi1, -1.0}, 0.0);
  Simulation simulation(std::move(scene.system), mode);
  const Impact impact = impacts_until(simulation, 1e-6).at(0);
  return {impact.after[1], impact.after[0], impact.mode};
}

constexpr double sphere = 0.4;  // I/(m r^2)

/// Tangential speed of the contact after two equal free spheres have met with the unit normal speed.
double struck_each_other(const Surface& surface, double psi1, const Mode& mode) {
  constexpr double mass = 4.0e-5, radius = 1.59e-3;
  System system;
  system.set_default_law(surface);
  for (const double side : {1.0, -1.0}) {
    // An overlap of a rounding error, so that they touch at once.
    const BodyId body = system.add(RigidBody{.mass = solid_sphere(mass, radius),
                                             .position = {0.0, side * radius * (1.0 - 1e-15)},
                                             .velocity = {0.5 * side * psi1, -0.5 * side}});
    system.add(Disc{.body = body, .radius = radius});
  }
  Simulation simulation(std::move(system), mode);
  return impacts_until(simulation, 1e-6).at(0).after[1];
}

/// psi1 where sticking ends, by bisection.
double border(const Surface& surface, const Mode& mode) {
  double low = 0.0, high = 10.0;
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    (struck(sphere, surface, middle, mode).mode == ContactMode::stick ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// Both branches of two free spheres, in both modes.
void add_two_spheres(Page& page, const std::string& name, const Surface& surface) {
  const double drop = 3.5 * surface.friction * (1.0 + surface.normal_restitution);
  add_in_both_modes(page, TimeStepping{.step = 1e-6}, tight(), [&](Page& to, const Mode& mode) {
    const Clock clock;
    Comparison all;
    for (int i = 0; i <= 16; ++i) {
      const double psi1 = 0.25 * i;
      const bool sticks = (1.0 + surface.tangential_restitution) * psi1 <= drop;
      all(struck_each_other(surface, psi1, mode),
          sticks ? -surface.tangential_restitution * psi1 : psi1 - drop);
    }
    to.rows.push_back(row(mode, "ψ2 of " + name + ", two free spheres", all, clock.seconds()));
  });
}

void add_curve(Page& page, int number, const Surface& surface) {
  Curve curve{.name = "foerster_" + std::to_string(number), .columns = {"psi1", "psi2"}, .rows = {}};
  for (int i = 0; i <= 80; ++i) {
    const double psi1 = 0.05 * i;
    curve.rows.push_back({psi1, struck(sphere, surface, psi1, tight()).tangential});
  }
  page.curves.push_back(curve);
}

}  // namespace

Page foerster() {
  Page page;
  page.name = "foerster";
  page.title = "Oblique impacts of spheres";
  page.source =
      "Foerster, Louge, Chang and Allia, Phys. Fluids 6 (1994) 1108, `experiments.json`; Walton's law, "
      "`impacts_planar.json`";
  page.text =
      "Spheres that strike a wall or each other obliquely: ψ1 is the tangential over the normal speed of the "
      "contact before, ψ2 the tangential speed after over the normal one before. Foerster and others "
      "describe their measurements by three numbers, e, μ and β0: ψ2 = −β0 ψ1 as long as the contact sticks, "
      "that is up to ψ* = (7/2) μ (1 + e)/(1 + β0), and ψ2 = ψ1 − (7/2) μ (1 + e) beyond. For spheres this "
      "is the paper's law with e_t = β0, and the experiments test it: that three numbers describe both "
      "branches is their finding.\n\n"
      "The coefficients are the published ones as widely quoted; they were not checked against the paper "
      "itself, and those of plates are uncertain. No measured points are tabulated. Two equal spheres have "
      "the ratios of one and a wall: binary impacts are computed both ways. Acetate on the plate has no "
      "β0: only its slipping branch is compared.";
  page.figures = {{"foerster",
                   "ψ2 over ψ1 for the published coefficients, as the library computes them; circles: the "
                   "law in closed form. Falling: stick, rising: slip."}};
  const Mode mode = tight();
  int number = 0;
  for (const auto& at : reference("experiments.json", "foerster1994", "values")) {
    const bool sticks = !at.at("beta0").is_null();
    const Surface surface{.friction = of(at, "mu"),
                          .normal_restitution = of(at, "e"),
                          .tangential_restitution = sticks ? of(at, "beta0") : 0.0};
    const std::string name = at.at("case").get<std::string>();
    const Clock clock;
    if (sticks)
      page.rows.push_back(
          row(mode, "ψ* of " + name, border(surface, mode), of(at, "psi_star"), clock.seconds()));
    Comparison stick, slip;
    Curve law{.name = "foerster_law_" + std::to_string(number), .columns = {"psi1", "psi2"}, .rows = {}};
    const double drop = 3.5 * surface.friction * (1.0 + surface.normal_restitution);
    for (int i = 0; i <= 16; ++i) {
      const double psi1 = 0.25 * i;
      const bool at_stick = (1.0 + surface.tangential_restitution) * psi1 <= drop;
      if (at_stick && !sticks) continue;
      const double psi2 = at_stick ? -surface.tangential_restitution * psi1 : psi1 - drop;
      (at_stick ? stick : slip)(struck(sphere, surface, psi1, mode).tangential, psi2);
      law.rows.push_back({psi1, psi2});
    }
    if (sticks) page.rows.push_back(row(mode, "ψ2 of " + name + ", stick", stick, clock.seconds()));
    page.rows.push_back(row(mode, "ψ2 of " + name + ", slip", slip, clock.seconds()));
    if (name.find("binary") != std::string::npos) add_two_spheres(page, name, surface);
    page.curves.push_back(law);
    add_curve(page, number++, surface);
  }
  add_in_both_modes(page, TimeStepping{.step = 1e-6}, tight(), [&](Page& to, const Mode& each) {
    const Clock clock;
    Comparison all;
    for (const auto& curve : reference("impacts_planar.json", "walton_curves", "cases")) {
      const Surface surface{.friction = of(curve, "mu"),
                            .normal_restitution = of(curve, "e_n"),
                            .tangential_restitution = of(curve, "beta0")};
      for (const auto& point : curve.at("curve_psi1_psi2_mode"))
        all(struck(of(curve, "I_over_m_r2"), surface, point[0].get<double>(), each).tangential,
            point[1].get<double>());
    }
    to.rows.push_back(row(each, "ψ2 of Walton's curves, spheres and discs", all, clock.seconds()));
  });
  page.remarks =
      "The library follows the law to rounding; how well the law describes the spheres is said by the "
      "scatter of the published coefficients (e ± 0.01, μ ± 0.006, β0 ± 0.07 for glass). [Alumina on "
      "glass](kharaz.md) is compared with measured points.";
  return page;
}

Page kharaz() {
  constexpr double mass_of_one = 1.0, radius = 2.5e-3, speed = 3.9;  // [kg], [m], [m/s]; the mass drops out
  constexpr double slides_from =
      35.0;  // impact angle beyond which the contact slips, for either e_t [degrees]
  Page page;
  page.name = "kharaz";
  page.title = "Alumina sphere on glass";
  page.source =
      "Kharaz, Gorham and Salman, Powder Technology 120 (2001) 281, digitised points, `experiments.json`";
  page.text =
      "A sphere of 5 mm strikes a thick glass anvil at 3.9 m/s without spin, at angles of 0 to 60 degrees "
      "from the normal: e_n = 0.98, μ = 0.092. Measured are the spin and the speed and direction of the "
      "centre after the impact. The points are digitised, to about 1 to 2 percent.\n\n"
      "This is an experiment, not a computed reference: the errors below are those of the law.";
  page.figures = {{"kharaz",
                   "Measured points and the law, with e_t = 0 and 0.3. Beyond about 30 degrees the contact "
                   "slips and the law holds; below it sticks, and there the elastic contact is not rigid."}};
  const double degree = pi / 180.0;
  const auto after = [&](double angle, double e_t) {
    scenes::BodyScene scene =
        scenes::round_body(solid_sphere(mass_of_one, radius), radius,
                           {.friction = 0.092, .normal_restitution = 0.98, .tangential_restitution = e_t},
                           0.0, {speed * std::sin(angle * degree), -speed * std::cos(angle * degree)}, 0.0);
    Simulation simulation(std::move(scene.system), tight());
    simulation.run_until(1e-6);
    const State& state = simulation.state();
    const double x = state.velocity(scene.body)[0], y = state.velocity(scene.body)[1];
    return std::array{std::abs(state.spin(scene.body)), x / (speed * std::sin(angle * degree)),
                      std::atan2(x, y) / degree};
  };
  const Json data = reference("experiments.json", "kharaz2001");
  const std::array<std::array<const char*, 3>, 3> series{
      {{"omega", "angle_omega", "spin after [rad/s]"},
       {"ratio", "angle_ratio", "tangential speed of the centre, after/before"},
       {"rebound", "angle_rebound", "angle of rebound [degrees]"}}};
  for (const double e_t : {0.0, 0.3}) {
    const std::string with = ", e_t = " + short_text(e_t);
    for (std::size_t k = 0; k < series.size(); ++k) {
      const Clock clock;
      Comparison law, sliding, sticking;
      for (const auto& at : data.at(e_t == 0.0 ? "prediction_et_0" : "prediction_et_0.3").at(series[k][0])) {
        const double angle = at[0].get<double>(), found = after(angle, e_t)[k],
                     measured = at[2].get<double>();
        law(found, at[1].get<double>());
        (angle > slides_from ? sliding : sticking)(found, measured, std::abs(measured));
      }
      const std::string quantity = series[k][2] + with;
      page.rows.push_back(row(tight(), quantity + ", against the law", law, clock.seconds()));
      page.rows.push_back(
          row(tight(), quantity + ", against measurements above 35°", sliding, clock.seconds()));
      page.rows.push_back(
          row(tight(), quantity + ", against measurements below 35°", sticking, clock.seconds()));
    }
    Curve line{
        .name = "kharaz_et" + short_text(e_t), .columns = {"angle", "omega", "ratio", "rebound"}, .rows = {}};
    for (int i = 1; i <= 130; ++i) {
      const double angle = 0.5 * i;
      const auto found = after(angle, e_t);
      line.rows.push_back({angle, found[0], found[1], found[2]});
    }
    page.curves.push_back(line);
  }
  for (const auto& each : series) {
    Curve points{
        .name = std::string("kharaz_measured_") + each[0], .columns = {"angle", "value"}, .rows = {}};
    for (const auto& at : data.at("measured").at(each[1]))
      points.rows.push_back({at[0].get<double>(), at[1].get<double>()});
    page.curves.push_back(points);
  }
  page.remarks =
      "Where the contact slips the law agrees with the points about as well as they are known, but for the "
      "spin at 60°, whatever e_t. Where it sticks it does not: the tangential compliance of the contact "
      "stores energy and gives it back, and no single e_t describes all angles. That is a limit of the rigid "
      "law, not of the computation.";
  return page;
}

}  // namespace validation
