// Contacts that are alone on their bodies: the same numbers as each as a problem of its own, or none at all.

#include <carom/carom.h>
#include <carom/contact/detection/detector.h>
#include <carom/contact/island_problem.h>
#include <carom/contact/lone_contacts.h>
#include <carom/core/assembly.h>
#include <carom/core/constraint_set.h>

#include "tests/random.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::Random;

constexpr int bodies = 40;
constexpr double depth = 1e-9;  // of all points in the floor [m]

/// Bodies, each of which touches a floor with a point somewhere beside its centre; of such proportions that
/// mu |W_nt| < W_nn up to mu = 0.4.
System leaning(Random& random, const Surface& surface) {
  System system;
  system.add(HalfPlane{.normal = {0.0, 1.0}, .surface_speed = 0.4}, surface);
  for (int i = 0; i < bodies; ++i) {
    const double height = random.uniform(0.5, 2.0);
    const BodyId body =
        system.add(RigidBody{.mass = {.mass = random.uniform(0.1, 1.0), .inertia = random.uniform(0.5, 3.0)},
                             .position = {10.0 * i, height - depth}});
    system.add(Point{.body = body, .position = {random.uniform(-1.0, 1.0), -height}});
  }
  return system;
}

/// Their contacts.
class Contacts {
public:
  explicit Contacts(const System& system) : assembly_(system), masses_(assembly_) {
    const State state = assembly_.initial_state();
    Evaluation evaluation = make_evaluation(assembly_);
    for (Index component = 0; component < assembly_.components().size(); ++component) {
      evaluate_positions(assembly_, component, state.view(), evaluation);
    }
    Detector detector(assembly_);
    for (Index component = 0; component < assembly_.components().size(); ++component) {
      detector.find(component, state.view(), evaluation, 0.0, list_);
    }
    before.resize(state.v.size());
    free.resize(state.v.size());
    change.resize(state.v.size());
  }
  [[nodiscard]] bool solve(LoneContacts& lone) {
    return lone.solve(list_, masses_, {before.data(), free.data(), change.data()});
  }
  [[nodiscard]] ConstraintSet& list() { return list_; }
  [[nodiscard]] MassResponse& masses() { return masses_; }

  std::vector<double> before, free, change;  // velocities, by impulses the last

private:
  Assembly assembly_;
  MassResponse masses_;
  ConstraintSet list_;
};

TEST(LoneContacts, AreSolvedAsProblemsOfTheirOwnAre) {
  Random random(31);
  const System system =
      leaning(random, {.friction = 0.4, .normal_restitution = 0.6, .tangential_restitution = 0.3});
  Contacts contacts(system);
  ASSERT_EQ(contacts.list().size(), static_cast<std::size_t>(bodies));
  LoneContacts lone;
  std::vector<int> modes(4);
  for (int round = 0; round < 200; ++round) {
    for (double& v : contacts.before) v = random.uniform(-1.0, 1.0);
    for (double& v : contacts.free) v = random.uniform(-1.0, 1.0);
    contacts.list()[3].allowed_approach = random.uniform(0.0, 0.5);
    std::vector<double> expected(contacts.change.size());
    contacts.change = expected;
    ASSERT_TRUE(contacts.solve(lone));
    ASSERT_EQ(lone.constraints().size(), contacts.list().size());
    SolverChain chain;
    for (std::size_t i = 0; i < contacts.list().size(); ++i) {
      IslandProblem problem;
      problem.build(std::span(contacts.list()).subspan(i, 1), contacts.before.data(), &contacts.masses());
      problem.set_free_velocity(contacts.free.data());
      ASSERT_TRUE(problem.solve(chain).usable());
      problem.add_velocities(expected.data());
      const LoneAnswer& answer = lone.answers()[i];
      EXPECT_EQ(answer.mode, problem.modes()[0]);
      EXPECT_EQ(answer.residual, problem.report().residual);
      for (std::size_t row = 0; row < 2; ++row) {
        EXPECT_EQ(answer.before[row], problem.before()[row]);
        EXPECT_EQ(answer.b[row], problem.problem().vector()[row]);
        EXPECT_EQ(answer.impulse[row], problem.impulses()[row]);
      }
      ++modes[static_cast<std::size_t>(answer.mode)];
    }
    EXPECT_EQ(contacts.change, expected);
    ChainStatistics of_lone, of_chain;
    lone.add_statistics(of_lone);
    chain.take_statistics(of_chain);
    EXPECT_EQ(of_lone, of_chain);
  }
  for (const int count : modes) EXPECT_GT(count, 100);  // of 8,000: every mode is among them
}

/// True if they are refused, and nothing is left of them.
bool are_refused(Contacts& contacts) {
  LoneContacts lone;
  const bool solved = contacts.solve(lone);
  ChainStatistics counted;
  lone.add_statistics(counted);
  const bool unchanged = contacts.change == std::vector<double>(contacts.change.size());
  return !solved && unchanged && lone.constraints().empty() && lone.answers().empty() &&
         counted == ChainStatistics{};
}

TEST(LoneContacts, RefuseWhatIsNotAlone) {
  Random random(32);
  System system = leaning(random, {.friction = 0.4, .normal_restitution = 0.6});
  const BodyId twice =
      system.add(RigidBody{.mass = {.mass = 1.0, .inertia = 1.0}, .position = {-10.0, 1.0 - depth}});
  for (const double x : {-0.5, 0.5}) system.add(Point{.body = twice, .position = {x, -1.0}});
  Contacts contacts(system);
  contacts.free.assign(contacts.free.size(), -1.0);
  EXPECT_TRUE(are_refused(contacts));
  contacts.list().resize(static_cast<std::size_t>(bodies));
  LoneContacts lone;
  EXPECT_TRUE(contacts.solve(lone));
}

TEST(LoneContacts, RefuseWhatDoesNotTurn) {
  System system;
  system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.4, .normal_restitution = 0.6});
  system.add(Particle{.mass = 1.0, .position = {0.0, -depth}});
  Contacts contacts(system);
  contacts.free = {0.1, -1.0};
  ASSERT_EQ(contacts.list().size(), 1u);
  EXPECT_TRUE(are_refused(contacts));
}

// The last of them: those before it are solved by then.
TEST(LoneContacts, RefuseWhatIsNotRegular) {
  Random random(33);
  Contacts smooth(leaning(random, {.friction = 0.0, .normal_restitution = 0.6}));
  smooth.free.assign(smooth.free.size(), -1.0);
  EXPECT_TRUE(are_refused(smooth));

  // mu |W_nt| > W_nn: there may be several solutions.
  Contacts jamming(leaning(random, {.friction = 0.1, .normal_restitution = 0.6}));
  jamming.free.assign(jamming.free.size(), -1.0);
  LoneContacts lone;
  ASSERT_TRUE(jamming.solve(lone));
  jamming.change.assign(jamming.change.size(), 0.0);
  (jamming.list().end() - 1)->friction = 1e3;
  EXPECT_TRUE(are_refused(jamming));

  // Neither closing nor opening: both answers are as good.
  (jamming.list().end() - 1)->friction = 0.1;
  jamming.before.assign(jamming.before.size(), 0.0);
  const Index v = (jamming.list().end() - 1)->blocks[0].v;
  for (Index k = v; k < v + 3; ++k) jamming.free[k] = 0.0;
  EXPECT_TRUE(are_refused(jamming));
}

}  // namespace
