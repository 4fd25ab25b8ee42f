#include "examples/scenes/incline.h"
#include "tests/integrators/same_run.h"
#include "tests/integrators/throws.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace {

using namespace carom;

/// The pair, dropped from a height that lets it strike the plane after 0.3 s.
System scene() {
  System system;
  const scenes::Incline incline{.height = 1.5};
  scenes::add_plane(system, incline);
  scenes::add_pair(system, incline);
  return system;
}

TEST(EnergyRecorder, RecordsTheLedgerAtEveryStep) {
  Simulation simulation(scene(), TimeStepping{.step = 1e-3});
  const EnergyRecorder recorder(simulation);
  std::vector<EnergyLedger> ledgers{simulation.energy()};
  std::vector<double> times{0.0};
  simulation.observe([&](const Simulation& now) {
    ledgers.push_back(now.energy());
    times.push_back(now.time());
  });
  simulation.run_until(0.5);
  const auto& rows = recorder.trace().rows();
  ASSERT_EQ(rows.size(), ledgers.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i].time, times[i]);
    EXPECT_EQ(rows[i].stored.values, ledgers[i].stored().values);
    EXPECT_EQ(rows[i].total, ledgers[i].total());
    EXPECT_EQ(rows[i].initial, ledgers[i].initial());
    for (std::size_t k = 0; k < energy_flow_count; ++k) {
      EXPECT_EQ(rows[i].flows.values[k], ledgers[i].flow(static_cast<EnergyFlow>(k)));
    }
    EXPECT_EQ(rows[i].residual, ledgers[i].residual());
    EXPECT_EQ(rows[i].energy_scale, ledgers[i].scale());
  }
}

TEST(EnergyRecorder, RecordsMomentaWithTheirScales) {
  Simulation simulation(scene(), TimeStepping{.step = 1e-3});
  const EnergyRecorder recorder(simulation);
  simulation.run_until(0.1);
  const auto& rows = recorder.trace().rows();
  // Free fall: p = m (v_x, -g t), about the origin L' = -x m g with x = v_x t, so L = -20 h - 10 m g t^2/2.
  constexpr double mass = 2.0 * scenes::pair_mass, weight = mass * scenes::gravity;
  for (const TraceRow& row : rows) {
    EXPECT_NEAR(row.momentum[0], mass * 10.0, 1e-12);
    EXPECT_NEAR(row.momentum[1], -weight * row.time, 1e-12);
    EXPECT_EQ(row.momentum[2], 0.0);
    EXPECT_NEAR(row.angular_momentum[2], -mass * 10.0 * 1.5 - 0.5 * 10.0 * weight * row.time * row.time,
                1e-11);
    EXPECT_NEAR(row.momentum_scale, 10.0, 1e-12);          // of one particle
    EXPECT_NEAR(row.angular_momentum_scale, 25.0, 1e-12);  // of the upper one, at 2.5 m
    EXPECT_EQ(row.length_scale, 2.5);
  }
}

TEST(EnergyRecorder, RecordsImpactsAsEvents) {
  Simulation simulation(scene(), TimeStepping{.step = 1e-3});
  const EnergyRecorder recorder(simulation, {.every_steps = 100});
  std::vector<TraceEvent> seen;
  simulation.observe([&](const Simulation& now) {
    for (const ContactRecord& contact : now.report().contacts) {
      if (contact.impact) {
        seen.push_back({now.time(), now.name(contact.key) + ", " + std::string(to_string(contact.mode))});
      }
    }
  });
  simulation.run_until(0.5);
  const auto& events = recorder.trace().events();
  ASSERT_GE(events.size(), 1u);
  ASSERT_EQ(events.size(), seen.size());
  for (std::size_t i = 0; i < events.size(); ++i) {
    EXPECT_EQ(events[i].time, seen[i].time);
    EXPECT_EQ(events[i].text, seen[i].text);
  }
  EXPECT_EQ(events[0].text, "particle 'lower' on half-plane 'plane', slip+");
}

