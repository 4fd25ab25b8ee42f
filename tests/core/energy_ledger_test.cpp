#include <carom/core/energy_ledger.h>

#include "tests/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <sstream>
#include <string>

namespace {

using namespace carom;
constexpr double epsilon = std::numeric_limits<double>::epsilon();

constexpr EnergyFlow flow_number(std::size_t i) { return static_cast<EnergyFlow>(i); }

StoredEnergies stored(double kinetic, double gravity, double elastic = 0.0, double potential = 0.0) {
  return {{kinetic, gravity, elastic, potential}};
}

TEST(EnergyTerm, EveryTermHasItsOwnName) {
  std::set<std::string_view> names;
  for (std::size_t i = 0; i < stored_energy_count; ++i) names.insert(to_string(static_cast<StoredEnergy>(i)));
  for (std::size_t i = 0; i < energy_flow_count; ++i) names.insert(to_string(flow_number(i)));
  EXPECT_EQ(names.size(), stored_energy_count + energy_flow_count);
  EXPECT_FALSE(names.contains(""));
  EXPECT_EQ(to_string(StoredEnergy::potential), "potential");
  EXPECT_EQ(to_string(EnergyFlow::external), "external");
  EXPECT_EQ(to_string(EnergyFlow::coupling_discretisation), "coupling_discretisation");
}

TEST(EnergyTerm, OnlyExternalWorkAndInterventionsAreGains) {
  for (std::size_t i = 0; i < energy_flow_count; ++i) {
    EXPECT_EQ(is_gain(flow_number(i)),
              flow_number(i) == EnergyFlow::external || flow_number(i) == EnergyFlow::intervention);
  }
}

TEST(EnergyTerm, PotentialDoesNotRoundAtTheSizeOfTheKineticEnergy) {
  const StoredEnergies energies = stored(1e17, 1.0, 2.0, 4.0);
  EXPECT_EQ(energies.potential(), 7.0);
  EXPECT_EQ(energies.total(), 1e17);
}

TEST(EnergyLedger, OpensWithoutFlows) {
  EnergyLedger ledger;
  ledger.open(stored(1.0, -5.0, 2.0, 0.5));
  EXPECT_EQ(ledger.initial(), -1.5);
  EXPECT_EQ(ledger.total(), -1.5);
  EXPECT_EQ(ledger.kinetic(), 1.0);
  EXPECT_EQ(ledger.potential(), -2.5);
  EXPECT_EQ(ledger.stored(StoredEnergy::gravity), -5.0);
  EXPECT_EQ(ledger.lost(), 0.0);
  EXPECT_EQ(ledger.residual(), 0.0);
  EXPECT_EQ(ledger.scale(), 5.0);
}

TEST(EnergyLedger, EachFlowStandsOnItsSide) {
  for (std::size_t i = 0; i < energy_flow_count; ++i) {
    EnergyLedger ledger;
    ledger.open(stored(10.0, 0.0));
    EnergyFlows flows;
    flows[flow_number(i)] = 3.0;
    const bool gain = is_gain(flow_number(i));
    ledger.book(flows, stored(gain ? 13.0 : 7.0, 0.0));
    EXPECT_EQ(ledger.residual(), 0.0) << to_string(flow_number(i));
    EXPECT_EQ(ledger.flow(flow_number(i)), 3.0);
    EXPECT_EQ(ledger.lost(), gain ? 0.0 : 3.0);
  }
}

TEST(EnergyLedger, OneFlowIsBookedAsAmongOthersThatAreZero) {
  carom_test::Random random(5);
  EnergyLedger one, among;
  one.open(stored(1.0, 2.0));
  among.open(stored(1.0, 2.0));
  for (int step = 0; step < 100; ++step) {
    const EnergyFlow flow = flow_number(static_cast<std::size_t>(step) % energy_flow_count);
    const double amount = step % 7 == 0 ? 0.0 : random.uniform(-3.0, 3.0);
    const StoredEnergies now = stored(random.uniform(0.0, 1.0), random.uniform(-4.0, 4.0));
    EnergyFlows flows;
    flows[flow] = amount;
    one.book(flow, amount, now);
    among.book(flows, now);
    EXPECT_EQ(one.save(), among.save());
  }
}

TEST(EnergyLedger, ResidualIsWhatTheFlowsDoNotExplain) {
  EnergyLedger ledger;
  ledger.open(stored(10.0, 0.0));
  EnergyFlows flows;
  flows[EnergyFlow::sliding] = 2.0;
  ledger.book(flows, stored(8.5, 0.0));
  EXPECT_EQ(ledger.residual(), 0.5);
}

TEST(EnergyLedger, ClosesOverManySmallBookings) {
  carom_test::Random random(31);
  EnergyLedger ledger;
  StoredEnergies energies = stored(5.0, -3.0, 2.0, 1.0);
  ledger.open(energies);
  double exchanged = 0.0;
  for (int step = 0; step < 200'000; ++step) {
    EnergyFlows flows;
    double change = 0.0;
    for (std::size_t i = 0; i < energy_flow_count; ++i) {
      const double flow = std::ldexp(std::floor(random.uniform(-64.0, 64.0)), -40);
      flows.values[i] = flow;
      change += is_gain(flow_number(i)) ? flow : -flow;
    }
    const double shift = std::ldexp(std::floor(random.uniform(-64.0, 64.0)), -30);
    // Multiples of 2^-40 below 2^12: stored energies are exact, all rounding is the ledger's.
    energies[StoredEnergy::kinetic] += change + shift;
    energies[StoredEnergy::elastic] -= shift;
    exchanged += std::abs(change);
    ledger.book(flows, energies);
  }
  EXPECT_GT(exchanged, 1e-6);
  EXPECT_LE(std::abs(ledger.residual()), epsilon * ledger.scale());
}

TEST(EnergyLedger, ScaleIsTheLargestTermThatEverEntered) {
  EnergyLedger ledger;
  ledger.open(stored(1.0, -4.0));
  EXPECT_EQ(ledger.scale(), 4.0);
  EnergyFlows flows;
  flows[EnergyFlow::dashpot] = -9.0;
  ledger.book(flows, stored(0.5, 0.0));
  EXPECT_EQ(ledger.scale(), 9.0);
  flows[EnergyFlow::dashpot] = 9.0;
  ledger.book(flows, stored(0.0, 0.0, 20.0));
  ledger.book({}, stored(0.0, 0.0));
  EXPECT_EQ(ledger.scale(), 20.0);
}

TEST(EnergyLedger, OpeningForgetsWhatFlowed) {
  EnergyLedger ledger;
  ledger.open(stored(1.0, 0.0));
  EnergyFlows flows;
  flows[EnergyFlow::rolling] = 100.0;
  ledger.book(flows, stored(0.0, 0.0));
  ledger.open(stored(2.0, 0.0));
  EXPECT_EQ(ledger.flow(EnergyFlow::rolling), 0.0);
  EXPECT_EQ(ledger.scale(), 2.0);
  EXPECT_EQ(ledger.residual(), 0.0);
}

TEST(EnergyLedger, GoesOnBitForBitAfterSaving) {
  carom_test::Random random(32);
  EnergyLedger whole;
  whole.open(stored(0.1, 0.2, 0.3, 0.4));
  EnergyLedger resumed;
  for (int step = 0; step < 200; ++step) {
    if (step == 100) resumed.load(whole.save());
    EnergyFlows flows;
    for (double& flow : flows.values) flow = random.uniform(-1.0, 1.0) / 3.0;
    const StoredEnergies energies = stored(random.uniform(0.0, 1.0), random.uniform(-1.0, 1.0));
    whole.book(flows, energies);
    if (step >= 100) resumed.book(flows, energies);
  }
  EXPECT_EQ(whole.save(), resumed.save());
  EXPECT_EQ(whole.residual(), resumed.residual());
  EXPECT_EQ(whole.initial(), resumed.initial());
}

TEST(EnergyLedger, TheTableShowsTermsThatAreNotZeroAndLeavesTheStreamAsItWas) {
  EnergyLedger ledger;
  ledger.open(stored(10.0, 0.0));
  EnergyFlows flows;
  flows[EnergyFlow::impact_normal] = 2.25;
  ledger.book(flows, stored(7.75, 0.0));
  std::ostringstream out;
  const auto flags = out.flags();
  const auto precision = out.precision();
  out << ledger;
  const std::string text = out.str();
  for (const char* word :
       {"kinetic", "7.75 J", "total", "initial", "10 J", "impact_normal", "2.25 J", "residual"}) {
    EXPECT_NE(text.find(word), std::string::npos) << word << " is not in\n" << text;
  }
  EXPECT_EQ(text.find("gravity"), std::string::npos);
  EXPECT_EQ(text.find("sliding"), std::string::npos);
  EXPECT_EQ(out.flags(), flags);
  EXPECT_EQ(out.precision(), precision);
}

}  // namespace
