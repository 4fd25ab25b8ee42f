#include <carom/core/errors.h>
#include <carom/testing/matchers.h>

#include "tests/integrators/throws.h"
#include "tests/testing/verdict_of.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <sstream>
#include <string>

namespace {

using namespace carom;
using namespace carom::energy_test;

/// Ten rows 0.1 s apart: 100 J turn from gravity into kinetic energy and then to friction.
EnergyTrace trace_with(const std::function<void(int, TraceRow&)>& change = {}) {
  EnergyTrace trace;
  trace.add(TraceEvent{0.41, "ball on floor, slip+"});
  for (int i = 0; i < 10; ++i) {
    TraceRow row;
    row.time = 0.1 * i;
    row.initial = 100.0;
    row.flows[EnergyFlow::sliding] = 2.0 * i;
    row.stored[StoredEnergy::kinetic] = 3.0 * i;
    row.stored[StoredEnergy::gravity] = 100.0 - 5.0 * i;
    row.total = row.stored.total();
    row.energy_scale = 100.0;
    row.momentum = {3.0, -4.0, 0.5};
    row.momentum_scale = 10.0;
    row.angular_momentum = {1.0, 2.0, 3.0};
    row.angular_momentum_scale = 20.0;
    row.length_scale = 5.0;
    if (change) change(i, row);
    trace.add(row);
  }
  return trace;
}

TEST(LedgerClosesWithin, HoldsWhereTheTermsAddUp) {
  EXPECT_THAT(trace_with(), ledger_closes_within(0.0));
  const EnergyTrace nearly = trace_with([](int i, TraceRow& row) { row.residual = i == 7 ? -1e-10 : 0.0; });
  EXPECT_THAT(nearly, ledger_closes_within(1.001e-12));
  EXPECT_THAT(nearly, ::testing::Not(ledger_closes_within(0.999e-12)));
}

TEST(LedgerClosesWithin, SaysWhereItOpensAndShowsTheTerms) {
  // From row 5 on, 1 J of friction is missing, from row 8 on 2 J.
  const EnergyTrace trace = trace_with([](int i, TraceRow& row) {
    if (i >= 5) row.flows[EnergyFlow::sliding] -= i >= 8 ? 2.0 : 1.0;
  });
  EXPECT_REFUSES(ledger_closes_within(1e-3), trace, "unexplained 1 J at t = 0.5 s, allowed 0.1 J",
                 "worst: 2 J at t = 0.8 s", "in 5 of 10 rows",
                 "nearest event: t = 0.41 s: ball on floor, slip+", "term [J]", "t = 0.4 s", "t = 0.5 s",
                 "sliding", "kinetic");
  // The residual of the ledger itself counts too.
  EXPECT_REFUSES(ledger_closes_within(1e-3),
                 trace_with([](int i, TraceRow& row) { row.residual = i == 3 ? -4.0 : 0.0; }),
                 "unexplained 4 J at t = 0.3 s", "residual");
}

TEST(LedgerClosesWithin, TakesALedgerToo) {
  EnergyLedger ledger;
  StoredEnergies stored;
  stored[StoredEnergy::kinetic] = 8.0;
  ledger.open(stored);
  EXPECT_THAT(ledger, ledger_closes_within(0.0));
  stored[StoredEnergy::kinetic] = 6.0;
  EnergyFlows flows;
  flows[EnergyFlow::dashpot] = 1.5;
  ledger.book(flows, stored);
  EXPECT_THAT(ledger, ledger_closes_within(0.1));
  EXPECT_REFUSES(ledger_closes_within(0.01), ledger, "unexplained 0.5 J, allowed 0.08 J", "dashpot",
                 "residual");
}

TEST(EnergyNeverRises, HoldsWhereItFallsOrWorkIsDone) {
  EXPECT_THAT(trace_with(), energy_never_rises(0.0));
  const EnergyTrace driven = trace_with([](int i, TraceRow& row) {
    row.total += 30.0 * i;
    row.flows[EnergyFlow::external] = 10.0 * i;
    row.flows[EnergyFlow::intervention] = 20.0 * i;
  });
  EXPECT_THAT(driven, energy_never_rises(1e-12));
}

TEST(EnergyNeverRises, SaysWhenItRisesAndShowsTheTerms) {
  const EnergyTrace trace = trace_with([](int i, TraceRow& row) {
    if (i == 4) row.total += 5.0;  // 2 J lost per row: a rise by 3 J
  });
  EXPECT_THAT(trace, energy_never_rises(3.001));
  EXPECT_REFUSES(energy_never_rises(0.5), trace, "by 3 J at t = 0.4 s, allowed 0.5 J",
                 "nearest event: t = 0.41 s", "total", "kinetic");
}

TEST(EnergyNeverRises, FindsASlowRise) {
  const EnergyTrace creeping = trace_with([](int i, TraceRow& row) { row.total = 100.0 + 0.1 * i; });
  EXPECT_REFUSES(energy_never_rises(0.25), creeping, "by 0.3 J at t = 0.3 s", "worst: 0.9 J at t = 0.9 s");
}

TEST(MomentumIsConservedIn, LooksAlongTheDirectionOnly) {
  const EnergyTrace trace = trace_with([](int i, TraceRow& row) { row.momentum[1] -= 0.5 * i; });
  EXPECT_THAT(trace, momentum_is_conserved_in({1.0, 0.0}, 0.0));
  EXPECT_THAT(trace, momentum_is_conserved_in(Vec<2>(-2.0, 0.0), 0.0));
  EXPECT_THAT(trace, momentum_is_conserved_in(Vec<3>(0.0, 0.0, 1.0), 0.0));
  // Along (3, 4)/5 it changes by 0.4 N s a row, of a scale of 10 N s.
  EXPECT_THAT(trace, momentum_is_conserved_in({3.0, 4.0}, 0.3601));
  EXPECT_REFUSES(momentum_is_conserved_in({3.0, 4.0}, 0.1), trace,
                 "momentum in the direction (3, 4, 0) has changed by 1.2 N s at t = 0.3 s, allowed 1 N s",
                 "worst: 3.6 N s at t = 0.9 s", "momentum_y", "momentum_scale");
}

TEST(AngularMomentumIsConservedAbout, ShiftsThePoint) {
  const EnergyTrace kept = trace_with();
  EXPECT_THAT(kept, angular_momentum_is_conserved_about({0.0, 0.0}, 0.0));
  // A constant force of 10 N along x through (0, 2): nothing about that point, 2 N s a row about the origin.
  const EnergyTrace pushed = trace_with([](int i, TraceRow& row) {
    row.momentum[0] += 1.0 * i;
    row.angular_momentum[2] -= 2.0 * i;
  });
  EXPECT_THAT(pushed, angular_momentum_is_conserved_about({0.0, 2.0}, 1e-15));
  EXPECT_THAT(pushed, angular_momentum_is_conserved_about({0.0, 0.0}, 0.901));
  EXPECT_REFUSES(angular_momentum_is_conserved_about({0.0, 0.0}, 0.25), pushed,
                 "about (0, 0, 0) has changed by 6 N m s at t = 0.3 s, allowed 5 N m s",
                 "angular_momentum_z");
  // In space each component counts.
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const EnergyTrace turned =
        trace_with([axis](int i, TraceRow& row) { row.angular_momentum[axis] += i == 6 ? 1.0 : 0.0; });
    EXPECT_THAT(turned, ::testing::Not(angular_momentum_is_conserved_about({1.0, 2.0, 3.0}, 1e-3)));
  }
}

