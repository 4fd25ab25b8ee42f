// A model that runs: times, periodic events, edits, changes of state and mode.

#include "tests/energy/ledger_check.h"
#include "tests/integrators/pair_scene.h"
#include "tests/integrators/same_run.h"
#include "tests/integrators/throws.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <utility>
#include <variant>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::bits_of;
using carom_test::ledger_closes;
using carom_test::motion_bits;
using carom_test::pair_scene;

Simulation pair_run(double step = 1e-3) { return {pair_scene(), TimeStepping{.step = step}}; }

TEST(Simulation, StandsExactlyAtTheAskedTime) {
  Simulation simulation = pair_run();
  for (const double time : {0.3, 0.7123456789, 0.71234567891, 0.7124, 1.0}) {
    simulation.run_until(time);
    EXPECT_EQ(simulation.time(), time);
    EXPECT_EQ(simulation.state().time, time);
    EXPECT_EQ(simulation.report().time, time);
  }
  simulation.run_until(1.0);  // the present is no step
  EXPECT_EQ(simulation.time(), 1.0);
}

TEST(Simulation, MultiplesOfTheStepDoNotDrift) {
  // 0.1 is no double; steps are counted, not summed.
  System system;
  system.add(Particle{.mass = 1.0});
  Simulation simulation(std::move(system), TimeStepping{.step = 0.1});
  for (int i = 0; i < 1000; ++i) simulation.step();
  EXPECT_EQ(simulation.time(), 1000 * 0.1);
  Simulation until(simulation.system(), TimeStepping{.step = 0.1});
  until.run_until(100.0);
  EXPECT_EQ(until.statistics().steps, 1000);
}

TEST(Simulation, AskingForMultiplesOfTheStepChangesNothing) {
  Simulation at_once = pair_run(), in_parts = pair_run();
  at_once.run_until(1.0);
  for (int i = 1; i <= 10; ++i) in_parts.run_until(0.1 * i);
  EXPECT_EQ(bits_of(at_once), bits_of(in_parts));
}

TEST(Simulation, ShortenedStepsKeepOrderAndAccount) {
  // Times that are no multiples cut steps short; the run is another one, as good as before.
  Simulation simulation = pair_run(), reference = pair_run(1e-4);
  for (int i = 1; i <= 100; ++i) simulation.run_until(0.00537 * i);
  reference.run_until(0.537);
  EXPECT_EQ(simulation.time(), 0.00537 * 100);
  EXPECT_GT(simulation.statistics().steps, 537);
  EXPECT_TRUE(ledger_closes(simulation.energy()));
  EXPECT_EQ(simulation.statistics().impacts, reference.statistics().impacts);
}

TEST(Simulation, EveryFiresExactlyAtItsTimes) {
  for (const double interval : {0.01, 0.0033, 0.00041, 1.0 / 3.0}) {
    Simulation simulation = pair_run();
    std::vector<double> times;
    simulation.every(interval, [&](Simulation& now) { times.push_back(now.time()); });
    simulation.run_until(0.5);
    ASSERT_EQ(times.size(), static_cast<std::size_t>(0.5 / interval + 1e-9)) << interval;
    for (std::size_t k = 0; k < times.size(); ++k)
      EXPECT_EQ(times[k], static_cast<double>(k + 1) * interval) << interval;
    EXPECT_EQ(simulation.time(), 0.5);
    EXPECT_TRUE(ledger_closes(simulation.energy()));
  }
}

TEST(Simulation, EveryCountsFromNow) {
  Simulation simulation = pair_run();
  simulation.run_until(0.0305);
  std::vector<double> times;
  simulation.every(0.01, [&](Simulation& now) { times.push_back(now.time()); });
  simulation.run_until(0.06);
  ASSERT_EQ(times.size(), 2u);
  EXPECT_EQ(times[0], 0.0305 + 0.01);
  EXPECT_EQ(times[1], 0.0305 + 0.02);
}

TEST(Simulation, EveryMultipleOfTheStepChangesNothing) {
  Simulation with = pair_run(), without = pair_run();
  int fired = 0;
  with.every(0.007, [&](Simulation&) { ++fired; });
  with.every(0.01, [&](Simulation&) { ++fired; });
  with.run_until(1.0);
  without.run_until(1.0);
  EXPECT_EQ(fired, 142 + 100);
  EXPECT_EQ(bits_of(with), bits_of(without));
}

TEST(Simulation, ActionsMayChangeTheStateAndAddFurtherOnes) {
  Simulation simulation = pair_run();
  const BodyId lower = simulation.system().body("lower");
  int later = 0;
  bool once = false;
  simulation.every(0.1, [&](Simulation& now) {
    State state = now.state();
    state.velocity(lower)[0] += 1.0;
    now.set_state(state);
    if (!once) now.every(0.02, [&later](Simulation&) { ++later; });
    once = true;
  });
  simulation.run_until(0.305);
  EXPECT_EQ(later, 10);
  EXPECT_TRUE(ledger_closes(simulation.energy()));
  EXPECT_NE(simulation.energy().flow(EnergyFlow::intervention), 0.0);
}

