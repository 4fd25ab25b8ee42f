// The paper's main problem (Johansson 1999, section 6): the bar and the particle-spring pair that fall on an
// inclined plane. Reference: closed-form flight (bar) and 80-bit extrapolation (pair) between impacts.

#include "tests/analytic/convergence.h"
#include "tests/reference/incline_run.h"
#include "tests/shares.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace {

using namespace carom_test;

constexpr double g = scenes::gravity;
constexpr double eps = std::numeric_limits<double>::epsilon();

struct Case {
  std::string name;
  Json data;
  bool is_bar;
  double end;
  scenes::Incline incline;
};

std::vector<Case> cases(const std::string& file, const std::string& kind) {
  std::vector<Case> result;
  const Json all = reference_data(file);
  int count = 0;
  for (const auto& [key, data] : all.at(kind).items()) {
    const Json& parameters = data.contains("parameters") ? data.at("parameters") : data;
    const double end = data.contains("t_end") ? data.at("t_end").get<double>()
                                              : data.at("state_at_end").at("t").get<double>();
    result.push_back({file + " " + kind + " " + std::to_string(count++) + " " + key, data, kind == "bar", end,
                      incline_of(parameters)});
  }
  return result;
}

double fastest_approach(const Case& c) {
  double speed = 0.0;
  for (const Json& impact : c.data.at("impacts"))
    speed = std::max(speed, -impact.at("contact_minus")[1].get<double>());
  return speed;
}

void expect_same_impacts(const Case& c, const InclineRun& run, double step) {
  const Json& impacts = c.data.at("impacts");
  ASSERT_EQ(run.impacts.size(), impacts.size()) << c.name << " h = " << step;
  for (std::size_t i = 0; i < impacts.size(); ++i) {
    EXPECT_EQ(run.impacts[i].mode, reference_mode(impacts[i]))
        << c.name << " h = " << step << " impact " << i;
    EXPECT_EQ(run.impacts[i].upper, reference_upper(impacts[i], c.is_bar)) << c.name << " impact " << i;
  }
  // The first impact comes after free flight alone: found at the end of the step in which it falls, and
  // treated over the next. (Trapezoidal steps follow the parabola, or the unstretched pair, exactly.)
  const double late = run.impacts[0].time - impacts[0].at("t").get<double>();
  EXPECT_GE(late, step - 1e-12) << c.name << " h = " << step;
  EXPECT_LE(late, 2.0 * step + 1e-12) << c.name << " h = " << step;
}

// A contact is noticed up to one step late, after h |v_n|, and leaves its step with the mean of the speeds
// before and after, another (1 - e_n)/2 h |v_n|; gravity adds less than g h^2 to both. (The springs add
// nothing visible: the bound is approached by the first impact, before which they are not stretched.)
void expect_penetration_bounded(const Case& c, const InclineRun& run, double step) {
  const double bound =
      0.5 * (3.0 - c.incline.normal_restitution) * step * fastest_approach(c) + g * step * step;
  EXPECT_LE(-run.deepest_gap, bound) << c.name << " h = " << step;
  EXPECT_LT(run.deepest_gap, 0.0) << c.name << " h = " << step;
}

void expect_run_right(const Case& c, double step) {
  const InclineRun run = run_incline(c.incline, c.is_bar, c.end, carom::TimeStepping{.step = step});
  expect_same_impacts(c, run, step);
  expect_penetration_bounded(c, run, step);
  EXPECT_LE(std::abs(run.residual), 1e3 * eps * run.scale) << c.name;
  EXPECT_EQ(run.statistics.several_solutions, 0) << c.name;
  EXPECT_LE(run.statistics.worst_residual, 1e-12) << c.name;
  if (c.incline.normal_restitution == c.incline.tangential_restitution) {
    EXPECT_EQ(run.statistics.energy_gains, 0) << c.name;
  }
}

/// Mean order of the error of all coordinates at the end.
analytic::MeanOrder order(const Case& c, double largest_step, int bins, int steps_per_bin) {
  const std::vector<double> reference = reference_end(c.data.at("state_at_end"), c.is_bar);
  return analytic::mean_order(largest_step, bins, steps_per_bin, [&](double step) {
    return distance(run_incline(c.incline, c.is_bar, c.end, carom::TimeStepping{.step = step}).q, reference);
  });
}

