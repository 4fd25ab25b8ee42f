// Event-driven runs of the paper's main problem (Johansson 1999, section 6) and its variants: the bar and the
// particle-spring pair over an inclined plane; and the spring pendulum, which is smooth.

#include "tests/integrators/event_run.h"
#include "tests/reference/incline_run.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using namespace carom_test;

// Relative to the largest component. Bars fly on parabolas, which the Runge-Kutta methods follow exactly.
// Pairs are 20 m from the origin: a step may be wrong by 1e-11 of that, which the spring (omega = 45 1/s)
// turns into 1e-8 m/s of 20 m/s, over some hundred steps; impacts hand it on.
struct Tolerances {
  double bar = 1e-12, pair = 1e-8;
};

/// All cases of a kind in a file: given by name in one, in turn in the other.
std::vector<Json> cases(const std::string& file, const std::string& kind) {
  const Json all = reference_data(file);
  std::vector<Json> result;
  for (const auto& [name, at] : all.at(kind).items()) result.push_back(at);
  return result;
}

struct Course {
  std::vector<double> q, v;  // at the end, in the order of the reference
};

Course course_of(const State& state, bool is_bar, BodyId first, BodyId second) {
  Course course;
  for (const BodyId body : {first, second}) {
    if (is_bar && body == second) continue;
    for (int i = 0; i < 2; ++i) {
      course.q.push_back(state.position(body)[i]);
      course.v.push_back(state.velocity(body)[i]);
    }
  }
  if (is_bar) {
    course.q.push_back(state.angle(first));
    course.v.push_back(state.spin(first));
  }
  return course;
}

double error(const std::vector<double>& found, const std::vector<double>& expected) {
  double largest = 0.0, worst = 0.0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    largest = std::max(largest, std::abs(expected[i]));
    worst = std::max(worst, std::abs(found[i] - expected[i]));
  }
  return worst / largest;
}

struct Errors {
  Worst time, speed, state;
};

void expect_run_right(const Json& data, bool is_bar, const EventDriven& options, Errors& errors) {
  const scenes::Incline incline = incline_of(data.contains("parameters") ? data.at("parameters") : data);
  System system;
  scenes::add_plane(system, incline);
  BodyId first{}, second{};
  if (is_bar) {
    first = scenes::add_bar(system, incline);
  } else {
    const scenes::Pair pair = scenes::add_pair(system, incline);
    first = pair.lower;
    second = pair.upper;
  }
  Simulation simulation(std::move(system), options);
  const LedgerWatch ledger(simulation);
  const Json& end = data.at("state_at_end");
  simulation.run_until(data.contains("t_end") ? data.at("t_end").get<double>() : end.at("t").get<double>());

  const Json& impacts = data.at("impacts");
  ASSERT_EQ(simulation.events().size(), impacts.size());
  for (std::size_t i = 0; i < impacts.size(); ++i) {
    const EventRecord& found = simulation.events()[i];
    EXPECT_EQ(found.kind, EventKind::impact);
    EXPECT_EQ(std::string(to_string(found.mode)), reference_mode(impacts[i])) << i;
    EXPECT_EQ(is_bar ? found.contact.a.feature == 1 : found.body == second,
              reference_upper(impacts[i], is_bar));
    errors.time(found.time, impacts[i].at("t").get<double>(), found.time);
    for (std::size_t row = 0; row < 2; ++row) {  // the reference has the tangent first
      const double before = impacts[i].at("contact_minus")[row].get<double>();
      const double after = impacts[i].at("contact_plus")[row].get<double>();
      const double scale = std::abs(impacts[i].at("contact_minus")[1].get<double>());
      errors.speed(found.velocity_before[1 - row], before, scale);
      errors.speed(found.velocity_after[1 - row], after, scale);
    }
  }
  const Course course = course_of(simulation.state(), is_bar, first, second);
  std::vector<double> v = is_bar ? end.at("velocity").get<std::vector<double>>()
                                 : end.at("velocities").get<std::vector<double>>();
  if (is_bar) v.push_back(end.at("spin").get<double>());
  errors.state(error(course.q, reference_end(end, is_bar)), 0.0);
  errors.state(error(course.v, v), 0.0);
  // The file counts heights from the origin, as gravity does.
  errors.state(simulation.energy().total(), end.at("energy").get<double>(), end.at("energy").get<double>());
  EXPECT_TRUE(ledger.closes());
}

