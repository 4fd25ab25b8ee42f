#pragma once

/// \file
/// Parts of the validation report: pages with rows of its table, curves for its pictures.

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace validation {

/// A number that is not known or does not apply.
inline constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// Options of time stepping that have a column: impacts located, the rule energy_momentum, both.
inline constexpr std::size_t option_count = 3;

/// A line of the report's table: what a run gave, beside what is known.
struct Row {
  std::string mode;      ///< which part of the library ran
  std::string setting;   ///< tolerance or step
  std::string quantity;  ///< with its unit
  std::string reference, obtained;
  double error = unknown;  ///< |obtained - reference|, in the quantity's unit
  double order = unknown;  ///< observed
  double cost = unknown;   ///< CPU time of all that the row tells [s]
  /// Results of the row at the same step under each option (option_count): the error, or the words obtained;
  /// empty if it does not apply.
  std::vector<std::string> with_option;
};

/// Numbers for a picture: a CSV file.
struct Curve {
  std::string name;  ///< of the file, without ending
  std::vector<std::string> columns;
  std::vector<std::vector<double>> rows;
};

/// A picture, drawn from curves by scripts/plot_validation.py.
struct Figure {
  std::string name;  ///< of the file, without ending
  std::string caption;
};

/// One problem.
struct Page {
  std::string name;    ///< of the file, without ending
  std::string title;   ///< of the problem
  std::string source;  ///< of the references
  std::string text;    ///< what is computed, with which assumptions
  std::vector<Figure> figures;
  std::vector<Row> rows;
  std::string remarks;  ///< what is seen, and why errors are as large as they are
  std::vector<Curve> curves;
};

/// The page in Markdown.
[[nodiscard]] std::string page_text(const Page& page);

/// The first page of the report: all rows of all pages in one table, in their order.
[[nodiscard]] std::string overview_text(const std::vector<Page>& pages);

/// A curve as CSV, every number exactly.
[[nodiscard]] std::string csv_text(const Curve& curve);

/// A number with two digits, as errors are printed; "–" for one that is not known.
[[nodiscard]] std::string scientific_text(double value);

/// A number with ten digits; "-" for one that is not known.
[[nodiscard]] std::string number_text(double value);

}  // namespace validation
