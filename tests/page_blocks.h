#pragma once

// The code that a page of the documentation shows.

#include "tests/paths.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
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

}  // namespace carom_test
