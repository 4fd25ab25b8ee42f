#include "validation/measure.h"
#include "validation/pages.h"
#include "validation/scenes.h"

namespace validation {
namespace {

constexpr double mass = 0.1134, radius = 0.0359, drop = 0.799;  // [kg], [m], [m]
constexpr double later = 0.1;                                   // after the impact [s]

struct After {
  double spin, speed;  // horizontal
};
After dropped(const Surface& surface, double spin, const Mode& mode) {
  scenes::BodyScene scene =
      scenes::round_body(thin_shell(mass, radius), radius, surface, drop, {0.0, 0.0}, spin);
  Simulation simulation(std::move(scene.system), mode);
  simulation.run_until(std::sqrt(2.0 * drop / g) + later);
  return {simulation.state().spin(scene.body), simulation.state().velocity(scene.body)[0]};
}

Surface surface_of(const Json& result) {
  return {.friction = of(result, "mu"),
          .normal_restitution = of(result, "e_n"),
          .tangential_restitution = of(result, "e_t")};
}

std::string name_of(const Surface& surface) {
  return "μ = " + short_text(surface.friction) + ", e_n = " + short_text(surface.normal_restitution) +
         ", e_t = " + short_text(surface.tangential_restitution);
}

Halvings refined(const Json& result) {
  // Slipping: the impulse of friction is that of the normal, which depends on when the impact is noticed.
  const Json& row = result.at("rows").back();
  const analytic::MeanOrder found = analytic::mean_order(2e-3, 4, 24, [&](double h) {
    return std::abs(dropped(surface_of(result), of(row, "spin_before"), TimeStepping{.step = h}).spin -
                    of(row, "spin_after"));
  });
  return {found.steps, found.errors, 0.0};
}

}  // namespace

Page johansson_horak() {
  Page page;
  page.name = "johansson_horak";
  page.title = "Horak's ball";
  page.source = "Johansson 1999, section 5, figure 5";
  page.text =
      "A thin-walled ball (0.1134 kg, radius 0.0359 m) with spin is dropped 0.799 m onto a rough floor, and "
      "its spin afterwards is drawn over that before. The paper has μ = 0.24, e_n = 0.82 with e_t = 0 and "
      "with e_t = e_n, and the values that fit the experiments, μ = 0.08, e_t = e_n = 0.92.\n\n"
      "What the paper leaves open: the points measured by Horak are not tabulated there, so that the "
      "references are the law in closed form (`impacts_planar.json`), not the experiment. Rolling "
      "resistance, which is left out of the paper's law, is left out here too.";
  page.figures = {
      {"figure5_horak",
       "Figure 5 of the paper. Lines: event-driven runs; crosses: closed forms. Each line has a part that "
       "sticks, through the origin, and a part that slips, parallel to the dotted line of equal spins."}};
  const Json results = reference("impacts_planar.json", "horak", "results");
  const std::vector<Mode> modes{TimeStepping{.step = 1e-4}, tight()};
  for (const Mode& mode : modes) {
    for (const auto& [name, result] : results.items()) {
      const Clock clock;
      Comparison spins;
      for (const auto& at : result.at("rows"))
        spins(dropped(surface_of(result), of(at, "spin_before"), mode).spin, of(at, "spin_after"));
      const double cost = clock.seconds();
      const bool stepping = std::holds_alternative<TimeStepping>(mode);
      page.rows.push_back(row(mode, "spin after, " + name_of(surface_of(result)) + " [rad/s]", spins, cost,
                              stepping ? refined(result).order() : unknown));
    }
  }
  for (const auto& [name, result] : results.items()) {
    Curve line{.name = "horak_" + name, .columns = {"before [rad/s]", "after [rad/s]"}, .rows = {}};
    for (int spin = 0; spin <= 200; spin += 2)
      line.rows.push_back({1.0 * spin, dropped(surface_of(result), spin, tight()).spin});
    page.curves.push_back(line);
    Curve points{.name = "horak_reference_" + name, .columns = line.columns, .rows = {}};
    for (const auto& at : result.at("rows"))
      points.rows.push_back({of(at, "spin_before"), of(at, "spin_after")});
    page.curves.push_back(points);
  }
  page.remarks =
      "With e_t = 0 a ball that sticks keeps 2/5 of its spin, with e_t = e_n its spin turns round slightly; "
      "beyond, all lose the same spin to sliding friction. In time stepping the speed of the impact depends "
      "on when within its step it is noticed, and a slipping ball's friction with it: order 1.";
  return page;
}

}  // namespace validation
