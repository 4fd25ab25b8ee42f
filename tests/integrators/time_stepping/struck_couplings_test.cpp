// Stiff springs, dampers, bushings and motors that something strikes: contact is solved within the linearised
// step of all components that it joins.

#include "tests/integrators/struck_couplings.h"

#include "tests/energy/ledger_check.h"
#include "tests/shares.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::ledger_closes;
using carom_test::StruckCouplings;

enum class Coupling { damper, spring, bushing, motor, on_a_pin };
constexpr std::array couplings{Coupling::damper, Coupling::spring, Coupling::bushing, Coupling::motor,
                               Coupling::on_a_pin};

BodyId add_disc(System& system, const Vec<2>& at, const Vec<2>& velocity) {
  const BodyId body = system.add(RigidBody{.mass = disc(1.0, 0.15), .position = at, .velocity = velocity});
  system.add(Disc{.body = body, .radius = 0.15});
  return body;
}

/// Two discs that something stiff couples, and a third that strikes the second.
System struck_pair(Coupling coupling, double restitution) {
  System system;
  system.set_default_law({.friction = 0.0, .normal_restitution = restitution});
  const BodyId a = add_disc(system, {0.0, 0.0}, {0.0, 0.0}), b = add_disc(system, {0.4, 0.0}, {0.0, 0.1});
  add_disc(system, {0.8, 0.03}, {-1.0, 0.0});
  const SpringDamper spring{.from = a, .to = b, .stiffness = 1e6, .damping = 2e3, .free_length = 0.4};
  switch (coupling) {
    case Coupling::damper:
      system.add(SpringDamper{.from = a, .to = b, .stiffness = 1.0, .damping = 1000.0, .free_length = 0.4},
                 "damper");
      break;
    case Coupling::spring:
      system.add(spring);
      break;
    case Coupling::bushing: {
      Bushing bushing{.from = a, .to = b, .rest = {0.4, 0.0, 0.0}};
      bushing.stiffness(0, 0) = bushing.stiffness(1, 1) = 1e6;
      bushing.stiffness(2, 2) = 1e4;
      bushing.damping(0, 0) = bushing.damping(1, 1) = 2e3;
      bushing.damping(2, 2) = 20.0;
      system.add(bushing);
      break;
    }
    case Coupling::motor:
      system.add(LinearActuator{
          .from = a, .to = b, .force = [](double, double, double rate) { return 1e4 * (0.2 - rate); }});
      break;
    case Coupling::on_a_pin:
      system.add(Revolute{.from = {ground, {0.0, 0.0}}, .to = a});
      system.add(spring);
      break;
  }
  return system;
}

double difference(const State& a, const State& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.q.size(); ++i) largest = std::max(largest, std::abs(a.q[i] - b.q[i]));
  return largest;
}

TEST(StruckCouplings, AStepOf2MsIsMadeAndTheAccountCloses) {
  for (const Coupling coupling : couplings) {
    for (const double restitution : {0.0, 0.5, 1.0}) {
      for (const ForceRule rule : {ForceRule::trapezoidal, ForceRule::energy_momentum}) {
        for (const ImpactTimes impacts : {ImpactTimes::at_step_start, ImpactTimes::located}) {
          Simulation simulation(struck_pair(coupling, restitution),
                                TimeStepping{.step = 2e-3, .impacts = impacts, .force_rule = rule});
          ASSERT_NO_THROW(simulation.run_until(0.5)) << static_cast<int>(coupling) << " " << restitution;
          EXPECT_TRUE(ledger_closes(simulation.energy()));
          EXPECT_GE(simulation.statistics().impacts, 1);
          EXPECT_GE(simulation.statistics().fallbacks, 1);
        }
      }
    }
  }
}

/// Nothing acts from without, and no coupling turns the whole.
TEST(StruckCouplings, LinearMomentumIsKept) {
  for (const Coupling coupling : {Coupling::damper, Coupling::spring, Coupling::bushing, Coupling::motor}) {
    Simulation simulation(struck_pair(coupling, 0.5), TimeStepping{.step = 2e-3});
    simulation.run_until(0.5);
    Vec<2> momentum(0.0, 0.0);
    for (const BodyId body : simulation.system().bodies()) momentum += simulation.state().velocity(body);
    // Velocities of 1 m/s; the iteration ends at h times 1e-12 m/s, and couplings multiply that by h^2 k/m.
    EXPECT_NEAR(momentum[0], -1.0, 1e-12) << static_cast<int>(coupling);
    EXPECT_NEAR(momentum[1], 0.1, 1e-12) << static_cast<int>(coupling);
  }
}

/// \param impacts when \param order of the step that errors fall with at least \param largest at the shortest
void expect_convergence(ImpactTimes impacts, double order, double largest) {
  for (const Coupling coupling : couplings) {
    for (const double restitution : carom_test::samples({0.5, 1.0})) {
      Simulation reference(struck_pair(coupling, restitution), EventDriven{.method = FlowMethod::bdf});
      reference.run_until(0.5);
      const auto error = [&](double step) {
        Simulation simulation(struck_pair(coupling, restitution),
                              TimeStepping{.step = step, .impacts = impacts});
        simulation.run_until(0.5);
        return difference(simulation.state(), reference.state());
      };
      const double coarse = error(1e-3), fine = error(1.25e-4);
      EXPECT_LE(fine, coarse * std::pow(0.125, order))
          << static_cast<int>(coupling) << " " << restitution << ": " << coarse << ", " << fine;
      EXPECT_LE(fine, largest) << static_cast<int>(coupling) << " " << restitution;
    }
  }
}

