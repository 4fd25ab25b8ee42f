#include <carom/core/errors.h>
#include <carom/core/trace_comparison.h>

#include "tests/integrators/throws.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <sstream>
#include <string>

namespace {

using namespace carom;

/// Ten rows 0.1 s apart with scales 100 J, 10 N s, 1 N m s, 20 m; `change` may spoil each.
EnergyTrace trace_with(const std::function<void(int, TraceRow&)>& change = {}) {
  EnergyTrace trace;
  trace.add(TraceEvent{0.33, "ball on floor, stick"});
  for (int i = 0; i < 10; ++i) {
    TraceRow row;
    row.time = 0.1 * i;
    row.stored[StoredEnergy::kinetic] = 100.0 - i;
    row.flows[EnergyFlow::sliding] = i;
    row.energy_scale = 100.0;
    row.momentum = {1.0, 2.0, 0.0};
    row.momentum_scale = 10.0;
    row.angular_momentum_scale = 1.0;
    row.penetration = 1e-3;
    row.length_scale = 20.0;
    if (change) change(i, row);
    trace.add(row);
  }
  return trace;
}

const TermComparison& term(const TraceComparison& comparison, std::string_view name) {
  for (const TermComparison& candidate : comparison.terms) {
    if (candidate.term.name == name) return candidate;
  }
  throw std::out_of_range(std::string(name));
}

TEST(TraceComparison, SameTracesAgreeWithoutTolerance) {
  const TraceComparison comparison = compare(trace_with(), trace_with(), {});
  EXPECT_TRUE(comparison.agree());
  EXPECT_EQ(comparison.report, "29 of 29 terms agree at 10 times\n");
  EXPECT_EQ(comparison.terms.size(), trace_term_count - 5);  // without time and four scales
  EXPECT_EQ(term(comparison, "kinetic").worst.ratio(), 0.0);
}

TEST(TraceComparison, NamesTheTermThatDepartsFirst) {
  const EnergyTrace trace = trace_with([](int i, TraceRow& row) {
    if (i >= 4) row.flows[EnergyFlow::sliding] += 2e-6 * i;
    if (i >= 6) row.stored[StoredEnergy::kinetic] -= 1.0;
    row.momentum[0] += 1e-9;
  });
  const TraceComparison comparison = compare(trace, trace_with(), {.relative = 1e-9, .energy = 1e-6});
  ASSERT_FALSE(comparison.agree());
  const TermComparison& first = comparison.terms[*comparison.first];
  EXPECT_EQ(first.term.name, "sliding");
  EXPECT_EQ(first.first->time, 0.1 * 4);
  EXPECT_NEAR(first.first->amount(), 8e-6, 1e-14);
  EXPECT_DOUBLE_EQ(first.first->allowed, 1e-6 + 1e-9 * 100.0);
  EXPECT_EQ(first.worst.time, 0.1 * 9);
  EXPECT_EQ(term(comparison, "kinetic").first->time, 0.1 * 6);
  EXPECT_FALSE(term(comparison, "momentum_x").first);

  std::ostringstream report;
  report << comparison;
  for (const char* text :
       {"'sliding' departs first: at t = 0.4 s by 8e-06 J, allowed 1.1e-06 J",
        "nearest event: t = 0.33 s (0.07 s before): ball on floor, stick", "nearest stored event: t = 0.33 s",
        "27 of 29 terms agree at 10 times", "the nearest to its limit is 'momentum_x' with 0.1 of it"}) {
    EXPECT_NE(report.str().find(text), std::string::npos) << text << "\n" << report.str();
  }
  // The table: sliding before kinetic, each with its worst.
  const std::size_t sliding = report.str().find("\n  sliding "), kinetic = report.str().find("\n  kinetic ");
  EXPECT_LT(sliding, kinetic);
  EXPECT_NE(kinetic, std::string::npos);
}

TEST(TraceComparison, OfSeveralAtOneTimeTheWorstComesFirst) {
  const EnergyTrace trace = trace_with([](int i, TraceRow& row) {
    if (i < 5) return;
    row.stored[StoredEnergy::kinetic] += 1e-3;
    row.flows[EnergyFlow::sliding] += 2e-3;
    row.residual += 1e-3;
  });
  const TraceComparison comparison = compare(trace, trace_with(), {.energy = 1e-6});
  EXPECT_EQ(comparison.terms[*comparison.first].term.name, "sliding");
}

TEST(TraceComparison, EveryQuantityHasItsTolerances) {
  struct Case {
    const char* term;
    std::function<void(TraceRow&)> change;
    TraceTolerances absolute;
    double scale;
  };
  // Changed by 1e-3 in the unit of the term each.
  const Case cases[] = {
      {"total", [](TraceRow& row) { row.total += 1e-3; }, {.energy = 1e-3}, 100.0},
      {"momentum_y", [](TraceRow& row) { row.momentum[1] += 1e-3; }, {.momentum = 1e-3}, 10.0},
      {"angular_momentum_z",
       [](TraceRow& row) { row.angular_momentum[2] += 1e-3; },
       {.angular_momentum = 1e-3},
       1.0},
      {"penetration", [](TraceRow& row) { row.penetration += 1e-3; }, {.length = 1e-3}, 20.0},
      {"joint_error", [](TraceRow& row) { row.joint_error += 1e-3; }, {.length = 1e-3}, 20.0},
  };
  for (const Case& one : cases) {
    const EnergyTrace trace = trace_with([&](int i, TraceRow& row) {
      if (i == 7) one.change(row);
    });
    const auto scaled = [](TraceTolerances t, double factor) {
      return TraceTolerances{.relative = factor * t.relative,
                             .energy = factor * t.energy,
                             .momentum = factor * t.momentum,
                             .angular_momentum = factor * t.angular_momentum,
                             .length = factor * t.length};
    };
    // 1.001: rounding of the differences of larger numbers.
    EXPECT_TRUE(compare(trace, trace_with(), scaled(one.absolute, 1.001)).agree()) << one.term;
    EXPECT_FALSE(compare(trace, trace_with(), scaled(one.absolute, 0.999)).agree()) << one.term;
    const TraceTolerances relative{.relative = 1e-3 / one.scale};
    EXPECT_TRUE(compare(trace, trace_with(), scaled(relative, 1.001)).agree()) << one.term;
    const TraceComparison departs = compare(trace, trace_with(), scaled(relative, 0.999));
    ASSERT_FALSE(departs.agree()) << one.term;
    EXPECT_EQ(departs.terms[*departs.first].term.name, one.term);
    EXPECT_EQ(departs.terms[*departs.first].first->time, 0.1 * 7);
  }
}

TEST(TraceComparison, ScalesAreNotCompared) {
  EXPECT_TRUE(
      compare(trace_with([](int, TraceRow& row) { row.energy_scale = 300.0; }), trace_with(), {}).agree());
}

TEST(TraceComparison, NothingIsInterpolated) {
  const EnergyTrace stored = trace_with();
  const EnergyTrace late = trace_with([](int i, TraceRow& row) {
    if (i == 4) row.time += 1e-9;
  });
  EXPECT_THROWS(ModelError, compare(late, stored, {}), "row 4", "0.4000000010", "0.4 s", "same times");
  const EnergyTrace rounded = trace_with([](int i, TraceRow& row) {
    if (i == 4) row.time = std::nextafter(row.time, 1.0);
  });
  EXPECT_TRUE(compare(rounded, stored, {}).agree());
  EnergyTrace longer = trace_with();
  TraceRow row;
  row.time = 1.0;
  longer.add(row);
  EXPECT_THROWS(ModelError, compare(longer, stored, {}), "11 rows", "stored one 10", "same times");
  EXPECT_THROWS(ModelError, compare(EnergyTrace(), stored, {}), "trace has no rows");
  EXPECT_THROWS(ModelError, compare(stored, EnergyTrace(), {}), "stored trace has no rows");
}

TEST(TraceComparison, RefusesTolerancesThatCannotBe) {
  const EnergyTrace trace = trace_with();
  EXPECT_THROWS(ModelError, compare(trace, trace, {.relative = -1e-3}), "relative is -0.001", ">= 0");
  EXPECT_THROWS(ModelError, compare(trace, trace, {.energy = std::nan("")}), "energy is nan");
  EXPECT_THROWS(ModelError, compare(trace, trace, {.length = std::numeric_limits<double>::infinity()}),
                "length is inf");
}

TEST(TraceComparison, WithoutEventsItSaysSo) {
  EnergyTrace a, b;
  TraceRow row;
  a.add(row);
  row.total = 1.0;
  b.add(row);
  const TraceComparison comparison = compare(a, b, {});
  EXPECT_NE(comparison.report.find("nearest event: none"), std::string::npos) << comparison.report;
  EXPECT_NE(comparison.report.find("allowed 0 J"), std::string::npos) << comparison.report;
}

}  // namespace
