// Steps of few bodies that nothing couples take a short path: with the same bits, reports and errors as any
// other step.

#include <carom/carom.h>
#include <carom/core/workers.h>
#include <carom/integrators/run/companion.h>
#include <carom/integrators/time_stepping/uncoupled_step.h>

#include "tests/allocation_counter.h"
#include "tests/round_hill.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <tuple>

namespace {

using namespace carom;
using namespace carom::planar;

enum class Path { short_one, usual };

/// Two discs, a bar and a particle in flight over a floor, on which a disc, the bar and the particle fall.
/// Steps take the usual path where ground moves, though far below.
System scene(Path path, double gravity = 9.81, double rolling_resistance = 0.0) {
  System system;
  const Surface surface{.friction = 0.3,
                        .normal_restitution = 0.5,
                        .tangential_restitution = 0.2,
                        .rolling_resistance = rolling_resistance};
  system.add(Gravity{{0.3, -gravity}});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, surface);
  for (const double height : {0.12, 50.0}) {
    const BodyId body = system.add(RigidBody{
        .mass = disc(2.0, 0.1), .position = {3.0 * height, height}, .velocity = {1.0, 0.5}, .spin = 7.0});
    system.add(Disc{.body = body, .radius = 0.1});
  }
  const BodyId bar =
      system.add(RigidBody{.mass = box(1.5, 0.3, 0.02), .position = {2.0, 0.3}, .angle = 0.4, .spin = -3.0});
  system.add(Segment{.body = bar, .from = {-0.15, 0.01}, .to = {0.15, 0.0}});
  system.add(Particle{.mass = 0.7, .position = {-1.0, 0.05}, .velocity = {0.2, 0.0}});
  if (path == Path::usual) {
    const auto still = [](double) { return 0.0; };
    system.add(
        HalfPlane{.point = {0.0, -1e3}, .normal = {0.0, 1.0}, .motion = {.angle = still, .spin = still}},
        surface);
  }
  return system;
}

bool fits(const System& system, const TimeStepping& mode) {
  const Assembly assembly(system);
  const Detector detector(assembly);
  const StepModel model(assembly, mode, detector);
  return UncoupledStep::fits(model);
}

TEST(UncoupledStep, FitsFewUncoupledBodiesUnderConstantLoads) {
  EXPECT_TRUE(fits(scene(Path::short_one), {.step = 1e-3}));
  EXPECT_FALSE(fits(scene(Path::usual), {.step = 1e-3}));
  EXPECT_FALSE(fits(scene(Path::short_one), {.step = 1e-3, .force_rule = ForceRule::energy_momentum}));
  System coupled = scene(Path::short_one);
  coupled.add(SpringDamper{.from = {ground}, .to = {coupled.bodies().back()}, .stiffness = 1.0});
  EXPECT_FALSE(fits(coupled, {.step = 1e-3}));
}

// A circle around a body says nothing of ground that is not flat: what is called a distance may grow faster
// than one.
TEST(UncoupledStep, FitsBodiesBesideTheirCentresOverFlatGroundAlone) {
  System system;
  const Surface surface{.friction = 0.3, .normal_restitution = 0.5};
  system.add(HalfPlane{.normal = {0.0, 1.0}}, surface);
  const BodyId body = system.add(RigidBody{.mass = disc(1.0, 0.1), .position = {0.0, 2.0}});
  system.add(Disc{.body = body, .radius = 0.05, .centre = {0.1, 0.0}});
  EXPECT_TRUE(fits(system, {.step = 1e-3}));
  system.add(carom_test::RoundHill{.centre = {0.0, -5.0}}, surface);
  EXPECT_FALSE(fits(system, {.step = 1e-3}));
}

void expect_same(const ContactRecord& a, const ContactRecord& b) {
  EXPECT_EQ(a.key, b.key);
  EXPECT_EQ(a.body.serial, b.body.serial);
  EXPECT_EQ(a.obstacle.serial, b.obstacle.serial);
  EXPECT_EQ(a.other.valid(), b.other.valid());
  EXPECT_EQ(a.directions, b.directions);
  EXPECT_EQ(a.point, b.point);
  EXPECT_EQ(a.normal, b.normal);
  EXPECT_EQ(a.gap, b.gap);
  EXPECT_EQ(a.energy_gain, b.energy_gain);
  EXPECT_EQ(a.contact_work, b.contact_work);
  EXPECT_EQ(a.restitution_factor, b.restitution_factor);
  EXPECT_EQ(a.cut_sequence, b.cut_sequence);
  EXPECT_EQ(a.rolling_moment, b.rolling_moment);
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.velocity_before, b.velocity_before);
  EXPECT_EQ(a.velocity_after, b.velocity_after);
  EXPECT_EQ(a.impulse, b.impulse);
  EXPECT_EQ(a.work, b.work);
  EXPECT_EQ(a.mode, b.mode);
  EXPECT_EQ(a.impact, b.impact);
  EXPECT_EQ(a.worst, b.worst);
  EXPECT_EQ(a.outcome, b.outcome);
  EXPECT_EQ(a.residual, b.residual);
  EXPECT_EQ(a.solver, b.solver);
}

