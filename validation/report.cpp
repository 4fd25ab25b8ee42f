#include "validation/report.h"

#include <cmath>
#include <iomanip>
#include <ios>
#include <limits>
#include <sstream>

namespace validation {
namespace {

std::string in_style(std::ios_base& (*style)(std::ios_base&), int precision, double value) {
  if (std::isnan(value)) return "–";
  std::ostringstream out;
  out << style << std::setprecision(precision) << value;
  return out.str();
}
void write_row(std::ostream& out, const Row& row) {
  out << row.mode << " | " << row.quantity << " | " << row.reference << " | " << row.obtained << " | "
      << scientific_text(row.error) << " | " << row.setting << " | " << in_style(std::fixed, 2, row.order)
      << " | " << scientific_text(row.cost) << " |";
  for (std::size_t i = 0; i < option_count; ++i)
    out << " " << (i < row.with_option.size() ? row.with_option[i] : "–") << " |";
  out << "\n";
}

constexpr const char* row_head =
    "mode | quantity | reference | obtained | error | tolerance or step | order | CPU s | `located` | "
    "`energy_momentum` | both |\n";
constexpr const char* row_line = "---|---|---|---|---|---|---|---|---|---|---|\n";

}  // namespace

std::string scientific_text(double value) { return in_style(std::scientific, 1, value); }

std::string number_text(double value) {
  constexpr int digits = 10;
  return in_style(std::defaultfloat, digits, value == 0.0 ? 0.0 : value);  // no negative zero
}

std::string page_text(const Page& page) {
  std::ostringstream out;
  out << "# " << page.title << "\n\nSource: " << page.source << ".\n\n" << page.text << "\n";
  for (const Figure& figure : page.figures) {
    out << "\n![" << page.title << "](figures/" << figure.name << ".png)\n\n*" << figure.caption << "*\n";
  }
  out << "\n| " << row_head << "|" << row_line;
  for (const Row& row : page.rows) {
    out << "| ";
    write_row(out, row);
  }
  if (!page.remarks.empty()) out << "\n" << page.remarks << "\n";
  out << "\n[All problems](README.md)\n";
  return out.str();
}

std::string overview_text(const std::vector<Page>& pages) {
  std::ostringstream out;
  out << "# Validation\n\n"
         "Every problem with a known answer that the project has, in every mode that applies. The files of "
         "this folder are written by `scripts/validate.sh`, which builds and runs the programs of "
         "[validation/](../../validation) and draws the pictures; nothing in them is typed in but the "
         "references, whose sources are named ([tests/reference](../../tests/reference/README.md)). A test "
         "computes the rows again and compares them with the table below.\n\n"
         "*Error* is |obtained − reference| in the unit of the quantity. Where a row stands for many values, "
         "it shows the one that is worst against its scale. *Order* is the slope of the error over the step, "
         "fitted to several steps; across impacts in the mean over many steps, since an impact is noticed up "
         "to one step late and single errors scatter. *CPU s* is the time of all the runs behind the row on "
         "the machine that made this report: it is not compared. Rows of the event-driven mode with errors "
         "of 1e-12 and less show rounding. Why errors are large, where they are, is said on the page of the "
         "problem. The last columns have the errors (or the words) of the same run of time stepping with "
         "`impacts = located`, with `force_rule = energy_momentum` and with both.\n\n"
         "## Problems\n\n";
  for (const Page& page : pages)
    out << "- [" << page.title << "](" << page.name << ".md): " << page.source << "\n";
  out << "\n## Results\n\n"
         "| problem | source | "
      << row_head << "|---|---|" << row_line;
  for (const Page& page : pages) {
    for (const Row& row : page.rows) {
      out << "| [" << page.title << "](" << page.name << ".md) | " << page.source << " | ";
      write_row(out, row);
    }
  }
  return out.str();
}

std::string csv_text(const Curve& curve) {
  std::ostringstream out;
  out.precision(std::numeric_limits<double>::max_digits10);
  for (std::size_t i = 0; i < curve.columns.size(); ++i) out << (i > 0 ? "," : "") << curve.columns[i];
  out << "\n";
  for (const std::vector<double>& row : curve.rows) {
    for (std::size_t i = 0; i < row.size(); ++i) out << (i > 0 ? "," : "") << row[i];
    out << "\n";
  }
  return out.str();
}

}  // namespace validation