TEST(Simulation, ObserversSeeEveryStepAndCannotStep) {
  Simulation simulation = pair_run();
  std::vector<double> times;
  simulation.observe([&](const Simulation& now) { times.push_back(now.time()); });
  bool refused = false;
  simulation.observe([&](const Simulation&) {
    try {
      simulation.step();
    } catch (const ModelError&) {
      refused = true;
    }
  });
  simulation.run_until(0.0105);
  ASSERT_EQ(times.size(), 11u);
  EXPECT_EQ(times[0], 0.001);
  EXPECT_EQ(times[10], 0.0105);
  EXPECT_TRUE(refused);
  simulation.step();  // from outside it goes on
}

TEST(Simulation, AnObserverThatThrowsLeavesAnAcceptedStep) {
  Simulation simulation = pair_run();
  bool armed = true;
  simulation.observe([&](const Simulation& now) {
    if (armed && now.time() > 0.0045) throw std::runtime_error("observer");
  });
  EXPECT_THROWS(std::runtime_error, simulation.run_until(1.0), "observer");
  EXPECT_EQ(simulation.time(), 0.005);
  armed = false;
  simulation.run_until(0.5);
  Simulation plain = pair_run();
  plain.run_until(0.5);
  EXPECT_EQ(bits_of(simulation), bits_of(plain));
}

TEST(Simulation, EditMapsTheStateByIdentity) {
  Simulation simulation = pair_run();
  simulation.run_until(0.4);
  const State before = simulation.state();
  const Statistics statistics = simulation.statistics();
  const double total = simulation.energy().total();
  const BodyId lower = simulation.system().body("lower"), upper = simulation.system().body("upper");
  BodyId added{};
  simulation.edit([&](System& system) {
    // A body of another kind in front, a component joined, a spring gone: every place changes.
    system.remove(system.element("spring"));
    added = system.add(RigidBody{
        .mass = disc(3.0, 0.2), .position = {5.0, 6.0}, .angle = 0.5, .velocity = {1.0, 2.0}, .spin = 3.0});
    system.add(SpringDamper{.from = added, .to = upper, .stiffness = 10.0, .free_length = 1.0});
  });
  for (const BodyId body : {lower, upper}) {
    EXPECT_EQ(simulation.state().position(body), before.position(body));
    EXPECT_EQ(simulation.state().velocity(body), before.velocity(body));
  }
  EXPECT_EQ(simulation.state().angle(added), 0.5);
  EXPECT_EQ(simulation.state().spin(added), 3.0);
  EXPECT_EQ(simulation.time(), 0.4);
  EXPECT_EQ(simulation.statistics().steps, statistics.steps);
  // Energy brought in: that of the new body and spring less that of the old spring.
  EXPECT_NEAR(simulation.energy().flow(EnergyFlow::intervention), simulation.energy().total() - total,
              1e-15 * simulation.energy().scale());
  EXPECT_TRUE(ledger_closes(simulation.energy()));
  simulation.run_until(1.0);
  EXPECT_TRUE(ledger_closes(simulation.energy()));
  // A removed body takes its state with it.
  simulation.edit([&](System& system) {
    for (const ElementId element : system.elements()) {
      if (system.name(element).starts_with("spring")) system.remove(element);
    }
    system.remove(lower);
  });
  EXPECT_THROWS(ModelError, simulation.state().position(lower), "");
  EXPECT_TRUE(ledger_closes(simulation.energy()));
}

TEST(Simulation, AnEditThatChangesNothingDoesNotChangeTheRun) {
  Simulation edited = pair_run(), plain = pair_run();
  edited.run_until(0.5);
  plain.run_until(0.5);
  edited.edit([](System&) {});
  EXPECT_EQ(motion_bits(edited.state()), motion_bits(plain.state()));
  EXPECT_EQ(edited.energy().flow(EnergyFlow::intervention), 0.0);
  edited.run_until(1.0);
  plain.run_until(1.0);
  // Compensation of rounding before the edit is forgotten; nothing else.
  for (std::size_t i = 0; i < plain.state().q.size(); ++i)
    EXPECT_NEAR(edited.state().q[i], plain.state().q[i], 1e-11);
}

TEST(Simulation, AFailedEditChangesNothing) {
  Simulation simulation = pair_run();
  simulation.every(0.25, [](Simulation&) {});
  simulation.run_until(0.4);
  const auto before = bits_of(simulation);
  const std::uint64_t print = simulation.system().fingerprint();
  const auto expect_same = [&] {
    EXPECT_EQ(bits_of(simulation), before);
    EXPECT_EQ(simulation.system().fingerprint(), print);
  };
  EXPECT_THROWS(std::runtime_error, simulation.edit([](System& system) {
    system.remove(system.element("spring"));
    throw std::runtime_error("changed my mind");
  }),
                "changed my mind");
  expect_same();
  EXPECT_THROWS(ModelError, simulation.edit([](System& system) {
    system.add(Particle{.mass = 1.0});
    system.add(Particle{.mass = -1.0}, "wrong");
  }),
                "particle 'wrong'", "mass", "-1");
  expect_same();
  // A model that is refused only when it is put together: a joint that is drawn open.
  EXPECT_THROWS(ModelError, simulation.edit([](System& system) {
    system.add(Rod{.from = {ground, {0.0, 1e3}}, .to = system.bodies().front(), .length = 1.0}, "far");
  }),
                "rod 'far'", "from where it closes");
  expect_same();
  Simulation plain = pair_run();
  plain.every(0.25, [](Simulation&) {});
  plain.run_until(1.0);
  simulation.run_until(1.0);
  EXPECT_EQ(bits_of(simulation), bits_of(plain));
}