void expect_same(const StepReport& a, const StepReport& b) {
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.step, b.step);
  EXPECT_EQ(a.sweeps, b.sweeps);
  EXPECT_EQ(a.iteration, b.iteration);
  EXPECT_EQ(a.fallbacks, b.fallbacks);
  EXPECT_EQ(a.contraction, b.contraction);
  EXPECT_EQ(a.energy_gain, b.energy_gain);
  EXPECT_EQ(a.projected, b.projected);
  EXPECT_EQ(a.worst_coupling, b.worst_coupling);
  ASSERT_EQ(a.contacts.size(), b.contacts.size());
  for (std::size_t i = 0; i < a.contacts.size(); ++i) expect_same(a.contacts[i], b.contacts[i]);
  EXPECT_EQ(a.joint_impulses.size(), b.joint_impulses.size());
  EXPECT_EQ(a.findings.size(), b.findings.size());
  EXPECT_EQ(a.capped_problem, b.capped_problem);
}

void expect_same(const Statistics& a, const Statistics& b) {
  EXPECT_EQ(a.steps, b.steps);
  EXPECT_EQ(a.sweeps, b.sweeps);
  EXPECT_EQ(a.most_sweeps, b.most_sweeps);
  EXPECT_EQ(a.steps_by_iteration, b.steps_by_iteration);
  EXPECT_EQ(a.fallbacks, b.fallbacks);
  EXPECT_EQ(a.contact_steps, b.contact_steps);
  EXPECT_EQ(a.impacts, b.impacts);
}

class UncoupledStepBits : public testing::TestWithParam<std::tuple<Iteration, ImpactTimes>> {};

TEST_P(UncoupledStepBits, AreThoseOfTheUsualPath) {
  const auto [iteration, impacts] = GetParam();
  const TimeStepping mode{.step = 1e-3, .impacts = impacts, .iteration = iteration};
  Simulation a(scene(Path::short_one), mode), b(scene(Path::usual), mode);
  int free = 0, touching = 0;
  // Falls of some 0.1 s, impacts, flights between them, in the end lasting contact.
  for (int i = 0; i < 600 && !HasFailure(); ++i) {
    // Once per flight cut short, as by periodic events.
    const auto advance = [i](Simulation& simulation) {
      if (i % 50 == 7) simulation.run_until(simulation.time() + 0.4e-3);
      return simulation.step();
    };
    const StepReport of_a = advance(a), of_b = advance(b);
    expect_same(of_a, of_b);
    expect_same(a.statistics(), b.statistics());
    EXPECT_EQ(a.state().q, b.state().q);
    EXPECT_EQ(a.state().v, b.state().v);
    EXPECT_EQ(a.state().time, b.state().time);
    EXPECT_EQ(a.energy().save(), b.energy().save());
    EXPECT_EQ(a.companion().rounding, b.companion().rounding);
    EXPECT_EQ(a.companion().history.step, b.companion().history.step);
    EXPECT_EQ(a.companion().modes.size(), b.companion().modes.size());
    ++(of_a.contacts.empty() ? free : touching);
  }
  EXPECT_GT(free, 50);
  EXPECT_GT(touching, 50);
}

INSTANTIATE_TEST_SUITE_P(Iterations, UncoupledStepBits,
                         testing::Combine(testing::Values(Iteration::automatic, Iteration::fixed_point,
                                                          Iteration::anderson),
                                          testing::Values(ImpactTimes::at_step_start, ImpactTimes::located)));

// Of many bodies those that stand far from all others that touch are taken in large pieces. 700 are more than
// the short path takes.
class UncoupledSteps : public testing::TestWithParam<std::tuple<int, ImpactTimes, int>> {};

