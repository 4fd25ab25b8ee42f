#include <carom/core/energy_trace.h>
#include <carom/core/errors.h>

#include "tests/integrators/throws.h"
#include "tests/random.h"
#include "tests/temporary_folder.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <locale>
#include <sstream>
#include <string>

namespace {

using namespace carom;
using carom_test::TemporaryFolder;

/// Numbers of all sizes, with all their digits.
TraceRow random_row(double time, carom_test::Random& random) {
  auto values = values_of(TraceRow{});
  for (double& value : values) value = random.uniform(-1.0, 1.0) * std::exp2(random.uniform(-600.0, 600.0));
  values[0] = time;
  return row_of(values);
}

EnergyTrace random_trace() {
  carom_test::Random random(7);
  EnergyTrace trace;
  trace.add(TraceEvent{0.05, "bar on half-plane \"left, steep\", slip+\nsecond line"});
  for (const double time : {0.0, 0.1, 0.30000000000000004, 1e3}) trace.add(random_row(time, random));
  trace.add(TraceEvent{0.1, "at the time of a row"});
  trace.add(TraceEvent{2e3, "after the last row"});
  return trace;
}

void expect_same_bits(const EnergyTrace& a, const EnergyTrace& b) {
  ASSERT_EQ(a.rows().size(), b.rows().size());
  for (std::size_t row = 0; row < a.rows().size(); ++row) {
    const auto x = values_of(a.rows()[row]), y = values_of(b.rows()[row]);
    for (std::size_t i = 0; i < trace_term_count; ++i) {
      EXPECT_EQ(std::bit_cast<std::uint64_t>(x[i]), std::bit_cast<std::uint64_t>(y[i]))
          << trace_terms()[i].name;
    }
  }
  ASSERT_EQ(a.events().size(), b.events().size());
  for (std::size_t i = 0; i < a.events().size(); ++i) {
    EXPECT_EQ(a.events()[i].time, b.events()[i].time);
    EXPECT_EQ(a.events()[i].text, b.events()[i].text);
  }
}

TEST(EnergyTrace, TermsAreNumbersOfTheRow) {
  TraceRow row;
  row.time = 1.0;
  row.stored[StoredEnergy::elastic] = 2.0;
  row.flows[EnergyFlow::coupling_discretisation] = 3.0;
  row.momentum = {4.0, 5.0, 6.0};
  row.angular_momentum[2] = 7.0;
  row.length_scale = 8.0;
  EnergyTrace trace;
  trace.add(row);
  EXPECT_EQ(trace.values("time"), std::vector{1.0});
  EXPECT_EQ(trace.values("elastic"), std::vector{2.0});
  EXPECT_EQ(trace.values("coupling_discretisation"), std::vector{3.0});
  EXPECT_EQ(trace.values("momentum_z"), std::vector{6.0});
  EXPECT_EQ(trace.values("angular_momentum_z"), std::vector{7.0});
  EXPECT_EQ(trace.values("length_scale"), std::vector{8.0});
  EXPECT_THROWS(ModelError, trace.values("warmth"), "'warmth'", "trace_terms()");
  EXPECT_EQ(values_of(row_of(values_of(row))), values_of(row));
}

TEST(EnergyTrace, EveryQuantityHasItsScale) {
  TraceRow row;
  row.energy_scale = 1.0;
  row.momentum_scale = 2.0;
  row.angular_momentum_scale = 3.0;
  row.length_scale = 4.0;
  const auto values = values_of(row);
  for (std::size_t i = 0; i < trace_term_count; ++i) {
    if (!trace_terms()[i].is_scale) continue;
    EXPECT_EQ(values[i], row.scale(trace_terms()[i].quantity));
  }
  EXPECT_EQ(row.scale(Quantity::time), 0.0);
}

TEST(EnergyTrace, RefusesWhatCannotBe) {
  EnergyTrace trace;
  TraceRow row;
  row.time = 0.5;
  trace.add(row);
  EXPECT_THROWS(ModelError, trace.add(row), "time is 0.5 s", "later than the row before");
  row.time = 1.0;
  row.flows[EnergyFlow::sliding] = std::numeric_limits<double>::infinity();
  EXPECT_THROWS(ModelError, trace.add(row), "sliding at t = 1 s is inf J", "finite");
  row.flows[EnergyFlow::sliding] = 0.0;
  row.time = std::nan("");
  EXPECT_THROWS(ModelError, trace.add(row), "time", "nan s");
  trace.add(TraceEvent{0.7, "bounce"});
  EXPECT_THROWS(ModelError, trace.add(TraceEvent{0.6, "earlier"}), "'earlier' is 0.6 s", "not before");
  EXPECT_THROWS(ModelError, trace.add(TraceEvent{std::nan(""), "never"}), "'never' is nan s");
  EXPECT_THROWS(ModelError, trace.add(TraceEvent{0.8, ""}), "text");
  EXPECT_EQ(trace.rows().size(), 1u);
  EXPECT_EQ(trace.events().size(), 1u);
}

TEST(EnergyTrace, NearestEvent) {
  EnergyTrace trace;
  EXPECT_EQ(trace.nearest_event(0.0), nullptr);
  trace.add(TraceEvent{1.0, "first"});
  trace.add(TraceEvent{2.0, "second"});
  EXPECT_EQ(trace.nearest_event(-5.0)->text, "first");
  EXPECT_EQ(trace.nearest_event(1.5)->text, "first");
  EXPECT_EQ(trace.nearest_event(1.6)->text, "second");
}

TEST(EnergyTrace, PrintsInOneLine) {
  std::ostringstream out;
  out << random_trace() << "; " << EnergyTrace();
  EXPECT_EQ(out.str(), "trace of 4 times from 0 s to 1000 s with 3 events; trace of 0 times with 0 events");
}

TEST(EnergyTrace, ReadsBackBitForBit) {
  const TemporaryFolder folder;
  const EnergyTrace trace = random_trace();
  trace.save(folder / "trace.csv");
  const EnergyTrace back = EnergyTrace::load(folder / "trace.csv");
  expect_same_bits(trace, back);
  back.save(folder / "again.csv");
  EXPECT_EQ(folder.text_of("again.csv"), folder.text_of("trace.csv"));
}

TEST(EnergyTrace, FileIsOneTableWithUnits) {
  const TemporaryFolder folder;
  TraceRow row;
  EnergyTrace trace;
  trace.add(row);
  row.time = 0.5;
  trace.add(row);
  trace.add(TraceEvent{0.25, "a, b"});
  trace.save(folder / "trace.csv");
  std::istringstream lines(folder.text_of("trace.csv"));
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line.find("time [s],kinetic [J],gravity [J],"), 0u) << line;
  EXPECT_NE(line.find(",momentum_x [N s],"), std::string::npos) << line;
  EXPECT_NE(line.find(",angular_momentum_z [N m s],"), std::string::npos) << line;
  EXPECT_NE(line.find(",penetration [m],joint_error [m],length_scale [m],event"), std::string::npos) << line;
  std::getline(lines, line);
  EXPECT_EQ(line.find("0,0,0,"), 0u) << line;
  std::getline(lines, line);
  EXPECT_EQ(line, "0.25" + std::string(trace_term_count, ',') + "\"a, b\"");
  std::getline(lines, line);
  EXPECT_EQ(line.find("0.5,0,"), 0u) << line;
}

