// Components that constraints join for some steps only: which they are, and that they are solved as one.

#include "tests/constraint_sets.h"
#include <carom/carom.h>
#include <carom/core/assembly.h>
#include <carom/core/constraint_set.h>
#include <carom/integrators/time_stepping/island_iteration.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <initializer_list>
#include <span>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

/// A contact along x: its first body is on the right. One body: against the ground.
SingleConstraint contact(const Assembly& assembly, std::initializer_list<Index> bodies,
                         double restitution = 0.5) {
  SingleConstraint made;
  made.law.normal_restitution = restitution;
  double sign = 1.0;
  for (const Index body : bodies) {
    const BodySlot& slot = assembly.layout()->bodies()[body];
    made.add_body(body, slot.v, static_cast<int>(slot.v_size));
  }
  made.start_rows(1);
  std::fill_n(made.row(0), made.columns(), 0.0);
  int column = 0;
  for (int b = 0; b < made.bodies; ++b, sign = -1.0) {
    made.row(0)[column] = sign;
    column += made.blocks[static_cast<std::size_t>(b)].columns;
  }
  return made;
}

/// Four particles.
Assembly particles() {
  System system;
  for (int i = 0; i < 4; ++i) system.add(Particle{.mass = 1.0, .position = {1.0 * i, 0.0}});
  return Assembly(std::move(system));
}

/// Finds the islands of bodies that are components, and brings their constraints together.
void find(StepIslands& islands, std::span<const Range> batches, ConstraintSet& constraints) {
  std::vector<JoinedNodes> joined;
  for (const Constraint& at : constraints) {
    joined.push_back({at.body(), at.blocks[at.bodies == 1 ? 0 : 1].body});
  }
  ConstraintSet in_order;
  for (const Index i : islands.find(batches, joined)) in_order.add(constraints[i]);
  constraints = in_order;
  islands.take(constraints);
}

std::vector<Index> components(const StepIsland& island) {
  return {island.components.begin(), island.components.end()};
}

TEST(StepIslands, JoinComponentsAsLongAsConstraintsDo) {
  const Assembly assembly = particles();
  StepIslands islands(assembly);
  const std::vector<Range> alone{{0, 1}, {1, 2}, {2, 3}, {3, 4}};
  ConstraintSet list = carom_test::set_of(
      {contact(assembly, {0}), contact(assembly, {1, 3}), contact(assembly, {2}), contact(assembly, {3})});
  find(islands, alone, list);
  ASSERT_EQ(islands.list().size(), 3u);
  EXPECT_EQ(components(islands.list()[0]), (std::vector<Index>{0}));
  EXPECT_EQ(components(islands.list()[1]), (std::vector<Index>{1, 3}));
  EXPECT_EQ(components(islands.list()[2]), (std::vector<Index>{2}));
  ASSERT_EQ(islands.list()[1].constraints.size(), 2u);
  EXPECT_EQ(islands.list()[1].constraints[0].bodies, 2);
  EXPECT_EQ(islands.list()[1].constraints[1].body(), 3u);
  EXPECT_EQ(islands.list()[2].constraints[0].body(), 2u);
  // Without the constraint in the next step everybody stands alone again; a chain joins all.
  list = carom_test::set_of({contact(assembly, {0}), contact(assembly, {3})});
  find(islands, alone, list);
  ASSERT_EQ(islands.list().size(), 4u);
  for (Index i = 0; i < 4; ++i) {
    EXPECT_EQ(components(islands.list()[i]), (std::vector<Index>{i}));
    EXPECT_EQ(islands.list()[i].constraints.size(), i == 0 || i == 3 ? 1u : 0u);
  }
  list =
      carom_test::set_of({contact(assembly, {0, 1}), contact(assembly, {1, 2}), contact(assembly, {2, 3})});
  find(islands, alone, list);
  ASSERT_EQ(islands.list().size(), 1u);
  EXPECT_EQ(islands.list()[0].constraints.size(), 3u);
}

