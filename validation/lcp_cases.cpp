#include "validation/measure.h"
#include "validation/pages.h"

#include <carom/core/numerics/lcp.h>
#include <carom/core/numerics/lemke.h>
#include <carom/core/numerics/principal_pivoting.h>

#include <algorithm>
#include <map>
#include <optional>

namespace validation {
namespace {

Lcp lcp_of(const Json& at) {
  Lcp lcp;
  lcp.reset(at.at("n").get<int>());
  for (int i = 0; i < lcp.size; ++i) {
    const auto k = static_cast<std::size_t>(i);
    lcp.q[k] = at.at("q")[k].get<double>();
    for (int j = 0; j < lcp.size; ++j)
      lcp.at(i, j) = at.at("M")[k][static_cast<std::size_t>(j)].get<double>();
  }
  return lcp;
}

/// Status as the file names it; nothing where none is recorded.
std::optional<LcpStatus> recorded(const Json& at, const char* key, const char* rule) {
  if (!at.contains(key)) return {};
  const auto name = at.at(key).at(rule)[0].get<std::string>();
  if (name == "solved" || name == "trivial") return LcpStatus::solved;
  if (name == "ray") return LcpStatus::secondary_ray;
  if (name == "singular") return LcpStatus::vanishing_pivot;
  return LcpStatus::pivot_bound;
}

/// Solution z nearest to what was found, if solutions are isolated.
void compare_solution(const Json& at, const std::vector<double>& z, Comparison& values) {
  const bool continuum = at.contains("continua") && !at.at("continua").empty();
  if (continuum || !at.contains("solutions_z") || at.at("solutions_z").empty()) return;
  const Json* nearest = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& known : at.at("solutions_z")) {
    double far = 0.0;
    for (std::size_t i = 0; i < z.size(); ++i) far = std::max(far, std::abs(z[i] - known[i].get<double>()));
    if (far >= least) continue;
    least = far;
    nearest = &known;
  }
  for (std::size_t i = 0; i < z.size(); ++i) {
    const double known = (*nearest)[i].get<double>();
    values(z[i], known, std::max(1.0, std::abs(known)));
  }
}

template <class Solver>
void add_lcp(Page& page, const std::string& name, const char* key, const char* rule, double column,
             Curve& statuses) {
  constexpr int bound = 5000;  // on pivots, as in the record
  const Clock clock;
  Comparison values;
  std::map<std::string, int> counts;
  int agree = 0, compared = 0, number = 0;
  double worst = 0.0;
  for (const auto& at : reference("lcp_cases.json", "cases")) {
    const Lcp lcp = lcp_of(at);
    std::vector<double> z(static_cast<std::size_t>(lcp.size));
    Solver solver;
    const LcpAnswer answer = solver.solve(lcp, z, bound);
    ++counts[std::string(to_string(answer.status))];
    if (answer.status == LcpStatus::solved) {
      compare_solution(at, z, values);
      worst = std::max(worst, lcp_residual(lcp, z));
    }
    if (const auto expected = recorded(at, key, rule)) {
      ++compared;
      agree += *expected == answer.status ? 1 : 0;
    }
    statuses.rows.push_back({column, 1.0 * number++, 1.0 * static_cast<double>(answer.status),
                             1.0 * answer.pivots, 1.0 * lcp.size});
  }
  const double cost = clock.seconds();
  page.rows.push_back(solver_row(name, "z of problems with isolated solutions", values, cost));
  Comparison residual;
  residual(worst, 0.0);
  page.rows.push_back(solver_row(name, "largest residual of a solved problem", residual, cost));
  const auto count = [&](const std::string& quantity, const std::string& expected, int found) {
    page.rows.push_back(
        Row{solver_name, name, quantity, expected, std::to_string(found), unknown, unknown, cost, {}});
  };
  count("problems that end as recorded", std::to_string(compared), agree);
  for (const auto& [status, times] : counts) count("problems that end with: " + status, "–", times);
}

}  // namespace

Page lcp_cases() {
  Page page;
  page.name = "lcp_cases";
  page.title = "Linear complementarity problems";
  page.source = "solutions in exact rationals, `lcp_cases.json`";
  page.text =
      "57 problems w = q + M z up to n = 30, among them those on which Lemke's method needs 2ⁿ pivots, those "
      "that end in a ray though there is a solution, and those on which principal pivoting cycles or divides "
      "by zero. Both methods are run with a bound of 5,000 pivots, and how they end is compared with the "
      "behaviour recorded for exact arithmetic.";
  page.figures = {
      {"lcp_cases", "How each method ends on each problem, in the order of the file, with its pivots."}};
  Curve statuses{.name = "lcp_cases", .columns = {"method", "problem", "status", "pivots", "n"}, .rows = {}};
  add_lcp<Lemke>(page, "Lemke", "lemke_ones_status_pivots_by_tie_rule", "lex", 0.0, statuses);
  add_lcp<PrincipalPivoting>(page, "principal pivoting", "principal_pivoting_status_flips", "least", 1.0,
                             statuses);
  page.curves = {statuses};
  page.remarks =
      "A method that does not solve a problem says so by name: a secondary ray, a vanishing pivot, the bound "
      "on pivots. None ends with a wrong answer.";
  return page;
}

}  // namespace validation