TEST(EnergyRecorder, PenetrationCountsBodiesInEachOther) {
  // Two discs, 1.5 steps apart, meet at 2 m/s: at the end of the second step they are half a step deep, which
  // the row of that state must know although no step has begun there.
  constexpr double h = 1e-3, v = 1.0, radius = 0.1;
  System system;
  const MaterialId rubber = system.material("rubber");
  system.between(rubber, rubber, Surface{.friction = 0.0, .normal_restitution = 0.5});
  for (const double side : {-1.0, 1.0}) {
    const BodyId body = system.add(planar::RigidBody{.mass = planar::disc(1.0, radius),
                                                     .position = {side * (radius + 1.5 * h * v), 0.0},
                                                     .velocity = {-side * v, 0.0}});
    system.add(planar::Disc{.body = body, .radius = radius, .material = rubber});
  }
  Simulation simulation(system, TimeStepping{.step = h});
  const EnergyRecorder every(simulation);
  simulation.run_until(2.0 * h);
  const std::vector<double> depth = every.trace().values("penetration");
  ASSERT_EQ(depth.size(), 3U);
  EXPECT_EQ(depth[1], 0.0);
  EXPECT_NEAR(depth[2], h * v, 1e-15);  // rounding of the coordinates
}

TEST(EnergyRecorder, PenetrationIsTheDeepestSinceTheRowBefore) {
  // A ball falls at 3 m/s, without gravity, from 10.4 steps above the floor: in the 11th step it goes 0.6
  // steps deep, in the 12th the impact turns it: at (1 - e)/2 less speed it goes on to its deepest.
  constexpr double h = 1e-3, v = 3.0, e = 0.5;
  System system;
  system.add(planar::HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.0, .normal_restitution = e});
  const BodyId ball =
      system.add(planar::Particle{.mass = 1.0, .position = {0.0, 10.4 * h * v}, .velocity = {0.0, -v}});
  Simulation simulation(system, TimeStepping{.step = h});
  const EnergyRecorder every(simulation);
  const EnergyRecorder tens(simulation, {.every_steps = 10});
  std::vector<double> depth{0.0};
  simulation.observe(
      [&](const Simulation& now) { depth.push_back(std::max(0.0, -now.state().position(ball)[1])); });
  simulation.run_until(20.5 * h);
  const auto& rows = every.trace().rows();
  ASSERT_EQ(rows.size(), depth.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    // A row also knows the step that began where the row before stands.
    EXPECT_EQ(rows[i].penetration, std::max(depth[i], i == 0 ? 0.0 : depth[i - 1])) << i;
    EXPECT_EQ(rows[i].joint_error, 0.0);
  }
  const double deepest = *std::max_element(depth.begin(), depth.end());
  EXPECT_NEAR(deepest, (0.6 + 0.5 * (1.0 - e)) * h * v, 1e-12);
  EXPECT_EQ(tens.trace().values("penetration"), (std::vector{0.0, 0.0, deepest}));
}

TEST(EnergyRecorder, StepsOrIntervals) {
  const auto times = [](const EnergyRecorder::Options& options) {
    Simulation simulation(scene(), TimeStepping{.step = 1e-2});
    simulation.run_until(0.1);
    const EnergyRecorder recorder(simulation, options);
    simulation.run_until(0.2);
    return recorder.trace().values("time");
  };
  EXPECT_EQ(times({}).size(), 11u);
  EXPECT_EQ(times({.every_steps = 4}), (std::vector{0.1, 0.14, 0.18}));
  const auto at = times({.interval = 0.025});
  ASSERT_EQ(at.size(), 5u);
  for (std::size_t i = 0; i < at.size(); ++i) {
    EXPECT_EQ(at[i], i == 4 ? 0.2 : 0.1 + 0.025 * static_cast<double>(i));
  }
}