/// Decimal comma, thousands apart.
struct Continental : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

TEST(EnergyTrace, DigitsDoNotDependOnTheLocale) {
  const TemporaryFolder folder;
  const EnergyTrace trace = random_trace();
  const std::locale before = std::locale::global(std::locale(std::locale::classic(), new Continental));
  trace.save(folder / "trace.csv");
  const EnergyTrace back = EnergyTrace::load(folder / "trace.csv");
  std::locale::global(before);
  expect_same_bits(trace, back);
}

TEST(EnergyTrace, ColumnsMayStandInAnyOrderAndLinesEndAsOnWindows) {
  const TemporaryFolder folder;
  // The event column first.
  EnergyTrace plain;
  TraceRow row;
  row.stored[StoredEnergy::gravity] = 2.5;
  plain.add(row);
  plain.add(TraceEvent{0.5, "e"});
  plain.save(folder / "plain.csv");
  std::istringstream in(folder.text_of("plain.csv"));
  std::string text, line;
  while (std::getline(in, line)) {
    const std::size_t comma = line.rfind(',');
    text += line.substr(comma + 1) + "," + line.substr(0, comma) + "\r\n";
  }
  folder.write("other.csv", text);
  expect_same_bits(EnergyTrace::load(folder / "other.csv"), plain);
}