TEST(ConstraintsHoldWithin, LooksAtContactsAndJoints) {
  EXPECT_THAT(trace_with(), constraints_hold_within(0.0));
  const EnergyTrace deep = trace_with([](int i, TraceRow& row) { row.penetration = i == 4 ? 2e-3 : 1e-4; });
  EXPECT_THAT(deep, constraints_hold_within(2.001e-3));
  EXPECT_REFUSES(constraints_hold_within(1e-3), deep, "violated by 0.002 m at t = 0.4 s, allowed 0.001 m",
                 "nearest event: t = 0.41 s", "penetration");
  const EnergyTrace torn = trace_with([](int i, TraceRow& row) { row.joint_error = i == 2 ? 3e-3 : 0.0; });
  EXPECT_REFUSES(constraints_hold_within(1e-3), torn, "0.003 m at t = 0.2 s", "joint_error");
}

TEST(TraceMatchers, SayWhatTheyDemand) {
  const auto text = [](const ::testing::Matcher<const EnergyTrace&>& matcher) {
    std::ostringstream out;
    matcher.DescribeTo(&out);
    return out.str();
  };
  EXPECT_EQ(text(ledger_closes_within(1e-12)), "the ledger closes within 1e-12 of its largest term");
  EXPECT_EQ(text(energy_never_rises(1e-3)), "the energy never rises by more than 0.001 J");
  EXPECT_EQ(text(constraints_hold_within(1e-3)), "constraints hold within 0.001 m");
  EXPECT_EQ(text(::testing::Not(momentum_is_conserved_in({1.0, 0.0}, 0.1))),
            "not: momentum is conserved within 0.1 of its scale");
  EXPECT_EQ(::testing::PrintToString(trace_with()), "trace of 10 times from 0 s to 0.9 s with 1 events");
}

TEST(TraceMatchers, RefuseInputThatCannotBe) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const EnergyTrace trace = trace_with();
  EXPECT_THROWS(ModelError, check_ledger_closes(EnergyTrace(), 1e-9), "no rows");
  EXPECT_THROWS(ModelError, check_ledger_closes(trace, -1.0), "tolerance is -1", ">= 0");
  EXPECT_THROWS(ModelError, check_energy_never_rises(trace, infinity), "tolerance is inf");
  EXPECT_THROWS(ModelError, check_momentum_in(trace, {0.0, 0.0}, 1e-9), "direction (0, 0, 0)", "> 0");
  EXPECT_THROWS(ModelError, check_momentum_in(trace, {infinity, 0.0}, 1e-9), "direction", "finite");
  EXPECT_THROWS(ModelError, check_angular_momentum_about(trace, {infinity, 0.0}, 1e-9), "point", "finite");
  EXPECT_THROWS(ModelError, check_constraints_within(trace, -1e-3), "tolerance is -0.001");
}

}  // namespace
