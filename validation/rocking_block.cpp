#include "validation/measure.h"
#include "validation/pages.h"
#include "validation/scenes.h"

namespace validation {
namespace {

struct Rocking {
  double quarter = unknown;                  // time of the first impact [s]
  double before = unknown, after = unknown;  // spins [rad/s]
  double amplitude = 0.0;                    // next tilt to the other side [rad]
};

Rocking rocked(double b, double h, double tilt, double quarter, const Mode& mode) {
  const bool stepping = std::holds_alternative<TimeStepping>(mode);
  scenes::BodyScene scene = scenes::rocking_block(b, h, tilt, stepping ? 1e-9 : 0.0);
  Simulation simulation(std::move(scene.system), mode);
  Rocking found;
  double spin = 0.0;
  simulation.observe([&](const Simulation& now) {
    const double at = now.state().spin(scene.body);
    found.amplitude = std::max(found.amplitude, -now.state().angle(scene.body));
    if (!stepping) return;
    for (const ContactRecord& contact : now.report().contacts) {
      const bool other_corner = now.name(contact.key).find("'right'") != std::string::npos;
      if (!contact.impact || !other_corner || !std::isnan(found.quarter)) continue;
      found.quarter = contact.time;
      found.before = spin;
      found.after = at;
    }
    spin = at;
  });
  simulation.run_until(2.5 * quarter);  // beyond the next turning point
  const auto impacts = events_of(simulation, EventKind::impact);
  if (!impacts.empty()) {
    // The kinetic energy is that of a turn about a corner.
    const double inertia = 4.0 / 3.0 * (b * b + h * h);
    found.quarter = impacts[0].time;
    found.before = -std::sqrt(2.0 * impacts[0].energy_before / inertia);
    found.after = -std::sqrt(2.0 * impacts[0].energy_after / inertia);
  }
  return found;
}

struct Block {
  const char* name;
  double b, h;
};
constexpr std::array blocks{Block{"b0.2_h0.8", 0.2, 0.8}, Block{"b0.5_h1.0", 0.5, 1.0}};

Curve tilt_of(const std::string& name, const Mode& mode) {
  scenes::BodyScene scene =
      scenes::rocking_block(0.2, 0.8, 0.1, std::holds_alternative<TimeStepping>(mode) ? 1e-9 : 0.0);
  Simulation simulation(std::move(scene.system), mode);
  Curve curve{.name = name, .columns = {"time [s]", "tilt [rad]"}, .rows = {}};
  for (int i = 0; i <= 500; ++i) {
    if (i > 0) simulation.run_until(0.01 * i);
    curve.rows.push_back({0.01 * i, simulation.state().angle(scene.body)});
  }
  return curve;
}

}  // namespace

Page rocking_block() {
  Page page;
  page.name = "rocking_block";
  page.title = "Rocking block";
  page.source = "Housner, Bull. Seism. Soc. Am. 53 (1963) 403; exact quadratures, `contacts_planar.json`";
  page.text =
      "A uniform rectangle is let go tilted about a corner, falls on its base with e_n = e_t = 0 and enough "
      "friction (μ = 2), and goes on over the other corner with 1 − (3/2) sin²α of its spin (α: angle of its "
      "diagonal to its height). Two blocks, four tilts each; quarter period, spins before and after the "
      "first impact, and the next tilt are known exactly.";
  page.figures = {{"rocking_block",
                   "Tilt of the block of 0.4 m x 1.6 m, let go at 0.1 rad: line, event-driven; dashed, time "
                   "stepping with h = 2 ms."}};
  const Json data = reference("contacts_planar.json", "rocking_block", "cases");
  EventDriven fine = tight();
  fine.interval = 1e-3;  // the tilt is looked at this often
  add_in_both_modes(page, TimeStepping{.step = 1e-4}, fine, [&](Page& to, const Mode& mode) {
    const Clock clock;
    Comparison quarter, before, after, ratio, amplitude;
    for (const Block& block : blocks) {
      const Json& at = data.at(block.name);
      for (const auto& row_of : at.at("rows")) {
        const Rocking found =
            rocked(block.b, block.h, of(row_of, "theta0"), of(row_of, "quarter_period_exact"), mode);
        quarter(found.quarter, of(row_of, "quarter_period_exact"));
        before(found.before, of(row_of, "omega_before_impact"));
        after(found.after, of(row_of, "omega_after_impact"));
        ratio(found.after / found.before, of(at, "omega_ratio"));
        amplitude(found.amplitude, of(row_of, "next_amplitude_exact"));
      }
    }
    const double cost = clock.seconds();
    double order = unknown;
    if (has_order(mode)) {
      const Json& at = data.at("b0.2_h0.8").at("rows")[1];
      order = analytic::mean_order(2e-3, 4, 24, [&](double h) {
                const Rocking found = rocked(0.2, 0.8, of(at, "theta0"), of(at, "quarter_period_exact"),
                                             TimeStepping{.step = h});
                return std::abs(found.quarter - of(at, "quarter_period_exact"));
              }).slope;
    }
    to.rows.push_back(row(mode, "quarter period [s]", quarter, cost, order));
    to.rows.push_back(row(mode, "spin before the impact [rad/s]", before, cost));
    to.rows.push_back(row(mode, "spin after the impact [rad/s]", after, cost));
    to.rows.push_back(row(mode, "ratio of spins", ratio, cost));
    to.rows.push_back(row(mode, "next tilt, largest seen [rad]", amplitude, cost));
  });
  page.curves = {tilt_of("rocking_events", tight()), tilt_of("rocking_stepping", TimeStepping{.step = 2e-3})};
  page.remarks =
      "The largest tilt is looked for every millisecond: event-driven, that is the error of its row. In time "
      "stepping the block falls below its base by up to a step before the impact is noticed.";
  return page;
}

}  // namespace validation
