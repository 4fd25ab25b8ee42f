// The committed report against what its problems give now: the quick ones here, all of them in the long
// suite.

#include "validation/report.h"
#include "tests/integrators/joint_run.h"
#include "tests/paths.h"
#include "tests/shares.h"
#include "tests/validation/report_table.h"
#include "validation/pages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <list>
#include <string>
#include <string_view>
#include <vector>

namespace {

using carom_test::difference;
using carom_test::report_lines;
using carom_test::ReportLine;

std::string report_file(const std::string& name) {
  return carom_test::source_file("docs/validation/" + name);
}

std::string read(const std::string& path) {
  std::ifstream file(path);
  EXPECT_TRUE(file) << path;
  return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<ReportLine> committed(const std::string& page) {
  std::vector<ReportLine> lines = report_lines(read(report_file("README.md")));
  std::erase_if(lines, [&](const ReportLine& line) { return line.page() != page; });
  return lines;
}

/// But for lines of quantities that begin with one of the texts `but`.
void expect_as_committed(const validation::Page& page, const std::vector<std::string>& but = {}) {
  std::vector<ReportLine> now = report_lines(validation::overview_text({page})), then = committed(page.name);
  const auto is_left_out = [&](const ReportLine& line) {
    return std::any_of(but.begin(), but.end(),
                       [&](const std::string& text) { return line.quantity.starts_with(text); });
  };
  EXPECT_EQ(std::erase_if(now, is_left_out), std::erase_if(then, is_left_out)) << page.name;
  ASSERT_EQ(now.size(), then.size()) << page.name << ": write the report anew with scripts/validate.sh";
  EXPECT_GT(now.size(), 0U) << page.name;
  for (std::size_t i = 0; i < now.size(); ++i)
    EXPECT_EQ(difference(now[i], then[i]), "") << page.name << ", " << now[i].quantity;
}

class ValidationProblem : public testing::TestWithParam<validation::Problem> {};

TEST_P(ValidationProblem, GivesTheCommittedNumbers) {
  const validation::Page page = GetParam().run();
  EXPECT_EQ(page.name, GetParam().name);
  expect_as_committed(page);
}

// A page whose runs are watched, below.
constexpr std::string_view watched = "mechanisms";

std::vector<validation::Problem> problems(bool quick) {
  std::vector<validation::Problem> result;
  for (const validation::Problem& problem : validation::all_problems) {
    if (problem.quick == quick && problem.name != watched) result.push_back(problem);
  }
  return result;
}

std::string name_of(const testing::TestParamInfo<validation::Problem>& each) { return each.param.name; }

INSTANTIATE_TEST_SUITE_P(Quick, ValidationProblem, testing::ValuesIn(problems(true)), name_of);
INSTANTIATE_TEST_SUITE_P(OthersLong, ValidationProblem, testing::ValuesIn(problems(false)), name_of);

/// An event-driven run: joints at every output, the energy ledger.
struct Watch {
  joint_scenes::JointCheck joints;
  carom_test::LedgerWatch ledger;

  explicit Watch(carom::Simulation& simulation) : joints(simulation), ledger(simulation) {}
};

// The forty windows take longer than all other runs of the page, so they are made once: for the committed
// numbers, and for limits of their own. Those of errors are explained where two windows have theirs
// (joints_event_driven_test.cpp). Where long tests take a part (shares.h) the forty windows end at 2 s, and
// only the limits tell of them.
TEST(MechanismsPageLong, GivesTheCommittedNumbersAndFortyWindowsPassTheirPositionsInLine) {
  std::list<Watch> runs;
  const bool part = carom_test::takes_a_quarter();
  const validation::Page page = validation::mechanisms(
      [&](carom::Simulation& simulation) { runs.emplace_back(simulation); }, part ? 2.0 : 10.0);
  EXPECT_EQ(page.name, watched);
  const std::string angles = "angle of 40 four-bars A02 up to ", spins = "spin of 40 four-bars A02 up to ";
  expect_as_committed(page, part ? std::vector{angles, spins} : std::vector<std::string>{});
  EXPECT_EQ(runs.size(), 2U);  // of two windows and of forty
  for (const Watch& run : runs) {
    EXPECT_LE(run.joints.gap, joint_scenes::gap_limit);
    EXPECT_LE(run.joints.speed, joint_scenes::speed_limit);
    EXPECT_TRUE(run.ledger.closes());
  }
  int found = 0;
  for (const validation::Row& row : page.rows) {
    const bool is_angle = row.quantity.starts_with(angles);
    if (!is_angle && !row.quantity.starts_with(spins)) continue;
    EXPECT_LE(row.error, is_angle ? 3e-6 : 9e-6) << row.quantity;
    ++found;
  }
  EXPECT_EQ(found, 2);
}

TEST(ValidationReport, HoldsEveryProblemInItsOrderAndNoOther) {
  std::vector<std::string> pages;
  for (const ReportLine& line : report_lines(read(report_file("README.md")))) {
    if (pages.empty() || pages.back() != line.page()) pages.push_back(line.page());
  }
  std::vector<std::string> problems;
  for (const validation::Problem& problem : validation::all_problems) problems.emplace_back(problem.name);
  EXPECT_EQ(pages, problems);
}

TEST(ValidationReport, PagesHoldTheRowsOfTheTableAndPicturesThatExist) {
  for (const validation::Problem& problem : validation::all_problems) {
    const std::string page = read(report_file(std::string(problem.name) + ".md"));
    for (const ReportLine& line : committed(problem.name)) {
      const std::string row = "| " + line.mode + " | " + line.quantity + " | " + line.reference + " | " +
                              line.obtained + " | " + line.error + " | " + line.setting + " | " + line.order +
                              " | " + line.cost + " | " + line.with_option[0] + " | " + line.with_option[1] +
                              " | " + line.with_option[2] + " |";
      EXPECT_NE(page.find(row), std::string::npos) << problem.name << ": " << row;
    }
    std::size_t pictures = 0;
    for (std::size_t at = page.find("](figures/"); at != std::string::npos;
         at = page.find("](figures/", at + 1)) {
      const std::string name = page.substr(at + 2, page.find(')', at) - at - 2);
      EXPECT_TRUE(std::filesystem::exists(report_file(name))) << problem.name << ": " << name;
      ++pictures;
    }
    EXPECT_GT(pictures, 0U) << problem.name;
  }
}

// Made-up lines: the comparison above can fail, and passes over what it should.
ReportLine line() {
  return {"[Ball](ball.md)",
          "closed form",
          "time stepping",
          "height [m]",
          "2",
          "2.001",
          "1.0e-03",
          "h = 0.001 s",
          "1.02",
          "1.0e-03",
          {"2.0e-06", "1.0e-03", "–"}};
}

TEST(ReportTable, LinesAreReadAsTheyAreWritten) {
  const validation::Page page{.name = "ball",
                              .title = "Ball",
                              .source = "closed form",
                              .text = {},
                              .figures = {},
                              .rows = {{"time stepping",
                                        "h = 0.001 s",
                                        "height [m]",
                                        "2",
                                        "2.001",
                                        1e-3,
                                        1.02,
                                        1e-3,
                                        {"2.0e-06", "1.0e-03"}}},
                              .remarks = {},
                              .curves = {}};
  const std::vector<ReportLine> lines = report_lines(validation::overview_text({page}));
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines[0].page(), "ball");
  EXPECT_EQ(difference(lines[0], line()), "");
  EXPECT_EQ(lines[0].cost, line().cost);
  EXPECT_EQ(lines[0].with_option, line().with_option);
}

TEST(ReportTable, ChangedNumbersAndWordsAreFound) {
  const auto changed = [](std::string ReportLine::*cell, const char* text) {
    ReportLine other = line();
    other.*cell = text;
    return difference(line(), other);
  };
  EXPECT_NE(changed(&ReportLine::obtained, "2.0011"), "");
  EXPECT_NE(changed(&ReportLine::obtained, "lost"), "");
  EXPECT_NE(changed(&ReportLine::reference, "2.1"), "");
  EXPECT_NE(changed(&ReportLine::error, "2.0e-03"), "");
  EXPECT_NE(changed(&ReportLine::error, "–"), "");
  EXPECT_NE(changed(&ReportLine::order, "1.20"), "");
  EXPECT_NE(changed(&ReportLine::order, "–"), "");
  EXPECT_NE(changed(&ReportLine::setting, "h = 0.01 s"), "");
  EXPECT_NE(changed(&ReportLine::quantity, "height [mm]"), "");
  EXPECT_NE(changed(&ReportLine::source, "a book"), "");
  ReportLine other = line();
  other.with_option[0] = "2.0e-04";
  EXPECT_NE(difference(line(), other), "");
  EXPECT_EQ(changed(&ReportLine::cost, "5.0e+00"), "");
  EXPECT_EQ(changed(&ReportLine::obtained, "2.0010000001"), "");
}

TEST(ReportTable, RoundingIsPassedOverOnlyWhereBothAreRight) {
  ReportLine right = line(), other = line();
  right.obtained = "2";
  right.error = "1.0e-15";
  other.reference = other.obtained = "1.5";
  other.error = "3.0e-16";
  EXPECT_EQ(difference(right, other), "");
  other.obtained = "1.6";
  EXPECT_NE(difference(right, other), "");
  other.obtained = "1.5001";
  other.error = "1.0e-04";
  EXPECT_NE(difference(right, other), "");
}

}  // namespace
