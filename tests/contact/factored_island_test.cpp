// An island in factors against the same constraints with W as a matrix: W, b, the answer, the way back.

#include "tests/contact/random_constraints.h"
#include "tests/random.h"

#include <carom/carom.h>
#include <carom/contact/island_problem.h>
#include <carom/core/assembly.h>
#include <carom/core/constraint_set.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::Random;

constexpr int body_count = 60;

/// Rigid bodies, and a particle in every five.
System bodies() {
  System system;
  for (int i = 0; i < body_count; ++i) {
    const Vec<2> place(1.0 * i, 0.0);
    if (i % 5 == 3) {
      system.add(Particle{.mass = 0.7, .position = place});
    } else {
      system.add(RigidBody{.mass = {.mass = 1.0 + 0.1 * i, .inertia = 0.5 + 0.01 * i}, .position = place});
    }
  }
  return system;
}

constexpr IslandOptions in_factors{.factored_from = factored_constraints};

class FactoredIsland : public testing::Test {
protected:
  FactoredIsland() : assembly_(bodies()), masses_(assembly_) {
    chain_.set_budget({.residual = 1e-12, .sweeps = 20000});
    Random random(3);
    const std::size_t size = assembly_.initial_state().v.size();
    for (std::size_t i = 0; i < size; ++i) {
      before_.push_back(random.uniform(-1.0, 1.0));
      free_.push_back(random.uniform(-1.0, 1.0));
    }
  }
  /// Contacts of a chain of bodies, and limits over three of them.
  ConstraintSet constraints(int count, std::uint64_t seed) const {
    Random random(seed);
    ConstraintSet made;
    for (int i = 0; i < count; ++i) {
      const int rows = i % 7 == 6 ? 1 : 2;
      std::vector<Index> touched;
      for (int b = 0; b < (rows == 1 ? 3 : 1 + i % 2); ++b)
        touched.push_back(static_cast<Index>((i + b) % body_count));
      Constraint& one = made.add(carom_test::random_constraint(assembly_, rows, touched, random));
      one.law.tangential_restitution = 0.2;
      one.surface_velocity_after[0] = 0.01;
    }
    return made;
  }

  Assembly assembly_;
  MassResponse masses_;
  std::vector<double> before_, free_;
  SolverChain chain_;
};

TEST_F(FactoredIsland, IsTheSameProblem) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const ConstraintSet list = constraints(60 + static_cast<int>(seed), seed);
    IslandProblem island(in_factors);
    island.build(list, before_.data());
    island.respond(masses_);
    ASSERT_TRUE(island.problem().is_factored());
    island.set_free_velocity(free_.data());

    Delassus delassus;
    delassus.build(island.directions(), masses_);
    const auto n = delassus.size();
    std::vector<double> w(n * n);
    delassus.write_symmetric(w.data());
    const ContactProblem dense = island.problem().dense();
    for (std::size_t i = 0; i < n * n; ++i) EXPECT_NEAR(dense.matrix()[i], w[i], 1e-14);
    for (std::size_t row = 0; row < n; ++row) {
      const ImpulseDirection& at = island.directions()[row];
      const double b = at.constraint->velocity_after(at.row, free_.data()) +
                       at.constraint->restitution(at.row) * island.before()[row];
      EXPECT_NEAR(dense.vector()[row], b, 1e-14);
    }

    ASSERT_TRUE(island.solve(chain_).usable());
    EXPECT_LE(island.report().residual, 1e-12);
    std::vector<double> xi(n), factored = free_, direct = free_;
    dense.velocities(island.impulses(), xi);
    EXPECT_LE(residual(dense, island.impulses(), xi).value, 1.01e-12);
    island.map().add_velocities(factored.data());
    delassus.add_response(island.impulses(), direct.data());
    for (std::size_t i = 0; i < direct.size(); ++i) EXPECT_NEAR(factored[i], direct[i], 1e-13);
    // xi = gamma^+ + E gamma^-.
    for (std::size_t row = 0; row < n; ++row) {
      const ImpulseDirection& at = island.directions()[row];
      const double after = at.constraint->velocity_after(at.row, factored.data());
      EXPECT_NEAR(xi[row], after + at.constraint->restitution(at.row) * island.before()[row], 1e-13);
    }

    // From velocities to which the impulses have led they remain the answer.
    island.set_velocity(factored.data());
    const std::vector<double> answer(island.impulses().begin(), island.impulses().end());
    ASSERT_TRUE(island.solve(chain_).usable());
    EXPECT_LE(island.report().iterations, 1);
    for (std::size_t row = 0; row < n; ++row) EXPECT_NEAR(island.impulses()[row], answer[row], 1e-11);
  }
}

TEST_F(FactoredIsland, StartsFromImpulsesOfTheCaller) {
  const ConstraintSet list = constraints(80, 4);
  IslandProblem island(in_factors);
  island.build(list, before_.data());
  island.respond(masses_);
  island.set_free_velocity(free_.data());
  ASSERT_TRUE(island.solve(chain_).usable());
  EXPECT_GT(island.report().iterations, 0);
  const std::vector<double> answer(island.impulses().begin(), island.impulses().end());
  IslandProblem next(in_factors);
  std::vector<const Constraint*> asked;
  const auto start = [&](std::span<const Constraint> some, double* impulses) {
    for (const Constraint& one : some) {
      asked.push_back(&one);
      const auto first =
          static_cast<std::size_t>(island.first_row(static_cast<std::size_t>(&one - &list[0])));
      for (std::size_t i = 0; i < static_cast<std::size_t>(one.rows); ++i) *impulses++ = answer[first + i];
    }
  };
  IslandStart from_caller;
  from_caller.impulses = start;
  next.build(list, before_.data(), &masses_, from_caller);
  ASSERT_EQ(asked.size(), list.size());
  for (std::size_t c = 0; c < list.size(); ++c) EXPECT_EQ(asked[c], &list[c]);
  next.set_free_velocity(free_.data());
  ASSERT_TRUE(next.solve(chain_).usable());
  EXPECT_EQ(next.report().iterations, 0);
  EXPECT_TRUE(std::equal(answer.begin(), answer.end(), next.impulses().begin()));
}

