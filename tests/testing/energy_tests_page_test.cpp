// The page docs/energy_tests.md shows the project that tests/consumer/run.sh builds and runs.

#include "tests/page_blocks.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace {

using carom_test::code_blocks;
using carom_test::text_of;

const std::string page = "docs/energy_tests.md", project = "tests/consumer/energy_tests/";

TEST(EnergyTestsPage, ShowsTheProjectThatIsTested) {
  EXPECT_EQ(code_blocks(page, "cmake"), std::vector{text_of(project + "CMakeLists.txt")});
  EXPECT_EQ(code_blocks(page, "cpp"), std::vector{text_of(project + "energy_test.cpp")});
}

TEST(EnergyTestsPage, NamesEveryMatcher) {
  const std::string text = text_of(page), header = text_of("testing/matchers.h");
  int matchers = 0;
  for (std::size_t at = header.find("inline auto "); at != std::string::npos;
       at = header.find("inline auto ", at)) {
    at += std::string("inline auto ").size();
    const std::string name = header.substr(at, header.find('(', at) - at);
    EXPECT_NE(text.find("`" + name), std::string::npos) << name;
    ++matchers;
  }
  EXPECT_EQ(matchers, 8);
}

}  // namespace