void expect_all_right(const std::string& file, std::size_t count, FlowMethod method,
                      const Tolerances& tolerances) {
  for (const bool is_bar : {true, false}) {
    const std::vector<Json> all = cases(file, is_bar ? "bar" : "pair");
    ASSERT_EQ(all.size(), count);
    Errors errors;
    for (std::size_t i = 0; i < all.size(); ++i) {
      SCOPED_TRACE(file + (is_bar ? " bar " : " pair ") + std::to_string(i));
      expect_run_right(all[i], is_bar, tight(method), errors);
    }
    const double tolerance = is_bar ? tolerances.bar : tolerances.pair;
    const std::string name = file + (is_bar ? " bar" : " pair");
    EXPECT_LE(errors.time.value(), tolerance) << name;
    EXPECT_LE(errors.speed.value(), tolerance) << name;
    EXPECT_LE(errors.state.value(), tolerance) << name;
    note(name + " times", errors.time.value());
    note(name + " speeds", errors.speed.value());
    note(name + " states", errors.state.value());
  }
}

TEST(EventIncline, BarAndPair) {
  expect_all_right("incline_bodies.json", 6, FlowMethod::explicit_runge_kutta, {});
}

TEST(EventIncline, RandomBarsAndPairs) {
  expect_all_right("open_variants.json", 6, FlowMethod::explicit_runge_kutta, {});
}

TEST(EventIncline, ErrorsOfPairsFollowTheTolerance) {
  const std::vector<Json> all = cases("open_variants.json", "pair");
  for (int digits = 8; digits <= 11; ++digits) {
    const double tolerance = std::pow(10.0, -digits);
    Errors errors;
    for (std::size_t i = 0; i < all.size(); ++i) {
      SCOPED_TRACE(std::to_string(digits) + " digits, pair " + std::to_string(i));
      expect_run_right(all[i], false,
                       {.relative_tolerance = tolerance, .absolute_tolerance = 1e-2 * tolerance}, errors);
    }
    // As much as the best is allowed.
    EXPECT_LE(errors.state.value(), 1e3 * tolerance) << digits;
    note("states at 1e-" + std::to_string(digits), errors.state.value());
  }
}

TEST(EventIncline, OtherMethods) {
  // Steps that just pass their test, while explicit_runge_kutta keeps below it by a factor.
  expect_all_right("incline_bodies.json", 6, FlowMethod::one_step, {.pair = 3e-8});
  // Multistep methods start at order 1 behind every impact, in steps whose errors are as large as allowed.
  expect_all_right("incline_bodies.json", 6, FlowMethod::adams, {.bar = 1e-11, .pair = 3e-8});
  // The errors of bdf change the amplitude of every period alike and add up over a thousand steps.
  expect_all_right("incline_bodies.json", 6, FlowMethod::bdf, {.bar = 1e-10, .pair = 1e-7});
}

TEST(EventIncline, SpringPendulumIsSmooth) {
  Worst state;
  const std::vector<Json> all = cases("open_variants.json", "spring_pendulum");
  ASSERT_EQ(all.size(), 4u);
  for (const Json& at : all) {
    const auto start = at.at("start").get<std::vector<double>>();
    System system;
    system.add(Gravity{{0.0, -9.81}});
    const BodyId bob = system.add(Particle{.mass = at.at("m").get<double>(),
                                           .position = {start[0], start[1]},
                                           .velocity = {start[2], start[3]}});
    system.add(SpringDamper{.from = {ground, {0.0, 0.0}},
                            .to = bob,
                            .stiffness = at.at("k").get<double>(),
                            .free_length = at.at("l0").get<double>()});
    Simulation simulation(std::move(system), tight());
    const LedgerWatch ledger(simulation);
    for (const char* time : {"t1", "t4"}) {
      simulation.run_until(time[1] - '0');
      const State& now = simulation.state();
      const auto expected = at.at(time).get<std::vector<double>>();
      state(error({now.position(bob)[0], now.position(bob)[1], now.velocity(bob)[0], now.velocity(bob)[1]},
                  expected),
            0.0);
    }
    EXPECT_TRUE(simulation.events().empty());
    EXPECT_TRUE(ledger.closes());
  }
  EXPECT_LE(state.value(), 1e-9);  // a metre from the origin, omega = 13 1/s: a hundredth of a pair's
  note("states", state.value());
}

}  // namespace