// The slope is that of the means of a sample; three of its standard deviations, as the scatter of the sample
// gives them, are allowed. A sample that leaves the slope open by more than `largest` would prove nothing.
void expect_order_one(const analytic::MeanOrder& found, const std::string& name, double largest) {
  EXPECT_LE(std::abs(found.slope - 1.0), 3.0 * found.deviation) << name << ": slope " << found.slope;
  EXPECT_LE(3.0 * found.deviation, largest) << name;
  testing::Test::RecordProperty(name, std::to_string(found.slope) + " +- " + std::to_string(found.deviation));
}

TEST(InclineBodies, SameImpactsInTheSameMode) {
  // The pair of case phi = -0.1, th0 = 0.3 strikes with its upper particle near the border of sticking
  // (contact speeds 1.50 before, -1.04 after): steps above 3e-4 s find it sticking. All others agree from
  // 2e-3 s on.
  for (const char* kind : {"bar", "pair"}) {
    for (const Case& c : cases("incline_bodies.json", kind)) {
      for (const double step : {2.5e-4, 1.57e-4}) expect_run_right(c, step);
      if (c.is_bar) expect_run_right(c, 1.0 / 1200.0);  // the paper's step
    }
  }
}

TEST(InclineBodies, BarOrderOneInTheMean) {
  for (const Case& c : cases("incline_bodies.json", "bar"))
    expect_order_one(order(c, 8e-3, 4, 32), c.name, 0.25);
}

// A share of the steps leaves the slope open by as much more as its root is smaller: of the usual ones half
// are taken at least.
struct Sample {
  int steps_per_bin;
  double largest;
};
Sample sample(int all, double largest, int share) {
  const auto most = static_cast<std::uint64_t>(all);
  const std::uint64_t usual = most / static_cast<std::uint64_t>(share);
  const auto taken = static_cast<int>(std::max(usual / 2, carom_test::seeds(usual, most)));
  return {taken, largest * std::sqrt(static_cast<double>(all) / taken)};
}

TEST(InclineBodiesLong, BarOrderOneInTheMean) {
  const Sample steps = sample(200, 0.09, 2);
  for (const Case& c : cases("incline_bodies.json", "bar"))
    expect_order_one(order(c, 2e-3, 4, steps.steps_per_bin), c.name, steps.largest);
}

TEST(InclineBodiesLong, PairOrderOneInTheMean) {
  // The spring turns the delay of one impact into the conditions of the next: the errors scatter more, and
  // larger steps see the kink where the second impact begins to stick.
  const Sample steps = sample(120, 0.15, 3);
  for (const Case& c : cases("incline_bodies.json", "pair"))
    expect_order_one(order(c, 3e-4, 4, steps.steps_per_bin), c.name, steps.largest);
}

TEST(InclineBodiesLong, BarWithinAMillimetreAtSmallSteps) {
  for (const Case& c : cases("incline_bodies.json", "bar")) {
    constexpr double step = 1e-5;
    const InclineRun run = run_incline(c.incline, true, c.end, carom::TimeStepping{.step = step});
    const std::vector<double> reference = reference_end(c.data.at("state_at_end"), true);
    // Asked for: 1e-3 m. The delay of the impact (at most h) times the change of velocity (at most 40 m/s)
    // moves the flight by 4e-4 m; the change of the impact itself with the angle adds as much.
    EXPECT_LE(std::hypot(run.q[0] - reference[0], run.q[1] - reference[1]), 1e-3) << c.name;
    EXPECT_LE(std::abs(run.q[2] - reference[2]), 1e-3) << c.name;
    expect_run_right(c, step);
  }
}

TEST(InclineBodiesLong, PairSameImpactsAtSmallSteps) {
  for (const Case& c : cases("incline_bodies.json", "pair")) {
    for (const double step : {2e-5, 1e-5}) expect_run_right(c, step);
  }
}

TEST(OpenVariants, SameImpactsInTheSameMode) {
  // The fifth pair bounces three times; its upper particle comes to strike once more above 6e-4 s.
  for (const char* kind : {"bar", "pair"}) {
    for (const Case& c : cases("open_variants.json", kind)) expect_run_right(c, 2.3e-4);
  }
}

TEST(OpenVariantsLong, OrderOneInTheMean) {
  const Sample steps = sample(48, 0.25, 2);
  for (const char* kind : {"bar", "pair"}) {
    for (const Case& c : cases("open_variants.json", kind))
      expect_order_one(order(c, 5e-4, 4, steps.steps_per_bin), c.name, steps.largest);
  }
}

}  // namespace