// Rows that have turned a little: the answer before, and the equations that solved it, are where it starts.
TEST_F(FactoredIsland, StartsFromItsOwnAnswer) {
  const ConstraintSet all = constraints(40, 4);
  const std::span<const Constraint> list(all.begin(), all.end());
  for (const std::size_t from : {std::size_t{2}, list.size() + 1}) {  // in factors, and with W in full
    IslandProblem island({.factored_from = from});
    IslandStart start;
    start.keeps_equations = true;
    island.build(list, before_.data(), &masses_, start);
    island.set_free_velocity(free_.data());
    ASSERT_TRUE(island.solve(chain_).usable());
    const std::vector<double> cold(island.impulses().begin(), island.impulses().end());
    std::vector<double> moved = free_;
    for (double& velocity : moved) velocity *= 1.0 + 1e-6;
    start.from_answer = true;
    island.build(list, before_.data(), &masses_, start);
    EXPECT_TRUE(std::equal(cold.begin(), cold.end(), island.impulses().begin()));
    island.set_free_velocity(moved.data());
    ASSERT_TRUE(island.solve(chain_).usable());
    EXPECT_LE(island.report().residual, accepted_residual);
    EXPECT_FALSE(island.changed_modes());
    if (from == 2) {
      EXPECT_EQ(island.report().iterations, 0);  // no sweep
    }
    // Of other constraints, or of fewer: from zero.
    island.build(list.first(list.size() - 1), before_.data(), &masses_, start);
    for (const double impulse : island.impulses()) EXPECT_EQ(impulse, 0.0);
  }
}

TEST_F(FactoredIsland, HasTheSameNumbersStatedInOneGo) {
  for (const int count : {12, 64, 80, 81}) {
    const ConstraintSet list = constraints(count, 5);
    IslandProblem apart(in_factors), at_once(in_factors);
    apart.build(list, before_.data());
    apart.respond(masses_);
    apart.set_free_velocity(free_.data());
    at_once.build(list, before_.data(), &masses_);
    at_once.set_free_velocity(free_.data());
    const ContactProblem &one = apart.problem(), &other = at_once.problem();
    ASSERT_TRUE(other.is_factored());
    ASSERT_EQ(other.rows(), one.rows());
    EXPECT_EQ(other.factors().inverse_mass, one.factors().inverse_mass);
    EXPECT_TRUE(std::equal(one.vector().begin(), one.vector().end(), other.vector().begin()));
    EXPECT_TRUE(std::equal(apart.before().begin(), apart.before().end(), at_once.before().begin()));
    for (std::size_t row = 0; row < one.vector().size(); ++row) {
      EXPECT_EQ(other.factors().rows[row].slot, one.factors().rows[row].slot);
      EXPECT_EQ(other.factors().rows[row].h, one.factors().rows[row].h);
      EXPECT_EQ(other.sets()[row].kind, one.sets()[row].kind);
      EXPECT_EQ(other.sets()[row].bound, one.sets()[row].bound);
      EXPECT_EQ(other.sets()[row].coefficient, one.sets()[row].coefficient);
      EXPECT_EQ(other.diagonal(static_cast<int>(row)), one.diagonal(static_cast<int>(row)));
    }
  }
}

TEST_F(FactoredIsland, IsForManyConstraintsOfSeveralBodiesOnly) {
  IslandProblem island;
  const auto respond = [&](const ConstraintSet& list) {
    island.build(list, before_.data());
    island.respond(masses_);
    return island.problem().is_factored();
  };
  EXPECT_FALSE(respond(constraints(factored_constraints, 1)));  // not allowed
  island = IslandProblem(in_factors);
  EXPECT_FALSE(respond(constraints(factored_constraints - 1, 1)));
  EXPECT_TRUE(respond(constraints(factored_constraints, 1)));
  ConstraintSet of_one = constraints(factored_constraints, 1);
  for (Constraint& one : of_one) {
    one.take(constraints(1, 2)[0]);
  }
  EXPECT_FALSE(respond(of_one));
  // Nor where bodies do not answer for themselves; W is a matrix then, whatever was expected.
  class Together final : public BodyResponse {
  public:
    explicit Together(MassResponse& masses) : masses_(&masses) {}
    [[nodiscard]] Range reach(Index body) const override { return masses_->reach(body); }
    void answer(Index body, double* x, std::size_t columns, char* held) override {
      masses_->answer(body, x, columns, held);
    }

  private:
    MassResponse* masses_;
  } together(masses_);
  const ConstraintSet list = constraints(factored_constraints, 1);
  island.build(list, before_.data());
  island.respond(masses_);
  const ContactProblem factored = island.problem();
  island.build(list, before_.data());
  island.respond(together);
  ASSERT_FALSE(island.problem().is_factored());
  const ContactProblem dense = factored.dense();
  for (std::size_t i = 0; i < dense.matrix().size(); ++i) {
    EXPECT_NEAR(island.problem().matrix()[i], dense.matrix()[i], 1e-14);
  }
  IslandProblem at_once(in_factors);
  at_once.build(list, before_.data(), &together);
  ASSERT_FALSE(at_once.problem().is_factored());
  const std::span<const double> matrix = island.problem().matrix();
  EXPECT_TRUE(std::equal(matrix.begin(), matrix.end(), at_once.problem().matrix().begin()));
}

}  // namespace
