#include "validation/contact_rows.h"
#include "validation/measure.h"
#include "validation/pages.h"
#include "validation/scenes.h"

#include <carom/contact/solvers/solver_chain.h>

#include <algorithm>

namespace validation {
namespace {

/// Impulses of contacts of one body with a floor, by points; the body's velocity before and the law.
struct BodyOnFloor {
  double mass = 1.0, inertia = 1.0;
  std::vector<Vec<2>> points;        // from the centre
  std::array<double, 3> velocity{};  // x, y, spin
  double e_n = 0.0, e_t = 0.0, friction = 0.0;
};
ContactProblem problem_of(const BodyOnFloor& body, std::vector<double>& before) {
  Rows rows{.h = {}, .inverse_mass = {1.0 / body.mass, 1.0 / body.mass, 1.0 / body.inertia}};
  for (const Vec<2>& point : body.points) {
    rows.h.push_back({0.0, 1.0, point[0]});
    rows.h.push_back({1.0, 0.0, -point[1]});
  }
  std::vector<double> b;
  before.clear();
  for (std::size_t i = 0; i < rows.h.size(); ++i) {
    double sum = 0.0;
    for (std::size_t k = 0; k < 3; ++k) sum += rows.h[i][k] * body.velocity[k];
    before.push_back(sum);
    b.push_back((1.0 + (i % 2 == 0 ? body.e_n : body.e_t)) * sum);
  }
  ContactProblem problem = problem_of(rows, b);
  for (std::size_t i = 1; i < rows.h.size(); i += 2)
    problem.sets()[i] = {
        .kind = SetKind::bounded_interval, .bound = static_cast<int>(i) - 1, .coefficient = body.friction};
  problem.group();
  return problem;
}

struct RandomContact {
  BodyOnFloor body;
  std::vector<std::vector<double>> impulses;  // of each solution: normal, tangential, by contact
};

std::vector<RandomContact> random_single() {
  std::vector<RandomContact> all;
  for (const auto& at : reference("open_variants.json", "single_contact")) {
    const auto point = at.at("contact_from_centre").get<std::vector<double>>();
    const auto v = at.at("v_minus").get<std::vector<double>>();
    RandomContact contact{{.mass = of(at, "m"),
                           .inertia = of(at, "I"),
                           .points = {Vec<2>(point[0], point[1])},
                           .velocity = {v[0], v[1], 0.0},
                           .e_n = of(at, "e_n"),
                           .e_t = of(at, "e_t"),
                           .friction = of(at, "mu")},
                          {}};
    for (const auto& solution : at.at("solutions"))
      contact.impulses.push_back({solution[2].get<double>(), solution[1].get<double>()});
    all.push_back(contact);
  }
  return all;
}

std::vector<RandomContact> random_double() {
  std::vector<RandomContact> all;
  for (const auto& at : reference("open_variants.json", "two_contacts")) {
    RandomContact contact{{.mass = of(at, "m"),
                           .inertia = of(at, "I"),
                           .points = {},
                           .velocity = {},
                           .e_n = of(at, "e_n"),
                           .e_t = of(at, "e_t"),
                           .friction = of(at, "mu")},
                          {}};
    for (const auto& point : at.at("points"))
      contact.body.points.push_back({point[0].get<double>(), point[1].get<double>()});
    for (std::size_t k = 0; k < 3; ++k) contact.body.velocity[k] = at.at("body_velocity")[k].get<double>();
    for (const auto& solution : at.at("solutions")) {
      const auto p = solution.at("impulses_t_n").get<std::vector<double>>();
      contact.impulses.push_back({p[1], p[0], p[3], p[2]});
    }
    all.push_back(contact);
  }
  return all;
}

void add_random(Page& page, const std::string& what, const std::vector<RandomContact>& all,
                Curve& residuals) {
  SolverChain chain;
  for (std::size_t k = 0; k < solver_count; ++k) {
    const SolverId solver = all_solvers[k];
    const Clock clock;
    Comparison impulses;
    int answered = 0;
    double worst = 0.0;
    for (std::size_t c = 0; c < all.size(); ++c) {
      std::vector<double> before;
      const ContactProblem problem = problem_of(all[c].body, before);
      std::vector<double> impulse(before.size());
      const ContactReport report = chain.solve_with(solver, problem, impulse);
      if (!report.usable()) continue;
      ++answered;
      worst = std::max(worst, report.residual);
      residuals.rows.push_back({1.0 * static_cast<double>(k),
                                1.0 * static_cast<double>(all[c].body.points.size()), report.residual});
      // Any of the solutions is right: the nearest is compared.
      const auto far = [&](const std::vector<double>& known) {
        double largest = 0.0;
        for (std::size_t i = 0; i < known.size(); ++i)
          largest = std::max(largest, std::abs(known[i] - impulse[i]));
        return largest;
      };
      const auto nearest = std::min_element(all[c].impulses.begin(), all[c].impulses.end(),
                                            [&](const auto& a, const auto& b) { return far(a) < far(b); });
      for (std::size_t i = 0; i < nearest->size(); ++i) impulses(impulse[i], (*nearest)[i]);
    }
    if (answered == 0) continue;  // not made for such problems
    const std::string name(solver_names[k]);
    page.rows.push_back({solver_name,
                         name,
                         what + ": problems solved",
                         std::to_string(all.size()),
                         std::to_string(answered),
                         unknown,
                         unknown,
                         clock.seconds(),
                         {}});
    page.rows.push_back(solver_row(name, what + ": impulses [N s]", impulses, clock.seconds()));
    Comparison certificate;
    certificate(worst, 0.0);
    page.rows.push_back(solver_row(name, what + ": largest certificate", certificate, clock.seconds()));
  }
}

void add_random_events(Page& page, const std::vector<RandomContact>& all) {
  const Clock clock;
  Comparison impulses;
  for (const RandomContact& contact : all) {
    if (contact.body.velocity[1] >= 0.0) continue;  // no impact
    const BodyOnFloor& body = contact.body;
    scenes::BodyScene scene = scenes::struck_point(
        {.mass = body.mass, .inertia = body.inertia}, body.points[0],
        {.friction = body.friction, .normal_restitution = body.e_n, .tangential_restitution = body.e_t},
        {body.velocity[0], body.velocity[1]});
    Simulation simulation(std::move(scene.system), tight());
    const Impact impact = impacts_until(simulation, 1e-6).at(0);
    std::array<double, 2> nearest{unknown, unknown};
    double least = std::numeric_limits<double>::infinity();
    for (const auto& known : contact.impulses) {
      const double far = std::abs(known[0] - impact.impulse[0]) + std::abs(known[1] - impact.impulse[1]);
      if (far >= least) continue;
      least = far;
      nearest = {known[0], known[1]};
    }
    for (std::size_t i = 0; i < 2; ++i) impulses(impact.impulse[i], nearest[i]);
  }
  page.rows.push_back(row(tight(), "one contact: impulses [N s]", impulses, clock.seconds()));
}

}  // namespace

Page random_contacts() {
  Page page;
  page.name = "random_contacts";
  page.title = "Random contacts";
  page.source = "enumeration of open, stick, slip+ and slip−, `open_variants.json`";
  page.text =
      "Forty impacts of one contact and twenty of two contacts of one body, with random masses, places, "
      "speeds and coefficients: solved by each solver that is made for them, and the single ones in "
      "event-driven runs too.";
  page.figures = {{"random_contacts",
                   "Certificates of all answers, by solver; the dashed line is the limit below which an "
                   "answer is taken at once."}};
  Curve residuals{.name = "random_contacts", .columns = {"solver", "contacts", "certificate"}, .rows = {}};
  add_random(page, "one contact", random_single(), residuals);
  add_random(page, "two contacts", random_double(), residuals);
  add_random_events(page, random_single());
  page.curves = {residuals};
  page.remarks =
      "Certificates are residuals relative to the largest impulse: rounding. Impulses of two contacts are "
      "less well conditioned than velocities, since W has rank 3 of 4.";
  return page;
}

}  // namespace validation