/// Uncoupled bodies are one island; what a constraint joins leaves it for as long as it acts.
/// Order of constraints, and components and constraints of the islands.
std::vector<std::vector<Index>> found(StepIslands& islands, std::span<const Range> batches,
                                      std::span<const JoinedNodes> joined) {
  const std::span<const Index> order = islands.find(batches, joined);
  std::vector<std::vector<Index>> out{{order.begin(), order.end()}};
  ConstraintSet constraints;
  constraints.resize(joined.size());
  islands.take(constraints);
  for (const StepIsland& island : islands.list()) {
    out.push_back(components(island));
    out.push_back({static_cast<Index>(island.constraints.size()), island.joined ? 1U : 0U});
    for (const Range range : island.batches) out.insert(out.end(), {{range.begin, range.end}});
  }
  return out;
}

TEST(StepIslands, WhatIsKnownFromTheStepBeforeIsWhatIsFoundAnew) {
  const Assembly assembly = particles();
  const std::span<const Range> batches = assembly.batches();
  const std::vector<JoinedNodes> pair{{0, 1}}, other{{2, 3}}, chain{{0, 1}, {1, 1}, {2, 1}},
      turned{{0, 2}, {1, 1}, {2, 1}}, apart{{0, 1}, {2, 3}};
  StepIslands kept(assembly);
  for (const auto* const joined : {&pair, &pair, &other, &chain, &chain, &turned, &apart, &apart, &chain}) {
    StepIslands fresh(assembly);
    const std::vector<std::vector<Index>> anew = found(fresh, batches, *joined);
    EXPECT_EQ(found(kept, batches, *joined), anew);
    EXPECT_EQ(found(kept, batches, *joined), anew);
    kept.find(batches);  // a step in which nothing joins
    EXPECT_EQ(found(kept, batches, *joined), anew);
  }
}

TEST(StepIslands, BatchesStayTogetherUnlessConstraintsJoin) {
  System system;
  for (int i = 0; i < 6; ++i) system.add(Particle{.mass = 1.0, .position = {1.0 * i, 0.0}});
  const Assembly assembly(std::move(system));
  ASSERT_EQ(assembly.batches().size(), 1u);
  StepIslands islands(assembly);
  ConstraintSet list = carom_test::set_of({contact(assembly, {1}), contact(assembly, {4})});
  find(islands, assembly.batches(), list);
  ASSERT_EQ(islands.list().size(), 1u);
  EXPECT_EQ(islands.list()[0].components.size(), 6u);
  EXPECT_EQ(islands.list()[0].constraints.size(), 2u);
  ASSERT_EQ(islands.list()[0].batches.size(), 1u);
  EXPECT_EQ(islands.list()[0].batches[0].size(), 6u);

  list = carom_test::set_of(
      {contact(assembly, {1}), contact(assembly, {2, 4}), contact(assembly, {3}), contact(assembly, {5})});
  find(islands, assembly.batches(), list);
  ASSERT_EQ(islands.list().size(), 3u);
  EXPECT_EQ(components(islands.list()[0]), (std::vector<Index>{0, 1}));
  EXPECT_EQ(components(islands.list()[1]), (std::vector<Index>{2, 4}));
  EXPECT_EQ(components(islands.list()[2]), (std::vector<Index>{3, 5}));
  for (const StepIsland& island : islands.list()) {
    std::vector<Index> again;
    for (const Range range : island.batches) {
      for (Index component = range.begin; component < range.end; ++component) again.push_back(component);
    }
    EXPECT_EQ(again, components(island));
  }
  ASSERT_EQ(islands.list()[0].constraints.size(), 1u);
  EXPECT_EQ(islands.list()[0].constraints[0].body(), 1u);
  ASSERT_EQ(islands.list()[1].constraints.size(), 1u);
  EXPECT_EQ(islands.list()[1].constraints[0].bodies, 2);
  ASSERT_EQ(islands.list()[2].constraints.size(), 2u);
  EXPECT_EQ(islands.list()[2].constraints[0].body(), 3u);
  EXPECT_EQ(islands.list()[2].constraints[1].body(), 5u);
}

