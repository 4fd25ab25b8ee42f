#include "validation/measure.h"
#include "validation/pages.h"
#include "validation/scenes.h"

namespace validation {
namespace {

/// An impact of the paper's example: r1 = r, r2 = -r, I = m r^2, mu = 1, speeds (v, -2 v), no spin; m = r = v
/// = 1.
struct Change {
  double energy = 0.0, normal = 0.0, tangential = 0.0;  // [J], [N s]
};
Change struck(double e_n, double e_t, const Mode& mode) {
  scenes::BodyScene scene = scenes::struck_point(
      {.mass = 1.0, .inertia = 1.0}, {-1.0, -1.0},
      {.friction = 1.0, .normal_restitution = e_n, .tangential_restitution = e_t}, {1.0, -2.0});
  Simulation simulation(std::move(scene.system), mode);
  const double before = simulation.energy().kinetic();
  const std::vector<Impact> impacts = impacts_until(simulation, 1e-6);
  return {simulation.energy().kinetic() - before, impacts.at(0).impulse[0], impacts.at(0).impulse[1]};
}

/// e_n at which the energy neither grows nor falls, by bisection.
double border(double e_t, const Mode& mode) {
  double low = 0.5, high = 1.0;
  for (int i = 0; i < 45; ++i) {
    const double middle = 0.5 * (low + high);
    (struck(middle, e_t, mode).energy > 0.0 ? high : low) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

Page johansson_energy() {
  Page page;
  page.name = "johansson_energy";
  page.title = "The impact that gains energy";
  page.source = "Johansson 1999, section 3.3";
  page.text =
      "With e_n ≠ e_t the law can add energy. The paper's example: r1 = r, r2 = −r, I = m r², μ = 1, speeds "
      "of the contact v along and −2v against the surface, no spin. It sticks for all e_n and e_t, and\n\n"
      "    ΔT = (m v²/3)(4 e_n² − 2 e_n e_t + e_t² − 3),    ΔT > 0 where e_n > (e_t + √(12 − 3 e_t²))/4\n\n"
      "The references are that formula (`impacts_planar.json`); m = r = v = 1, so that T = 2.5 J before.";
  page.figures = {{"energy_gain",
                   "ΔT/T of the impact as the library computes it, over both coefficients. Black: the border "
                   "by the formula; dots: by bisection with the library's impacts; dashed: e_t = e_n."}};
  const Json data = reference("impacts_planar.json", "energy_inconsistency");
  add_in_both_modes(page, {}, tight(), [&](Page& to, const Mode& mode) {
    const Clock clock;
    Comparison change, normal, tangential;
    for (const auto& at : data.at("values")) {
      const Change found = struck(of(at, "e_n"), of(at, "e_t"), mode);
      change(found.energy, of(at, "energy_change"));
      normal(found.normal, of(at, "Pn"));
      tangential(found.tangential, of(at, "Pt"));
    }
    const double cost = clock.seconds();
    to.rows.push_back(row(mode, "change of the kinetic energy [J]", change, cost));
    to.rows.push_back(row(mode, "normal impulse [N s]", normal, cost));
    to.rows.push_back(row(mode, "tangential impulse [N s]", tangential, cost));
    const Clock all;
    for (const auto& [e_n, e_t, share] :
         {std::array{1.0, 0.0, 2.0 / 15.0}, std::array{1.0, 0.5, 1.0 / 30.0}, std::array{1.0, 1.0, 0.0}}) {
      to.rows.push_back(row(mode, "ΔT/T at e_n = " + short_text(e_n) + ", e_t = " + short_text(e_t),
                            struck(e_n, e_t, mode).energy / 2.5, share, all.seconds()));
    }
  });
  const Clock clock;
  Comparison borders;
  Curve found{.name = "energy_gain_border", .columns = {"e_t", "e_n"}, .rows = {}};
  for (const auto& at : data.at("boundary_et_en")) {
    const double e_t = at[0].get<double>();
    if (e_t == 1.0) continue;  // there the border is the corner of the square
    found.rows.push_back({e_t, border(e_t, TimeStepping{})});
    borders(found.rows.back()[1], at[1].get<double>());
  }
  page.rows.push_back(row(TimeStepping{}, "e_n of the border ΔT = 0", borders, clock.seconds()));
  Curve map{.name = "energy_gain_map", .columns = {"e_t", "e_n", "share"}, .rows = {}};
  constexpr int cells = 60;
  for (int i = 0; i <= cells; ++i) {
    for (int j = 0; j <= cells; ++j) {
      const double e_t = 1.0 * i / cells, e_n = 1.0 * j / cells;
      map.rows.push_back({e_t, e_n, struck(e_n, e_t, TimeStepping{}).energy / 2.5});
    }
  }
  page.curves = {found, map};
  page.remarks =
      "Energy is gained in the corner of large e_n and small e_t. The library computes such impacts as the "
      "law says, reports them, and can refuse them (`impact_rules.energy_gain`). With e_n = e_t there is "
      "never a "
      "gain.";
  return page;
}

}  // namespace validation
