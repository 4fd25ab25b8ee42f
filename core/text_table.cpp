#include <carom/core/text_table.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <charconv>
#include <utility>

namespace carom {

std::string cell(double value, int digits) {
  std::array<char, 64> buffer{};
  const auto result =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::general, digits);
  return {buffer.data(), result.ptr};
}

TextTable::TextTable(std::vector<std::string> headings)
    : columns_(headings.size()), cells_(std::move(headings)) {}

void TextTable::add(std::vector<std::string> cells) {
  assert(cells.size() == columns_);
  for (std::string& cell : cells) cells_.push_back(std::move(cell));
}

std::string TextTable::text() const {
  std::vector<std::size_t> widths(columns_, 0);
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    std::size_t& width = widths[i % columns_];
    width = std::max(width, cells_[i].size());
  }
  std::string text;
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const std::size_t column = i % columns_;
    const std::string padding(widths[column] - cells_[i].size(), ' ');
    text += "  ";
    text += column == 0 ? cells_[i] + padding : padding + cells_[i];
    if (column + 1 == columns_) text += '\n';
  }
  return text;
}

}  // namespace carom
