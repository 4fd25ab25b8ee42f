#include <carom/core/text_table.h>

#include <gtest/gtest.h>

namespace {

TEST(TextTable, LinesUpItsColumns) {
  carom::TextTable table({"term", "value [J]"});
  EXPECT_TRUE(table.empty());
  table.add({"kinetic", "1.5"});
  table.add({"total", "-123456.75"});
  EXPECT_FALSE(table.empty());
  EXPECT_EQ(table.text(),
            "  term      value [J]\n"
            "  kinetic         1.5\n"
            "  total    -123456.75\n");
}

TEST(TextTable, CellsHaveAtMostSomeDigits) {
  EXPECT_EQ(carom::cell(1.0 / 3.0, 3), "0.333");
  EXPECT_EQ(carom::cell(1234567.0, 3), "1.23e+06");
  EXPECT_EQ(carom::cell(0.25), "0.25");
  EXPECT_EQ(carom::cell(0.0), "0");
}

}  // namespace