TEST(Simulation, SetStateBooksTheIntervention) {
  Simulation simulation = pair_run();
  simulation.run_until(0.3);
  State state = simulation.state();
  const BodyId lower = simulation.system().body("lower");
  const Vec<2> velocity = state.velocity(lower);
  state.velocity(lower) *= 2.0;
  simulation.set_state(state);
  EXPECT_EQ(simulation.state().v, state.v);
  EXPECT_NEAR(simulation.energy().flow(EnergyFlow::intervention), 1.5 * velocity.squaredNorm(),
              1e-13 * simulation.energy().scale());
  EXPECT_TRUE(ledger_closes(simulation.energy()));
  simulation.run_until(1.0);
  EXPECT_TRUE(ledger_closes(simulation.energy()));
}

TEST(Simulation, SetStateMayMoveInTime) {
  Simulation simulation = pair_run();
  std::vector<double> times;
  simulation.every(0.1, [&](Simulation& now) { times.push_back(now.time()); });
  const State start = simulation.state();
  simulation.run_until(0.35);
  simulation.set_state(start);
  EXPECT_EQ(simulation.time(), 0.0);
  simulation.run_until(0.25);
  // The rhythm goes on: 0.1, 0.2, 0.3, then again 0.1, 0.2.
  ASSERT_EQ(times.size(), 5u);
  EXPECT_EQ(times[3], 0.1);
  EXPECT_EQ(times[4], 0.2);
  Simulation plain = pair_run();
  plain.run_until(0.25);
  EXPECT_EQ(motion_bits(simulation.state()), motion_bits(plain.state()));
}

TEST(Simulation, SwitchesToOtherOptions) {
  Simulation simulation = pair_run(1e-3);
  simulation.run_until(0.2);
  const auto motion = motion_bits(simulation.state());
  simulation.switch_to(TimeStepping{.step = 2.5e-4});
  EXPECT_EQ(motion_bits(simulation.state()), motion);
  EXPECT_EQ(std::get<TimeStepping>(simulation.mode()).step, 2.5e-4);
  simulation.step();
  EXPECT_EQ(simulation.time(), 0.2 + 2.5e-4);
  EXPECT_EQ(simulation.report().step, 2.5e-4);
  EXPECT_TRUE(ledger_closes(simulation.energy()));
  // Options that cannot be are refused and change nothing.
  EXPECT_THROWS(ModelError, simulation.switch_to(TimeStepping{.step = -1.0}), "step", "-1");
  EXPECT_EQ(std::get<TimeStepping>(simulation.mode()).step, 2.5e-4);
  simulation.step();
}

TEST(Simulation, StatisticsAddUp) {
  Simulation simulation = pair_run();
  std::int64_t steps = 0, sweeps = 0, impacts = 0, contact_steps = 0;
  int most = 0;
  double deepest = 0.0, contraction = 0.0, residual = 0.0;
  simulation.observe([&](const Simulation& now) {
    const StepReport& report = now.report();
    ++steps;
    sweeps += report.sweeps;
    most = std::max(most, report.sweeps);
    contraction = std::max(contraction, report.contraction);
    for (const ContactRecord& contact : report.contacts) {
      ++contact_steps;
      impacts += contact.impact ? 1 : 0;
      deepest = std::min(deepest, contact.gap);
      residual = std::max(residual, contact.residual);
    }
  });
  simulation.run_until(2.0);
  const Statistics& statistics = simulation.statistics();
  EXPECT_EQ(statistics.steps, steps);
  EXPECT_EQ(steps, 2000);
  EXPECT_EQ(statistics.sweeps, sweeps);
  EXPECT_EQ(statistics.most_sweeps, most);
  EXPECT_EQ(statistics.largest_contraction, contraction);
  EXPECT_EQ(statistics.impacts, impacts);
  EXPECT_GT(impacts, 0);
  EXPECT_EQ(statistics.contact_steps, contact_steps);
  EXPECT_EQ(statistics.deepest_gap, deepest);
  EXPECT_EQ(statistics.worst_residual, residual);
}

TEST(Simulation, CopiesItsModel) {
  System system = pair_scene();
  Simulation simulation(system, TimeStepping{});
  system.remove(system.element("spring"));
  EXPECT_EQ(simulation.system().elements().size(), 2u);
  Simulation moved = std::move(simulation);
  moved.run_until(0.1);
  EXPECT_EQ(moved.time(), 0.1);
}

}  // namespace