/// Two pairs of particles on springs, the left one running into the right one; a spring without stiffness
/// between them makes them one component from the start.
System two_pairs(bool one_component) {
  System system;
  std::vector<BodyId> all;
  const std::vector<double> speeds{2.0, 2.0, -1.0, -1.5};
  for (std::size_t i = 0; i < 4; ++i) {
    all.push_back(system.add(Particle{.mass = 1.0 + 0.5 * static_cast<double>(i),
                                      .position = {static_cast<double>(i), 0.0},
                                      .velocity = {speeds[i], 0.0}}));
  }
  for (const std::size_t i : {0u, 2u}) {
    system.add(SpringDamper{.from = all[i], .to = all[i + 1], .stiffness = 2000.0, .damping = 3.0});
  }
  if (one_component) system.add(SpringDamper{.from = all[1], .to = all[2], .stiffness = 0.0, .damping = 0.0});
  return system;
}

/// One step of an island that is made by hand, from the start of a system.
struct HandMadeStep {
  explicit HandMadeStep(System system)
      : assembly(std::move(system)),
        iteration(model, constraints, schedule, contacts, located, joints, trial, nullptr),
        state(assembly.initial_state()) {
    const std::size_t size = state.v.size();
    companion.rounding.assign(size, 0.0F);
    companion.loads.total.assign(size, 0.0);
    companion.loads.dissipative.assign(size, 0.0);
    Evaluation evaluation = make_evaluation(assembly);
    LoadsAtEnd loads{companion.loads.total, companion.loads.dissipative, {}};
    for (Index c = 0; c < assembly.components().size(); ++c) {
      evaluate_loads(assembly, c, state.view(), evaluation, loads.by_cause());
      loads.finish(assembly.components()[c].v);
    }
    companion.loads.total = loads.total;
    companion.loads.dissipative = loads.dissipative;
    for (Index c = 0; c < assembly.components().size(); ++c) members.push_back(c);
    trial.begin(in, companion.history);
    iteration.use(Iteration::fixed_point);
  }
  const std::vector<double>& solve(ConstraintSet& of_island) {
    FixedPointJudge judge(1e-15, 200);
    static_cast<void>(iteration.solve({members, of_island}, in, judge));
    return trial.end.v;
  }

  Assembly assembly;
  TimeStepping options{.step = 1e-3};
  StepConstraints constraints{assembly, options};
  StepModel model{assembly, options, constraints.detector()};
  StepTrial trial{assembly, model.needs};
  SweepSchedule schedule{assembly, options, model.batches.any_iterated()};
  ContactStage contacts{assembly, options};
  LocatedImpacts located{model};
  JointStages joints{assembly};
  IslandIteration iteration;
  State state;
  Companion companion;
  StepInput in{assembly, state, companion, 1e-3, 1e-3};
  std::vector<Index> members;
};

TEST(StepIslands, SeveralComponentsAreSolvedAsOne) {
  HandMadeStep joined(two_pairs(false)), whole(two_pairs(true));
  ASSERT_EQ(joined.assembly.components().size(), 2u);
  ASSERT_EQ(whole.assembly.components().size(), 1u);
  ConstraintSet between = carom_test::set_of({contact(joined.assembly, {2, 1})});
  ConstraintSet within = carom_test::set_of({contact(whole.assembly, {2, 1})});
  const std::vector<double>& v = joined.solve(between);
  const std::vector<double>& expected = whole.solve(within);
  // Sums of two numbers in the same order, iterated until nothing changes.
  for (std::size_t i = 0; i < v.size(); ++i) {
    EXPECT_NEAR(v[i], expected[i], 1e-14);
    EXPECT_NEAR(joined.trial.end.q[i], whole.trial.end.q[i], 1e-14);
  }
  // Newton's law of impact, and momentum: the impulse acts between the two.
  EXPECT_NEAR(v[4] - v[2], 0.5 * (2.0 + 1.0), 1e-13);
  EXPECT_NEAR(1.0 * v[0] + 1.5 * v[2] + 2.0 * v[4] + 2.5 * v[6], 1.0 * 2.0 + 1.5 * 2.0 - 2.0 - 2.5 * 1.5,
              1e-13);
}

