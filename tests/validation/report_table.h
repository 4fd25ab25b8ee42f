#pragma once

// The table of the validation report as it stands in docs/validation/README.md, and how it differs from
// another.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

namespace carom_test {

/// A line of the table, as text.
struct ReportLine {
  std::string problem, source, mode, quantity, reference, obtained, error, setting, order, cost;
  std::array<std::string, 3> with_option;

  /// File of its page, without ending: "name" of "[title](name.md)".
  [[nodiscard]] std::string page() const {
    const std::size_t from = problem.find("](") + 2;
    return problem.substr(from, problem.find(".md)") - from);
  }
};

/// The lines of a table that begin with a link.
inline std::vector<ReportLine> report_lines(const std::string& text) {
  std::vector<ReportLine> lines;
  std::istringstream all(text);
  for (std::string line; std::getline(all, line);) {
    if (!line.starts_with("| [")) continue;
    std::vector<std::string> cells;
    for (std::size_t from = 2; from < line.size();) {
      const std::size_t to = line.find(" |", from);
      cells.push_back(line.substr(from, to - from));
      from = to + 3;
    }
    if (cells.size() != 13) {
      cells.assign(13, "a line of " + std::to_string(cells.size()) + " cells");
    }
    lines.push_back({cells[0],
                     cells[1],
                     cells[2],
                     cells[3],
                     cells[4],
                     cells[5],
                     cells[6],
                     cells[7],
                     cells[8],
                     cells[9],
                     {cells[10], cells[11], cells[12]}});
  }
  return lines;
}

/// The number that a cell is; NaN for words and dashes.
inline double cell_number(const std::string& cell) {
  char* end = nullptr;
  const double value = std::strtod(cell.c_str(), &end);
  return !cell.empty() && *end == '\0' ? value : std::nan("");
}

/// Whether two cells say the same: numbers but for a part of their size, words exactly.
inline bool same_cell(const std::string& a, const std::string& b, double part, double least = 0.0) {
  const double x = cell_number(a), y = cell_number(b);
  if (std::isnan(x) || std::isnan(y)) return a == b;
  return std::abs(x - y) <= part * std::max(std::abs(x), std::abs(y)) + least;
}

/// Difference of two lines that should be the same; empty if it does not matter. Costs never do.
inline std::string difference(const ReportLine& a, const ReportLine& b) {
  const auto differs = [](const std::string& what, const std::string& x, const std::string& y) {
    return what + " '" + x + "' and '" + y + "'";
  };
  if (a.problem != b.problem) return differs("problem", a.problem, b.problem);
  if (a.source != b.source) return differs("source", a.source, b.source);
  if (a.mode != b.mode) return differs("mode", a.mode, b.mode);
  if (a.quantity != b.quantity) return differs("quantity", a.quantity, b.quantity);
  if (a.setting != b.setting) return differs("setting", a.setting, b.setting);
  // Orders are slopes of errors, printed to 0.01.
  constexpr double order_printed = 0.02;
  if (!same_cell(a.order, b.order, 0.0, order_printed)) return differs("order", a.order, b.order);
  // Where both runs are right to rounding, or to the tolerance of an event-driven run, another value of many
  // may be the worst: how large the error is differs between machines, and by how much values differ is said
  // by it.
  constexpr double rounding = 1e-9;
  const double size = std::max({1.0, std::abs(cell_number(a.reference)), std::abs(cell_number(b.reference))});
  // Two digits are printed.
  constexpr double error_part = 0.15;
  for (std::size_t i = 0; i < a.with_option.size(); ++i) {
    if (!same_cell(a.with_option[i], b.with_option[i], error_part, rounding * size))
      return differs("under an option", a.with_option[i], b.with_option[i]);
  }
  const auto right = [&](const ReportLine& line) {
    const double seen =
        std::abs(cell_number(line.obtained) - cell_number(line.reference));  // of printed digits
    return cell_number(line.error) <= rounding * size && seen <= 2.0 * rounding * size;
  };
  if (right(a) && right(b)) return "";
  // Ten digits are printed, the functions of the mathematical library differ in the last of sixteen, and
  // motion magnifies that.
  constexpr double value_part = 1e-7;
  if (!same_cell(a.reference, b.reference, value_part)) return differs("reference", a.reference, b.reference);
  if (!same_cell(a.obtained, b.obtained, value_part)) return differs("obtained", a.obtained, b.obtained);
  if (!same_cell(a.error, b.error, error_part)) return differs("error", a.error, b.error);
  return "";
}

}  // namespace carom_test