// A damper, or a motor, that brakes within 1e-4 s to 1e-3 s is resolved by the shorter step only: errors of
// an impact that is a step late fall slowly until then.
TEST(StruckCouplings, ConvergeToTheEventDrivenMode) {
  expect_convergence(ImpactTimes::at_step_start, 0.1, 0.1);
  expect_convergence(ImpactTimes::located, 1.0, 5e-5);
}

TEST(StruckCouplings, NewtonsMethodIsTheSameStepWhereSweepsContract) {
  System system = struck_pair(Coupling::damper, 0.5);
  const TimeStepping plain{.step = 2e-4, .tolerance = 1e-14, .iteration = Iteration::fixed_point};
  for (const Iteration other : {Iteration::anderson, Iteration::linearly_implicit}) {
    TimeStepping named = plain;
    named.iteration = other;
    Simulation one(system, plain), two(system, named);
    for (int i = 0; i < 1500; ++i) {
      EXPECT_EQ(one.step().iteration, Iteration::fixed_point);
      EXPECT_EQ(two.step().iteration, other);
    }
    EXPECT_GE(one.statistics().impacts, 1);
    // 1e-14 m in each of 1,500 steps.
    EXPECT_LE(difference(one.state(), two.state()), 1e-10) << static_cast<int>(other);
  }
}

TEST(StruckCouplings, TheErrorNamesTheCouplingAlsoOfALaterComponent) {
  System system;
  system.set_default_law({.friction = 0.0, .normal_restitution = 0.5});
  add_disc(system, {0.8, 0.03}, {-1.0, 0.0});  // the first component has no couplings
  const BodyId a = add_disc(system, {0.0, 0.0}, {0.0, 0.0}), b = add_disc(system, {0.4, 0.0}, {0.0, 0.1});
  system.add(SpringDamper{.from = a, .to = b, .stiffness = 1.0, .damping = 1000.0, .free_length = 0.4},
             "damper");
  Simulation simulation(system, TimeStepping{.step = 2e-3, .iteration = Iteration::fixed_point});
  try {
    simulation.run_until(1.0);
    FAIL() << "sweeps that multiply errors by two have contracted";
  } catch (const SolverError& error) {
    ASSERT_FALSE(error.failure().parts.empty());
    EXPECT_NE(error.failure().parts.front().find("damper"), std::string::npos) << error.what();
    EXPECT_LE(error.failure().suggested_step, 1e-3);
    EXPECT_GT(error.failure().suggested_step, 1e-4);
  }
}

/// Runs for 0.8 s. Returns how many scenes end in an error; each names parts.
int count_failures(carom_test::SeedRange seeds, const TimeStepping& options, double decades = 8.0) {
  int failed = 0;
  for (std::uint64_t seed = seeds.first; seed < seeds.last; ++seed) {
    Simulation simulation(StruckCouplings(seed, decades).system(), options);
    try {
      simulation.run_until(0.8);
    } catch (const SolverError& error) {
      ++failed;
      EXPECT_FALSE(error.failure().parts.empty()) << seed << ": " << error.what();
    }
    // Each at its last good state. The work of stiff couplings is a sum of terms that are larger than what
    // the ledger sees of it: 20 times the rounding.
    EXPECT_LE(std::abs(simulation.energy().residual()),
              20.0 * carom_test::round_off * simulation.energy().scale())
        << seed;
  }
  return failed;
}

TEST(StruckCouplings, RandomScenesRun) {
  constexpr unsigned scenes = carom_test::count_of_samples(40U);
  EXPECT_LE(count_failures({1000, 1000 + scenes}, {.step = 2e-3}), carom_test::usual_or(1, 0));
}

// Couplings up to 1e4 N/m: before contact was within the linearised step 98 of 300 of these scenes failed at
// 2 ms. Of 1,500 none does, 3 under energy_momentum, 1 where impacts are located; one in a hundred is the
// aim.
TEST(StruckCouplingsLong, ScenesOfUsualStiffnessRun) {
  const carom_test::SeedRange seeds = carom_test::seeds_from(0, 400, 2000);
  const int most = seeds.count() / 100;
  for (const ForceRule rule : {ForceRule::trapezoidal, ForceRule::energy_momentum}) {
    EXPECT_LE(count_failures(seeds, {.step = 2e-3, .force_rule = rule}, 4.0), most);
  }
  EXPECT_LE(count_failures(seeds, {.step = 2e-3, .impacts = ImpactTimes::located}, 4.0), most);
}

// Up to 1e8 N/m: 60 % failed at 2 ms, 24 of 2,000 do, with joints and torsional springs most of them. Where
// impacts are located there are more contacts in a step.
TEST(StruckCouplingsLong, RandomScenesRun) {
  const carom_test::SeedRange seeds = carom_test::seeds_from(0, 400, 2000);
  const int most = 1 + seeds.count() / 25;
  for (const ForceRule rule : {ForceRule::trapezoidal, ForceRule::energy_momentum}) {
    for (const double step : {2e-3, 1e-3}) {
      EXPECT_LE(count_failures(seeds, {.step = step, .force_rule = rule}), most) << step;
    }
    EXPECT_LE(count_failures(seeds, {.step = 2e-3, .impacts = ImpactTimes::located, .force_rule = rule}),
              2 * most);
  }
}

}  // namespace