TEST_P(UncoupledSteps, OfManyBodiesSomeTouchInSomePieces) {
  const int bodies = std::get<0>(GetParam()), threads = std::get<2>(GetParam());
  const ImpactTimes impacts = std::get<1>(GetParam());
  if (threads > 1 && !Workers::several_available()) GTEST_SKIP() << "the library was built without threads";
  const auto many = [&](Path path) {
    System system = scene(path);
    for (int i = 0; i < bodies; ++i) {
      const bool falls = i % 70 == 5;
      const BodyId body = system.add(RigidBody{.mass = disc(2.0, 0.1),
                                               .position = {0.3 * i, falls ? 0.1 + 1e-4 * i : 50.0},
                                               .velocity = {1.0, 0.5},
                                               .spin = 0.1 * i});
      system.add(Disc{.body = body, .radius = 0.1});
    }
    return system;
  };
  const TimeStepping mode{.step = 1e-3, .impacts = impacts};
  TimeStepping shared_out = mode;
  shared_out.threads = threads;
  Simulation a(many(Path::short_one), shared_out), b(many(Path::usual), mode);
  std::size_t contacts = 0;
  for (int i = 0; i < 500 && !HasFailure(); ++i) {
    const StepReport &of_a = a.step(), &of_b = b.step();
    expect_same(of_a, of_b);
    expect_same(a.statistics(), b.statistics());
    EXPECT_EQ(a.state().q, b.state().q);
    EXPECT_EQ(a.state().v, b.state().v);
    EXPECT_EQ(a.energy().save(), b.energy().save());
    contacts += of_a.contacts.size();
  }
  EXPECT_GT(contacts, 100U);
}

INSTANTIATE_TEST_SUITE_P(Sizes, UncoupledSteps,
                         testing::Combine(testing::Values(100, 700, 1300),
                                          testing::Values(ImpactTimes::at_step_start, ImpactTimes::located),
                                          testing::Values(1, 2)));

// Records stand where those of other contacts stood in the step before: nothing of these is left in them.
// Runs that begin with the step have no step before.
TEST(UncoupledStep, RecordsHaveNothingOfTheStepBefore) {
  const std::string file = testing::TempDir() + "carom_records";
  const TimeStepping mode{.step = 1e-3};
  const System system = scene(Path::short_one, 9.81, 0.01);
  Simulation run(system, mode);
  int of_others = 0, rolled = 0;
  ConstraintKey before;
  for (int i = 0; i < 400 && !HasFailure(); ++i) {
    Simulation anew(system, mode);
    run.save(file);
    anew.load(file);
    const StepReport& report = run.step();
    expect_same(report, anew.step());
    if (report.contacts.empty()) continue;
    of_others += report.contacts.front().key != before ? 1 : 0;
    rolled += report.contacts.front().rolling_moment != 0.0 ? 1 : 0;
    before = report.contacts.front().key;
  }
  EXPECT_GT(of_others, 3);
  EXPECT_GT(rolled, 3);
}

TEST(UncoupledStep, AnEnergyThatIsNotFiniteIsTheErrorOfAnyStep) {
  const auto failure = [](Path path) -> std::string {
    // Upwards: nothing touches. The square of g h overflows.
    Simulation simulation(scene(path, -1e150), TimeStepping{.step = 1e6});
    const State start = simulation.state();
    try {
      simulation.step();
    } catch (const SolverError& error) {
      EXPECT_EQ(simulation.statistics().steps, 0);
      EXPECT_EQ(simulation.state().q, start.q);
      EXPECT_EQ(simulation.state().time, 0.0);
      return error.what();
    }
    return {};
  };
  EXPECT_NE(failure(Path::short_one), "");
  EXPECT_EQ(failure(Path::short_one), failure(Path::usual));
}

TEST(UncoupledStep, StepsAllocateNothing) {
  Simulation simulation(scene(Path::short_one), TimeStepping{.step = 1e-4});
  simulation.step();
  const std::int64_t before = carom_test::allocations();
  for (int i = 0; i < 100; ++i) simulation.step();
  EXPECT_EQ(carom_test::allocations(), before);
}

TEST(UncoupledStep, StepsWithLocatedImpactsAllocateNothingOnceAllHaveBeenHit) {
  Simulation simulation(scene(Path::short_one), TimeStepping{.step = 1e-3, .impacts = ImpactTimes::located});
  simulation.run_until(3.0);  // even the bar rests
  const std::int64_t before = carom_test::allocations();
  std::size_t contacts = 0;
  for (int i = 0; i < 200; ++i) contacts += simulation.step().contacts.size();
  EXPECT_EQ(carom_test::allocations(), before);
  EXPECT_GT(contacts, 100U);
}

}  // namespace
