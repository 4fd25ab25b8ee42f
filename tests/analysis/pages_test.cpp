// All pages of the documentation: each is in the index, its links lead somewhere, and how outputs that it
// shows are compared.

#include "tests/page_blocks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <regex>
#include <string>
#include <vector>

namespace {

using carom_test::text_of;

/// README.md and the pages of docs/ and its folders.
std::vector<std::string> all_pages() {
  const std::filesystem::path project = carom_test::source_file("");
  std::vector<std::string> pages{"README.md"};
  for (const auto& entry : std::filesystem::recursive_directory_iterator(project / "docs")) {
    if (entry.path().extension() == ".md") pages.push_back(relative(entry.path(), project).string());
  }
  std::sort(pages.begin(), pages.end());
  return pages;
}

TEST(ConceptPages, EveryPageIsInTheIndex) {
  const std::string index = text_of("docs/index.md");
  for (const std::string& page : all_pages()) {
    // Of a folder the first page only.
    const std::filesystem::path path(page), folder = path.parent_path();
    if (folder.empty() || path.filename() == "index.md") continue;
    if (folder != "docs" && path.filename() != "README.md") continue;
    EXPECT_NE(index.find("](" + path.lexically_relative("docs").string() + ")"), std::string::npos) << page;
  }
}

TEST(ConceptPages, LinksLeadToFilesOfTheProject) {
  const std::regex link(R"(\]\(([^)\s]+)\))"), code(R"(```[\s\S]*?```|`[^`\n]*`)");
  std::size_t count = 0;
  for (const std::string& page : all_pages()) {
    const std::string text = std::regex_replace(text_of(page), code, "");
    const std::filesystem::path folder = std::filesystem::path(carom_test::source_file(page)).parent_path();
    for (std::sregex_iterator at(text.begin(), text.end(), link), end; at != end; ++at, ++count) {
      // Views of the gallery are made by scripts/gallery.sh; python/tests/test_gallery.py checks their names.
      if (at->str(1).starts_with("../build/gallery/") && page == "docs/gallery.md") continue;
      EXPECT_TRUE(std::filesystem::exists(folder / at->str(1))) << page << ": " << at->str(1);
    }
  }
  EXPECT_GT(count, 50U);
}

TEST(ConceptPages, OutputsAreComparedNumberByNumber) {
  using carom_test::same_line;
  EXPECT_TRUE(same_line("  total   2.9441174 J", "total 2.9441175 J"));
  EXPECT_TRUE(same_line("0.001551 m,", "0.001552 m,"));
  EXPECT_FALSE(same_line("0.001551 m,", "0.001553 m,"));
  EXPECT_TRUE(same_line("residual 3.6e-14 J", "residual -1e-13 J"));
  EXPECT_FALSE(same_line("2.9441 J", "2.9451 J"));
  EXPECT_FALSE(same_line("freedoms: 1", "freedoms: 2"));
  EXPECT_FALSE(same_line("2 m", "2 m/s"));
  EXPECT_FALSE(same_line("2 m", "2 m more"));
}

}  // namespace
