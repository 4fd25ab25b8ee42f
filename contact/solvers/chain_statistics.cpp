#include <carom/contact/solvers/contact_report.h>
#include <carom/core/enum_name.h>

#include <algorithm>
#include <iomanip>
#include <ostream>

namespace carom {

std::string_view to_string(SolverId solver) { return enum_name(solver_names, solver); }

void count(const ContactReport& report, SolverId best, int applicable, ChainStatistics& statistics) {
  ++statistics.problems;
  for (std::size_t i = 0; i < solver_count; ++i) {
    if (report.was_tried(static_cast<SolverId>(i))) ++statistics.tried[i];
  }
  if (report.usable()) {
    ++statistics.accepted[static_cast<std::size_t>(best)];
    statistics.count_residual(report.residual);
    if (report.residual > accepted_residual && best != SolverId::nonlinear_cg) ++statistics.tolerated;
  }
  if (applicable > 1) ++statistics.fall_backs;
  if (report.degenerate) ++statistics.degenerate;
  switch (report.outcome) {
    case Outcome::solved:
      break;
    case Outcome::several_solutions:
      ++statistics.several_solutions;
      break;
    case Outcome::forces_not_unique:
      ++statistics.forces_not_unique;
      break;
    case Outcome::no_solution:
      ++statistics.no_solution;
      break;
    case Outcome::not_solved:
      ++statistics.not_solved;
      break;
    case Outcome::accepted_at_cap:
      ++statistics.accepted_at_cap;
      break;
  }
}

ChainStatistics& ChainStatistics::operator+=(const ChainStatistics& other) {
  problems += other.problems;
  for (std::size_t i = 0; i < solver_count; ++i) {
    accepted[i] += other.accepted[i];
    tried[i] += other.tried[i];
  }
  fall_backs += other.fall_backs;
  tolerated += other.tolerated;
  several_solutions += other.several_solutions;
  forces_not_unique += other.forces_not_unique;
  degenerate += other.degenerate;
  no_solution += other.no_solution;
  not_solved += other.not_solved;
  accepted_at_cap += other.accepted_at_cap;
  for (std::size_t i = 0; i < certified.size(); ++i) certified[i] += other.certified[i];
  worst_residual = std::max(worst_residual, other.worst_residual);
  return *this;
}

std::ostream& operator<<(std::ostream& out, const ChainStatistics& statistics) {
  constexpr int name_width = 26, number_width = 14;
  const auto flags = out.flags();
  const auto precision = out.precision(3);
  const auto name = [&](std::string_view text) -> std::ostream& {
    return out << "  " << std::left << std::setw(name_width) << text << std::right;
  };
  const auto outcome = [&](std::string_view text, std::int64_t count) {
    if (count != 0) name(text) << std::setw(number_width) << count << "\n";
  };
  name("contact problems") << std::setw(number_width) << statistics.problems << "\n";
  name("solver") << std::setw(number_width) << "tried" << std::setw(number_width) << "accepted"
                 << "\n";
  for (std::size_t i = 0; i < solver_count; ++i) {
    if (statistics.tried[i] == 0) continue;
    name(solver_names[i]) << std::setw(number_width) << statistics.tried[i] << std::setw(number_width)
                          << statistics.accepted[i] << "\n";
  }
  outcome("several solutions", statistics.several_solutions);
  outcome("forces not unique", statistics.forces_not_unique);
  outcome("no solution", statistics.no_solution);
  outcome("not solved", statistics.not_solved);
  outcome("accepted at cap", statistics.accepted_at_cap);
  outcome("at a boundary of modes", statistics.degenerate);
  outcome("first solver not accepted", statistics.fall_backs);
  outcome("residual only tolerated", statistics.tolerated);
  // Only sweeps over large problems leave residuals of different size.
  if (statistics.certified[2] + statistics.certified[3] != 0) {
    constexpr std::array texts{"residual up to 1e-12", "residual up to 1e-10", "residual up to 1e-8",
                               "residual above"};
    for (std::size_t i = 0; i < texts.size(); ++i) outcome(texts[i], statistics.certified[i]);
  }
  name("worst residual") << std::setw(number_width) << std::scientific << statistics.worst_residual << "\n";
  out.precision(precision);
  out.flags(flags);
  return out;
}

}  // namespace carom