TEST(EnergyRecorder, ChangesNothingOfTheRun) {
  Simulation plain(scene(), TimeStepping{.step = 1e-3}), recorded(scene(), TimeStepping{.step = 1e-3});
  const EnergyRecorder recorder(recorded, {.every_steps = 7});
  plain.run_until(0.5);
  recorded.run_until(0.5);
  EXPECT_EQ(carom_test::bits_of(plain), carom_test::bits_of(recorded));
  // Nor does an interval of whole steps, but that it is a periodic event of the run.
  Simulation by_interval(scene(), TimeStepping{.step = 1e-3});
  const EnergyRecorder regular(by_interval, {.interval = 0.01});
  by_interval.run_until(0.5);
  EXPECT_EQ(carom_test::bits_of(plain), carom_test::bits_of(by_interval));
  EXPECT_EQ(regular.trace().rows().size(), 51u);
}

TEST(EnergyRecorder, SameRunSameTrace) {
  const auto run = [] {
    Simulation simulation(scene(), TimeStepping{.step = 1e-3});
    const EnergyRecorder recorder(simulation, {.interval = 0.05});
    simulation.run_until(0.5);
    return recorder.trace();
  };
  EXPECT_TRUE(compare(run(), run(), {}).agree());
}

TEST(EnergyRecorder, KnowsOfInterventions) {
  Simulation simulation(scene(), TimeStepping{.step = 1e-2});
  simulation.every(0.05, [](Simulation& run) {
    State state = run.state();
    for (double& v : state.v) v *= 1.1;
    run.set_state(state);
  });
  const EnergyRecorder recorder(simulation, {.interval = 0.05});
  simulation.run_until(0.1);
  EXPECT_GT(recorder.trace().values("intervention").back(), 1.0);
  EXPECT_LE(std::abs(recorder.trace().values("residual").back()), 1e-10);
}

TEST(EnergyRecorder, RecordsAsLongAsTheSimulationRunsWhereverItMoves) {
  Simulation simulation(scene(), TimeStepping{.step = 1e-2});
  const EnergyRecorder recorder(simulation);
  {
    Simulation moved = std::move(simulation);
    moved.run_until(0.1);
  }
  EXPECT_EQ(recorder.trace().rows().size(), 11u);
}

TEST(EnergyRecorder, RecordsAtListedTimes) {
  Simulation simulation(scene(), TimeStepping{.step = 1e-2});
  const std::vector<double> times{0.013, 0.2, 0.41};
  const EnergyTrace trace = record_at(simulation, times);
  EXPECT_EQ(trace.values("time"), (std::vector{0.0, 0.013, 0.2, 0.41}));
  EXPECT_GE(trace.events().size(), 1u);
  EXPECT_EQ(static_cast<std::int64_t>(trace.events().size()), simulation.statistics().impacts);
  EXPECT_EQ(simulation.time(), 0.41);
  simulation.run_until(0.6);  // with nobody to record any more
}

TEST(EnergyRecorder, RefusesWhatCannotBe) {
  Simulation simulation(scene(), TimeStepping{.step = 1e-2});
  EXPECT_THROWS(ModelError, EnergyRecorder(simulation, {.every_steps = -1}), "every_steps is -1",
                "at least 1");
  EXPECT_THROWS(ModelError, EnergyRecorder(simulation, {.interval = -0.5}), "interval is -0.5 s", "> 0");
  EXPECT_THROWS(ModelError, EnergyRecorder(simulation, {.interval = std::nan("")}), "interval is nan s");
  EXPECT_THROWS(ModelError, EnergyRecorder(simulation, {.every_steps = 2, .interval = 0.5}),
                "one of the two");
  EXPECT_THROWS(ModelError, record_at(simulation, {0.1, 0.1}), "time is 0.1 s", "later than 0.1 s");
  EXPECT_THROWS(ModelError, record_at(simulation, {-1.0}), "time is -1 s", "later than 0 s");
  EXPECT_THROWS(ModelError, record_at(simulation, {std::nan("")}), "time is nan s");
  EXPECT_EQ(simulation.time(), 0.0);
}

TEST(EnergyRecorder, DoesNotGoBackInTime) {
  Simulation simulation(scene(), TimeStepping{.step = 1e-2});
  const EnergyRecorder recorder(simulation);
  const State start = simulation.state();
  simulation.run_until(0.05);
  simulation.set_state(start);
  EXPECT_THROWS(ModelError, simulation.step(), "time is 0.01 s", "later than the row before");
}

}  // namespace
