#include <carom/carom.h>
#include <carom/testing/matchers.h>

#include "tests/integrators/throws.h"
#include "tests/testing/verdict_of.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using namespace carom::energy_test;

/// A made-up trace whose elastic energy is off by `error`, of a scale of 4 J.
EnergyTrace off_by(double error) {
  EnergyTrace trace;
  for (const double time : {0.0, 1.0, 2.0}) {
    TraceRow row;
    row.time = time;
    row.stored[StoredEnergy::elastic] = 1.0 + (time == 1.0 ? error : 0.5 * error);
    row.residual = 1.0;  // of no concern
    row.energy_scale = 4.0;
    trace.add(row);
  }
  return trace;
}

TEST(ModesAgree, OrderIsFittedToTheDifferences) {
  EXPECT_NEAR(fitted_order(std::vector{1.0, 0.5, 0.25}, std::vector{3.0, 0.75, 0.1875}), 2.0, 1e-14);
  const auto traces = refine({0.4, 0.2, 0.1}, [](double step) { return off_by(3.0 * step * step); });
  EXPECT_THAT(traces, modes_agree_with_order_at_least(1.999, off_by(0.0)));
  EXPECT_REFUSES(modes_agree_with_order_at_least(2.001, off_by(0.0)), traces,
                 "the order is 2, wanted is at least 2.001", "step [s]", "0.4", "0.12", "0.03", "0.0075");
}

TEST(ModesAgree, LooksAtTheNamedTerms) {
  const auto traces = refine({0.4, 0.2}, [](double step) {
    const EnergyTrace trace = off_by(step * step);
    EnergyTrace changed;
    for (TraceRow row : trace.rows()) {
      row.flows[EnergyFlow::dashpot] = step;
      changed.add(row);
    }
    return changed;
  });
  EXPECT_THAT(traces, modes_agree_with_order_at_least(1.99, off_by(0.0)));
  EXPECT_THAT(traces,
              testing::Not(modes_agree_with_order_at_least(1.01, off_by(0.0), {"elastic", "dashpot"})));
  EXPECT_THAT(traces, modes_agree_with_order_at_least(0.99, off_by(0.0), {"elastic", "dashpot"}));
}

TEST(ModesAgree, RoundingShowsNoOrder) {
  const auto same = refine({0.4, 0.2, 0.1}, [](double) { return off_by(0.0); });
  EXPECT_REFUSES(modes_agree_with_order_at_least(1.0, off_by(0.0)), same, "no order can be seen",
                 "rounding, left out");
  // The last difference is rounding; the two before it show the order.
  const auto settled =
      refine({0.4, 0.2, 0.1}, [](double step) { return off_by(step < 0.15 ? 1e-15 : std::pow(step, 3)); });
  EXPECT_THAT(settled, modes_agree_with_order_at_least(2.99, off_by(0.0)));
}

TEST(ModesAgree, RefusesInputThatCannotBe) {
  const EnergyTrace reference = off_by(0.0);
  const auto run = [](double step) { return off_by(step); };
  EXPECT_THROWS(ModelError, check_order_at_least(refine({0.1}, run), 1.0, reference), "steps is 1",
                "at least 2");
  EXPECT_THROWS(ModelError, check_order_at_least(refine({0.1, 0.2}, run), 1.0, reference), "step is 0.2 s",
                "less than 0.1 s");
  EXPECT_THROWS(ModelError, check_order_at_least(refine({0.1, 0.0}, run), 1.0, reference), "step is 0 s");
  EXPECT_THROWS(ModelError, check_order_at_least(refine({0.2, 0.1}, run), std::nan(""), reference),
                "order is nan");
  EXPECT_THROWS(ModelError, check_order_at_least(refine({0.2, 0.1}, run), 1.0, reference, {"warmth"}),
                "'warmth'");
  EXPECT_THROWS(ModelError, check_order_at_least(refine({0.2, 0.1}, run), 1.0, reference, {"energy_scale"}),
                "'energy_scale'", "nor a scale");
  EXPECT_THROWS(ModelError, check_order_at_least(refine({0.2, 0.1}, run), 1.0, EnergyTrace()), "no rows");
}

/// A particle between the ground and nothing: m x'' = -k x from x = 1, at rest.
constexpr double mass = 2.0, stiffness = 50.0;

EnergyTrace oscillator(double step) {
  System system;
  const BodyId body = system.add(Particle{.mass = mass, .position = {1.0, 0.0}});
  system.add(SpringDamper{.from = ground, .to = body, .stiffness = stiffness, .free_length = 0.0});
  Simulation simulation(system, TimeStepping{.step = step});
  return record_at(simulation, {0.4, 0.8, 1.2, 1.6, 2.0});
}

TEST(ModesAgree, TimeSteppingWithTheClosedForm) {
  // V = k cos^2(w t)/2. The trapezoidal rule is late by (w h)^2/12 of the phase: a series in h^2, the next
  // term (w h)^2/10 < 1.6e-2 of the first at the largest step.
  EnergyTrace exact;
  const double omega = std::sqrt(stiffness / mass);
  for (int i = 0; i <= 5; ++i) {
    TraceRow row;
    row.time = 0.4 * i;
    row.stored[StoredEnergy::elastic] = 0.5 * stiffness * std::pow(std::cos(omega * row.time), 2);
    row.stored[StoredEnergy::kinetic] = 0.5 * stiffness * std::pow(std::sin(omega * row.time), 2);
    row.energy_scale = 0.5 * stiffness;
    exact.add(row);
  }
  const auto traces = refine({0.04, 0.02, 0.01, 0.005}, oscillator);
  EXPECT_THAT(traces, modes_agree_with_order_at_least(1.97, exact));
  EXPECT_THAT(traces, testing::Not(modes_agree_with_order_at_least(2.03, exact)));
}

TEST(ModesAgree, TimeSteppingWithItselfAtAMuchSmallerStep) {
  EXPECT_THAT(refine({0.02, 0.01, 0.005}, oscillator),
              modes_agree_with_order_at_least(1.97, oscillator(1e-4)));
}

}  // namespace
