// Files that a failed step leaves behind, and counts of the contact solvers on the way.

#include "examples/scenes/discs.h"
#include "tests/integrators/throws.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

/// A particle between two walls with unequal restitution, both violated: no impulses exist.
System jammed() {
  System system;
  const auto wall = [](double e) {
    return Surface{.friction = 0.0, .normal_restitution = e, .tangential_restitution = 0.0};
  };
  system.add(HalfPlane{.point = {0, 0.1}, .normal = {0, 1}}, wall(0.2), "low");
  system.add(HalfPlane{.point = {0, -0.1}, .normal = {0, -1}}, wall(0.9), "high");
  system.add(Particle{.mass = 2.0, .velocity = {0, 1}}, "dot");
  return system;
}

class FailureFile : public testing::Test {
protected:
  FailureFile() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    directory_ = std::filesystem::path(testing::TempDir()) / (std::string("carom_failures_") + info->name());
    std::filesystem::remove_all(directory_);
    std::filesystem::create_directory(directory_);
  }
  ~FailureFile() override { std::filesystem::remove_all(directory_); }
  void SetUp() override {
    if (!problem_files_available()) GTEST_SKIP() << "built without JSON";
  }
  [[nodiscard]] std::size_t files() const {
    const std::filesystem::directory_iterator begin(directory_);
    return static_cast<std::size_t>(std::distance(begin, std::filesystem::directory_iterator()));
  }

  std::filesystem::path directory_;
};

TEST_F(FailureFile, IsWrittenWhereADirectoryWasSet) {
  Simulation simulation(jammed(), TimeStepping{.impact_rules = {.refuse_jams = true},
                                               .failure_directory = directory_.string()});
  const std::string first = (directory_ / "contact_problem_t0.json").string();
  const std::string second = (directory_ / "contact_problem_t0_2.json").string();
  EXPECT_THROWS(SolverError, simulation.step(), "the problem is in '" + first + "'", "no solution");
  EXPECT_THROWS(SolverError, simulation.step(), "the problem is in '" + second + "'");
  const ProblemFile read = load_problem(first);
  EXPECT_EQ(read.problem.rows(), 4);
  EXPECT_EQ(read.problem.w(0, 0), 0.5);
  EXPECT_EQ(read.notes.time, 0.0);
  ASSERT_EQ(read.notes.contacts.size(), 2u);
  EXPECT_EQ(read.notes.contacts[0], "particle 'dot' on half-plane 'low'");
  EXPECT_NE(read.notes.comment.find("no solution"), std::string::npos) << read.notes.comment;
}

TEST_F(FailureFile, AlsoOfARefusedGain) {
  System system;
  system.add(HalfPlane{.normal = {0, 1}},
             Surface{.friction = 1.0, .normal_restitution = 1.0, .tangential_restitution = 0.0});
  const BodyId body =
      system.add(RigidBody{.mass = {.mass = 1.0, .inertia = 1.0}, .position = {0, 1}, .velocity = {1, -2}});
  system.add(Point{.body = body, .position = {-1, -1}});
  Simulation simulation(system, TimeStepping{.impact_rules = {.energy_gain = EnergyGain::refuse},
                                             .failure_directory = directory_.string()});
  EXPECT_THROWS(SolverError, simulation.step(), "no gain", "the problem is in '");
  EXPECT_EQ(files(), 1u);
}

/// Sweeps of a collapse that end early.
TimeStepping hasty(const std::string& directory) {
  TimeStepping options{.step = 1e-3, .failure_directory = directory};
  options.contact_budget.sweeps = 4;
  return options;
}

/// Name of the contact whose residual is the largest of a problem with the impulses of a step.
std::string worst_by_hand(const Simulation& now, const ProblemFile& file, double largest) {
  std::vector<double> impulses;
  for (const ContactRecord& contact : now.report().contacts) {
    if (contact.residual != largest) continue;
    impulses.insert(impulses.end(), contact.impulse.begin(), contact.impulse.begin() + contact.directions);
  }
  std::vector<double> xi(static_cast<std::size_t>(file.problem.rows()));
  if (impulses.size() != xi.size()) return "other contacts";
  file.problem.velocities(impulses, xi);
  const Residual found = residual(file.problem, impulses, xi);
  EXPECT_NEAR(found.value, largest, 1e-9 * largest);  // W is written in full, and was in factors
  return file.notes.contacts[static_cast<std::size_t>(found.group)];
}