/// One way to break a file: a text in it and what is put there instead; and what the message must say.
struct Broken {
  const char* name;
  const char* text;
  const char* instead;
  std::vector<std::string> says;
};

class EnergyTraceBrokenFile : public testing::TestWithParam<Broken> {};

TEST_P(EnergyTraceBrokenFile, IsRefusedByName) {
  const TemporaryFolder folder;
  EnergyTrace trace;
  for (const double time : {0.0, 0.5, 0.75}) {
    TraceRow row;
    row.time = time;
    row.stored[StoredEnergy::kinetic] = 17.25;
    row.length_scale = 42.0;
    trace.add(row);
  }
  trace.add(TraceEvent{0.25, "bounce"});
  trace.save(folder / "trace.csv");
  std::string content = folder.text_of("trace.csv");
  const Broken& broken = GetParam();
  const std::size_t at = content.find(broken.text);
  ASSERT_NE(at, std::string::npos);
  content.replace(at, std::string_view(broken.text).size(), broken.instead);
  folder.write("trace.csv", content);
  try {
    (void)EnergyTrace::load(folder / "trace.csv");
    FAIL() << "nothing was thrown";
  } catch (const FileError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find(folder / "trace.csv"), std::string::npos) << message;
    for (const std::string& text : broken.says) EXPECT_NE(message.find(text), std::string::npos) << message;
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, EnergyTraceBrokenFile,
    testing::Values(
        Broken{"not_a_number",
               "0.5,17.25",
               "0.5,17.25x",
               {"line 4", "'kinetic [J]'", "'17.25x'", "a finite number"}},
        Broken{"empty_number", "0.5,17.25", "0.5,", {"line 4", "'kinetic [J]'", "''", "a finite number"}},
        Broken{"nan", "0.5,17.25", "0.5,nan", {"line 4", "'kinetic [J]'", "'nan'", "a finite number"}},
        Broken{"too_large", "0.5,17.25", "0.5,1e999", {"line 4", "'1e999'", "a finite number"}},
        Broken{"missing_cell", "0.5,17.25", "0.5", {"line 4", "columns", "as the header"}},
        Broken{"additional_cell", "0.5,17.25", "0.5,17.25,3", {"line 4", "columns", "as the header"}},
        Broken{
            "unknown_column", "gravity [J]", "gravity [J],warmth [J]", {"line 1", "'warmth [J]'", "unknown"}},
        Broken{
            "column_twice", "gravity [J]", "gravity [J],gravity [J]", {"line 1", "'gravity [J]'", "twice"}},
        Broken{"missing_column", "gravity [J],", "", {"line 1", "'gravity [J]' is missing"}},
        Broken{"other_unit", "gravity [J]", "gravity [kJ]", {"line 1", "'gravity [J]' is missing"}},
        Broken{"time_not_increasing", "\n0.5,", "\n0,", {"line 4", "'time [s]'", "'0'", "later"}},
        Broken{"time_repeated", "\n0.75,", "\n0.5,", {"line 5", "'time [s]'", "'0.5'", "later"}},
        Broken{"event_out_of_order", "\n0.25,", "\n-0.25,", {"line 3", "'-0.25'", "not before"}},
        Broken{"event_with_numbers", "\n0.25,,", "\n0.25,3,", {"line 3", "'kinetic [J]'", "'3'", "event"}},
        Broken{"open_quote", "bounce", "\"bounce", {"line 3", "quote is not closed"}},
        Broken{"stray_quote", "bounce", "bou\"nce", {"line 3", "quote is out of place"}}),
    [](const auto& broken) { return broken.param.name; });

TEST(EnergyTrace, CutOffFileIsRefused) {
  const TemporaryFolder folder;
  random_trace().save(folder / "trace.csv");
  const std::string content = folder.text_of("trace.csv");
  folder.write("cut.csv", content.substr(0, content.size() - 1));
  EXPECT_THROWS(FileError, EnergyTrace::load(folder / "cut.csv"), "cut.csv", "cut off");
  folder.write("empty.csv", "");
  EXPECT_THROWS(FileError, EnergyTrace::load(folder / "empty.csv"), "empty.csv", "empty");
  EXPECT_THROWS(FileError, EnergyTrace::load(folder / "none.csv"), "none.csv", "cannot be read");
  EXPECT_THROWS(FileError, EnergyTrace().save(folder / "no/such/place.csv"), "place.csv",
                "cannot be written");
}

}  // namespace
