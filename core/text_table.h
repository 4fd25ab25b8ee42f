#pragma once

/// \file
/// Tables of text, for reports that people read.

#include <carom/core/export.h>

#include <cstddef>
#include <string>
#include <vector>

namespace carom {

/// A number for a table: at most `digits` significant digits.
[[nodiscard]] CAROM_API std::string cell(double value, int digits = 8);

/// Lines up columns: the first to the left, numbers to the right.
class CAROM_API TextTable {
public:
  /// A table with these headings.
  explicit TextTable(std::vector<std::string> headings);

  /// Appends a row of as many cells as there are headings.
  void add(std::vector<std::string> cells);
  /// True if it has no row but the headings.
  [[nodiscard]] bool empty() const { return cells_.size() == columns_; }
  /// The table, each line indented by two spaces and ended.
  [[nodiscard]] std::string text() const;

private:
  std::size_t columns_;
  std::vector<std::string> cells_;  // row by row, the headings first
};

}  // namespace carom