TEST(StepIslands, WithoutTheConstraintComponentsDoNotSeeEachOther) {
  HandMadeStep step(two_pairs(false));
  ConstraintSet none;
  const std::vector<double> apart = step.solve(none);
  EXPECT_NEAR(1.0 * apart[0] + 1.5 * apart[2], 1.0 * 2.0 + 1.5 * 2.0, 1e-13);
}

/// Two mechanisms that a constraint joins: the impulse is that of W with what the joints of each leave.
TEST(StepIslands, ComponentsWithJointsAreSolvedTogether) {
  System system;
  for (const double x : {0.0, 2.0}) {
    const BodyId bar = system.add(RigidBody{.mass = {.mass = 1.0, .inertia = 0.1},
                                            .position = {x, -0.5},
                                            .velocity = {x == 0.0 ? 0.5 : 0.0, 0.0},
                                            .spin = x == 0.0 ? 1.0 : 0.0});
    system.add(Revolute{.from = {ground, {x, 0.0}}, .to = {bar, {0.0, 0.5}}});
  }
  HandMadeStep step(std::move(system));
  ConstraintSet between = carom_test::set_of({contact(step.assembly, {1, 0})});
  const double before = between[0].velocity(0, step.state.v.data());
  ASSERT_LT(before, 0.0);
  const std::vector<double>& v = step.solve(between);
  // Newton's law of impact with the restitution of the constraint; each bar still turns about its pin. The
  // bars turn by 1e-3 rad within the step: cosines differ by the square of it.
  EXPECT_NEAR(between[0].velocity(0, v.data()), -between[0].law.normal_restitution * before, 2e-6);
  for (const std::size_t bar : {0u, 3u}) EXPECT_NEAR(v[bar], 0.5 * v[bar + 2], 2e-6);
}

/// A chain of several blocks.
System chain(int links) {
  System system;
  BodyId last = ground;
  for (int i = 0; i < links; ++i) {
    const BodyId next =
        system.add(Particle{.mass = 0.1, .position = {0.1 * i, 0.0}, .velocity = {i == 0 ? 3.0 : -1.0, 0.0}});
    if (i > 0) system.add(SpringDamper{.from = last, .to = next, .stiffness = 50.0});
    last = next;
  }
  return system;
}

/// A constraint across blocks makes them staged.
TEST(StepIslands, ConstraintsAcrossBlocksAreStaged) {
  constexpr int links = 3000;
  HandMadeStep step(chain(links));
  ASSERT_GT(step.assembly.components()[0].blocks.size(), 2u);
  const auto state = [&](ConstraintSet& list) {
    step.contacts.state_problems(step.in, {step.members, list}, false, step.trial);
  };
  ConstraintSet within =
      carom_test::set_of({contact(step.assembly, {1, 0}), contact(step.assembly, {links - 1})});
  state(within);
  EXPECT_TRUE(step.contacts.by_block());
  EXPECT_EQ(step.contacts.problems().size(), 2u);
  EXPECT_FALSE(step.contacts.touches(1));
  ConstraintSet across =
      carom_test::set_of({contact(step.assembly, {0, links - 1}), contact(step.assembly, {7})});
  state(across);
  EXPECT_FALSE(step.contacts.by_block());
  EXPECT_TRUE(step.contacts.touches(1));
  // The last link, at -1 m/s, is hit by nothing; the first, at 3 m/s to the right of it, parts from it: the
  // other way round they meet at 4 m/s.
  across = carom_test::set_of({contact(step.assembly, {links - 1, 0}), contact(step.assembly, {7})});
  const std::vector<double>& v = step.solve(across);
  EXPECT_NEAR(v[2 * (links - 1)] - v[0], 0.5 * 4.0, 1e-13);
}

}  // namespace
