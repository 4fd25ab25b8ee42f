#pragma once

// The code that a page of the documentation shows, and what it says that code prints.

#include "tests/paths.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

namespace carom_test {

/// Content of a file of the project.
inline std::string text_of(const std::string& file) {
  std::ifstream in(carom_test::source_file(file));
  EXPECT_TRUE(in) << file;
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The blocks of a page in a language, e.g. "cpp".
inline std::vector<std::string> code_blocks(const std::string& page, const std::string& language) {
  const std::string text = text_of(page), fence = "```" + language + "\n";
  std::vector<std::string> blocks;
  for (std::size_t at = text.find(fence); at != std::string::npos; at = text.find(fence, at)) {
    at += fence.size();
    const std::size_t end = text.find("```", at);
    EXPECT_NE(end, std::string::npos) << page;
    if (end == std::string::npos) break;
    blocks.push_back(text.substr(at, end - at));
    at = end + 3;
  }
  return blocks;
}

/// The unit of the last digit of a number that is written with a point; 0 for others.
inline double last_digit(const std::string& number) {
  const std::size_t point = number.find('.');
  if (point == std::string::npos) return 0.0;
  const std::size_t end = std::min(number.find_first_not_of("0123456789", point + 1), number.size());
  const int digits = static_cast<int>(end - point - 1);
  const int exponent = end < number.size() && number[end] == 'e' ? std::atoi(number.c_str() + end + 1) : 0;
  return std::pow(10.0, exponent - digits);
}

/// True for lines of the same words and numbers. The last digit of a number may be rounded otherwise, and a
/// run of another compiler differ in the sixth; numbers of the size of rounding may be any.
inline bool same_line(const std::string& shown, const std::string& printed) {
  constexpr double sixth_digit = 1e-5, rounding = 1e-10;
  std::istringstream a(shown), b(printed);
  for (std::string x, y;;) {
    const bool more = static_cast<bool>(a >> x);
    if (static_cast<bool>(b >> y) != more) return false;
    if (!more) return true;
    if (x == y) continue;
    char *x_end = nullptr, *y_end = nullptr;
    const double p = std::strtod(x.c_str(), &x_end), q = std::strtod(y.c_str(), &y_end);
    if (x_end == x.c_str() || std::string(x_end) != y_end) return false;
    const double allowed = std::max({1.5 * last_digit(x), sixth_digit * std::abs(p), rounding});
    if (!(std::abs(p - q) <= allowed)) return false;
  }
}

/// Whether block `number` of those marked `text` is what was printed. A line "..." of the page stands for any
/// lines.
inline testing::AssertionResult prints(const std::string& page, std::size_t number,
                                       const std::string& output) {
  const auto blocks = code_blocks(page, "text");
  if (number >= blocks.size()) return testing::AssertionFailure() << page << ": no text block " << number;
  std::istringstream shown(blocks[number]), printed(output);
  bool skips = false;
  std::string actual;
  for (std::string line; std::getline(shown, line);) {
    if (line == "...") {
      skips = true;
      continue;
    }
    do {
      if (!std::getline(printed, actual)) {
        return testing::AssertionFailure() << "not printed: " << line << "\nbut\n" << output;
      }
    } while (skips && !same_line(line, actual));
    if (!same_line(line, actual)) {
      return testing::AssertionFailure() << "the page has: " << line << "\nprinted was: " << actual;
    }
    skips = false;
  }
  if (!skips && std::getline(printed, actual)) {
    return testing::AssertionFailure() << "the page lacks: " << actual;
  }
  return testing::AssertionSuccess();
}

}  // namespace carom_test