TEST_F(FailureFile, AnswersAtTheCapLeaveTheWorstProblemsOnly) {
  System system;
  scenes::add_discs(system, {.count = 64, .width = 1.0});
  Simulation simulation(system, hasty(directory_.string()));
  std::vector<std::string> named;
  std::size_t capped_steps = 0, warned = 0;
  double worst = 0.0;
  std::string told;
  simulation.log() = Log(
      [&](LogLevel, std::string_view text) {
        told = text;
        warned += text.find("see " + directory_.string()) != std::string_view::npos ? 1U : 0U;
      },
      LogLevel::warning);
  simulation.observe([&](const Simulation& now) {
    double largest = 0.0;
    std::string of;
    for (const ContactRecord& contact : now.report().contacts) {
      EXPECT_TRUE(contact.outcome == Outcome::accepted_at_cap || !contact.worst);
      if (!contact.worst || contact.residual <= largest) continue;
      largest = contact.residual;
      of = now.name(contact.key);
    }
    capped_steps += largest > 0.0 ? 1U : 0U;
    EXPECT_EQ(now.report().capped_problem.empty(), !(largest > worst)) << now.time();
    worst = std::max(worst, largest);
    if (now.report().capped_problem.empty()) return;
    named.push_back(now.report().capped_problem);
    // Of the step that was made, with the names of its contacts.
    const ProblemFile read = load_problem(named.back());
    EXPECT_EQ(read.notes.contacts.size(), read.problem.groups().size());
    EXPECT_EQ(worst_by_hand(now, read, largest), of);
    EXPECT_NE(told.find("with that of " + of + ";"), std::string::npos) << told;
    ASSERT_TRUE(read.notes.time.has_value());
    EXPECT_NEAR(*read.notes.time, now.time() - 1e-3, 1e-12);
    EXPECT_NE(read.notes.comment.find("accepted at the cap of sweeps"), std::string::npos);
    // With as many sweeps as it takes it has an answer.
    SolverChain chain;
    chain.set_budget({.sweeps = 5000});
    std::vector<double> impulse(static_cast<std::size_t>(read.problem.rows()));
    EXPECT_EQ(chain.solve(read.problem, impulse).outcome, Outcome::solved);
  });
  simulation.run_until(0.3);
  EXPECT_GE(named.size(), 1U);
  EXPECT_GT(capped_steps, 2 * named.size());
  EXPECT_EQ(files(), named.size());
  EXPECT_EQ(warned, named.size());
}

TEST_F(FailureFile, AProblemThatCannotBeWrittenIsTold) {
  System system;
  scenes::add_discs(system, {.count = 64, .width = 1.0});
  Simulation simulation(system, hasty(directory_.string()));
  std::filesystem::remove_all(directory_);
  std::string told;
  while (told.empty() && simulation.time() < 0.3) {
    simulation.step();
    told = simulation.report().capped_problem;
  }
  EXPECT_NE(told.find("cannot be written"), std::string::npos) << told;
}

TEST_F(FailureFile, IsNotWrittenUnasked) {
  Simulation simulation(jammed(), TimeStepping{.impact_rules = {.refuse_jams = true}});
  try {
    simulation.step();
    ADD_FAILURE() << "the step succeeded";
  } catch (const SolverError& error) {
    EXPECT_EQ(std::string(error.what()).find("the problem is in"), std::string::npos) << error.what();
  }
}

TEST_F(FailureFile, ADirectoryThatIsNotThereIsRefused) {
  const std::string nowhere = (directory_ / "nowhere").string();
  EXPECT_THROWS(ModelError, Simulation(jammed(), TimeStepping{.failure_directory = nowhere}),
                "time stepping: failure_directory is '" + nowhere + "'", "an existing directory");
  // Gone in the meantime: the error is still that of the step.
  Simulation simulation(jammed(), TimeStepping{.impact_rules = {.refuse_jams = true},
                                               .failure_directory = directory_.string()});
  std::filesystem::remove_all(directory_);
  EXPECT_THROWS(SolverError, simulation.step(), "no solution", "cannot be written");
}

TEST(ContactStatistics, CountTheSweepsOfAcceptedSteps) {
  System system;
  system.add(Gravity{{0, -9.81}});
  system.add(HalfPlane{.normal = {0, 1}},
             Surface{.friction = 0.3, .normal_restitution = 0.5, .tangential_restitution = 0.0});
  system.add(Particle{.mass = 1.0, .position = {0, 0.5}, .velocity = {1, 0}});
  Simulation simulation(system, TimeStepping{});
  simulation.step();
  EXPECT_EQ(simulation.contact_statistics(), ChainStatistics{});
  simulation.run_until(2.0);
  const ChainStatistics counts = simulation.contact_statistics();
  constexpr auto single = static_cast<std::size_t>(SolverId::single_contact);
  EXPECT_GT(counts.problems, 100);
  EXPECT_GE(counts.problems, simulation.statistics().contact_steps);
  EXPECT_EQ(counts.accepted[single], counts.problems);
  EXPECT_EQ(counts.tried[single], counts.problems);
  EXPECT_GE(counts.worst_residual, simulation.statistics().worst_residual);
  EXPECT_LE(counts.worst_residual, 1e-15);
  // They belong to the run, not to the machine that makes the steps.
  simulation.switch_to(TimeStepping{.step = 5e-4});
  simulation.edit([](System&) {});
  EXPECT_EQ(simulation.contact_statistics(), counts);
  simulation.run_until(2.1);
  EXPECT_GT(simulation.contact_statistics().problems, counts.problems);
}

TEST(ContactStatistics, AFailedStepLeavesNoTrace) {
  Simulation simulation(jammed(), TimeStepping{.impact_rules = {.refuse_jams = true}});
  EXPECT_THROW(simulation.step(), SolverError);
  EXPECT_EQ(simulation.contact_statistics(), ChainStatistics{});
  // The other way round the walls yield; what is counted then is what a fresh simulation counts.
  const auto turn = [](Simulation& now) {
    State state = now.state();
    state.velocity(now.system().body("dot")) = Vec<2>(0.0, -1.0);
    now.set_state(state);
    now.step();
  };
  turn(simulation);
  Simulation fresh(jammed(), TimeStepping{.impact_rules = {.refuse_jams = true}});
  turn(fresh);
  EXPECT_GT(fresh.contact_statistics().problems, 0);
  EXPECT_EQ(simulation.contact_statistics(), fresh.contact_statistics());
}

}  // namespace
