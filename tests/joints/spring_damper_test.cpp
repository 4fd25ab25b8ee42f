#include <carom/bodies/particle.h>
#include <carom/bodies/rigid_body.h>
#include <carom/core/assembly.h>
#include <carom/joints/spring_damper.h>

#include "tests/derivative_check.h"
#include "tests/random.h"
#include <carom/testing/loaded_model.h>

#include <gtest/gtest.h>

#include <Eigen/Core>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace {

using namespace carom;
using carom::energy_test::LoadedModel;
using carom_test::By;
using carom_test::expect_derivatives_meet_differences;
using carom_test::load_derivatives;
using carom_test::Random;

constexpr double epsilon = std::numeric_limits<double>::epsilon();

double largest(const std::vector<double>& numbers) {
  double result = 0.0;
  for (const double x : numbers) result = std::max(result, std::abs(x));
  return result;
}

void expect_loads_near(const std::vector<double>& found, const std::vector<double>& expected,
                       double tolerance) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i)
    EXPECT_NEAR(found[i], expected[i], tolerance) << "load " << i;
}

// Ends of every sort.
enum class Where { ground, particle, centre, off_centre };
constexpr Where all_ends[] = {Where::ground, Where::particle, Where::centre, Where::off_centre};

// A spring between two ends at random places, at least half a metre apart so that nothing is nearly singular.
// A bystander comes first, so that offsets are not zero.
struct RandomSpring {
  RandomSpring(Random& random, Where from, Where to, double damping) {
    using namespace planar;
    system.add(RigidBody{.mass = disc(1.0, 1.0)});
    const auto end = [&](Where where, const Vec<2>& about) -> End<2> {
      switch (where) {
        case Where::ground:
          return {ground, about};
        case Where::particle:
          return system.add(Particle{.mass = 1.0, .position = about, .velocity = random.vec<2>(2.0)});
        case Where::centre:
        case Where::off_centre:
          break;
      }
      const BodyId body = system.add(RigidBody{.mass = disc(1.0, 1.0),
                                               .position = about,
                                               .angle = random.uniform(-3.0, 3.0),
                                               .velocity = random.vec<2>(2.0),
                                               .spin = random.uniform(-2.0, 2.0)});
      return where == Where::centre ? End<2>(body) : End<2>(body, random.vec<2>(0.7));
    };
    const double angle = random.uniform(-3.0, 3.0), distance = random.uniform(2.5, 4.0);
    const End<2> first = end(from, random.vec<2>(1.0));
    const Vec<2> about(distance * std::cos(angle), distance * std::sin(angle));
    const End<2> second = end(to, about + (from == Where::ground ? first.point : Vec<2>(0, 0)));
    spring = {.from = first,
              .to = second,
              .stiffness = random.uniform(0.5, 5.0),
              .damping = damping,
              .free_length = random.uniform(0.0, 5.0)};
    if (first.body != ground || second.body != ground) system.add(spring);
  }

  System system;
  planar::SpringDamper spring;
};

template <class F>
void for_random_springs(std::uint64_t seed, double damping, F&& f) {
  Random random(seed);
  for (const Where from : all_ends) {
    for (const Where to : all_ends) {
      if (from == Where::ground && to == Where::ground) continue;
      for (int repeat = 0; repeat < 10; ++repeat) {
        const RandomSpring random_spring(random, from, to, damping);
        LoadedModel model(random_spring.system);
        SCOPED_TRACE("from " + std::to_string(static_cast<int>(from)) + " to " +
                     std::to_string(static_cast<int>(to)));
        f(model, random_spring.spring);
      }
    }
  }
}

TEST(SpringDamper, ClosedFormOnALine) {
  using namespace planar;
  System system;
  const BodyId a = system.add(Particle{.mass = 1.0, .position = {1, 0}, .velocity = {2, 7}});
  const BodyId b = system.add(Particle{.mass = 1.0, .position = {4, 0}, .velocity = {-3, 8}});
  system.add(SpringDamper{.from = a, .to = b, .stiffness = 10.0, .damping = 0.5, .free_length = 2.5});
  LoadedModel model(system);
  // Length 3, rate -5: the spring pulls with 5 N, the dashpot pushes with 2.5 N; motion across does nothing.
  expect_loads_near(model.conservative, {5, 0, -5, 0}, 16 * epsilon);
  expect_loads_near(model.dissipative, {-2.5, 0, 2.5, 0}, 16 * epsilon);
  expect_loads_near(model.external, {0, 0, 0, 0}, 0.0);
  EXPECT_EQ(model.energies()[StoredEnergy::elastic], 1.25);
  EXPECT_NEAR(model.power(model.dissipative), -0.5 * 25.0, 32 * epsilon);
}

TEST(SpringDamper, OffCentreEndsTurnTheBodies) {
  using namespace planar;
  System system;
  const BodyId plate = system.add(RigidBody{.mass = disc(1.0, 1.0), .angle = std::acos(0.0), .spin = 2.0});
  // The point (1, 0) of the plate is at (0, 1) and moves with (-2, 0); the anchor is at (0, 4)...
  system.add(
      SpringDamper{.from = {plate, {1, 0}}, .to = {ground, {0, 4}}, .stiffness = 2.0, .free_length = 1.0});
  // ... and at (-3, 1).
  system.add(SpringDamper{.from = {ground, {-3, 1}}, .to = {plate, {1, 0}}, .damping = 3.0});
  const LoadedModel model(system);
  expect_loads_near(model.conservative, {0, 4, 0}, 64 * epsilon);
  // Length 3 falls with 2 m/s, the dashpot pushes +x with 6 N at the lever (0, 1).
  expect_loads_near(model.dissipative, {6, 0, -6}, 64 * epsilon);
}

TEST(SpringDamper, ForceIsMinusTheGradientOfThePotential) {
  for_random_springs(121, 0.7, [](LoadedModel& model, const planar::SpringDamper&) {
    // Forces below 30 N; differences of fourth order leave 4e-12 k / l^3 and rounding 1e-11.
    expect_loads_near(model.conservative, model.minus_gradient(), 1e-10);
  });
}

TEST(SpringDamper, DerivativesMeetDifferences) {
  for_random_springs(122, 0.7, [](LoadedModel& model, const planar::SpringDamper&) {
    expect_derivatives_meet_differences(model);
    EXPECT_GT(load_derivatives(model, By::element).cwiseAbs().maxCoeff(), 0.01);
  });
}

TEST(SpringDamper, StiffnessMatrixIsSymmetricWithoutDamping) {
  for_random_springs(123, 0.0, [](LoadedModel& model, const planar::SpringDamper&) {
    const Eigen::MatrixXd own = load_derivatives(model, By::element);
    const Eigen::MatrixXd matrix = own.leftCols(own.rows());
    EXPECT_EQ(own.rightCols(own.rows()).norm(), 0.0);
    EXPECT_LE((matrix - matrix.transpose()).cwiseAbs().maxCoeff(),
              64 * epsilon * matrix.cwiseAbs().maxCoeff());
  });
}

TEST(SpringDamper, ActionIsReaction) {
  for_random_springs(124, 0.7, [](LoadedModel& model, const planar::SpringDamper& spring) {
    if (spring.from.body == ground || spring.to.body == ground) return;  // the ground's share is not listed
    for (const std::vector<double>* load : {&model.conservative, &model.dissipative}) {
      EXPECT_GT(largest(*load), 0.0);
      // Moments: forces below 30 N at levers below 6 m.
      for (const double sum : model.resultant(*load)) EXPECT_NEAR(sum, 0.0, 16 * epsilon * 30.0 * 6.0);
    }
  });
}

TEST(SpringDamper, MomentAboutAnAnchorVanishes) {
  for_random_springs(125, 0.7, [](LoadedModel& model, const planar::SpringDamper& spring) {
    if (spring.from.body != ground && spring.to.body != ground) return;
    const Vec<2> anchor = spring.from.body == ground ? spring.from.point : spring.to.point;
    for (const std::vector<double>* load : {&model.conservative, &model.dissipative}) {
      const auto sum = model.resultant(*load);
      EXPECT_NEAR(sum[2] - (anchor[0] * sum[1] - anchor[1] * sum[0]), 0.0, 16 * epsilon * 30.0 * 6.0);
    }
  });
}

TEST(SpringDamper, DashpotTakesOutDampingTimesTheSquareOfTheRate) {
  for_random_springs(126, 0.7, [](LoadedModel& model, const planar::SpringDamper& spring) {
    const auto length_after = [&](double time) {
      State moved = model.state;
      for (std::size_t i = 0; i < moved.q.size(); ++i) moved.q[i] += time * moved.v[i];
      Evaluation evaluation = make_evaluation(model.assembly);
      for (Index component = 0; component < model.assembly.components().size(); ++component) {
        evaluate_positions(model.assembly, component, moved.view(), evaluation);
      }
      const Attachment<2> from(spring.from, *model.assembly.layout()),
          to(spring.to, *model.assembly.layout());
      return (to.position(moved.view(), to.lever(evaluation)) -
              from.position(moved.view(), from.lever(evaluation)))
          .norm();
    };
    const double step = 1e-5;
    const double rate = (length_after(step) - length_after(-step)) / (2.0 * step);
    // The rate is below 10 m/s, by differences to 1e-8.
    EXPECT_NEAR(model.power(model.dissipative), -spring.damping * rate * rate, 0.7 * 2.0 * 10.0 * 1e-8);
  });
}

TEST(SpringDamper, ACentreGivenAsAPointIsTheCentre) {
  using namespace planar;
  const auto loads = [](bool as_point) {
    System system;
    const BodyId a =
        system.add(RigidBody{.mass = disc(1.0, 1.0), .position = {1, 2}, .angle = 1.0, .spin = 3.0});
    const BodyId b = system.add(Particle{.mass = 1.0, .position = {4, 6}, .velocity = {1, 0}});
    system.add(SpringDamper{
        .from = as_point ? End<2>(a, {0, 0}) : End<2>(a), .to = b, .stiffness = 1.0, .damping = 1.0});
    const LoadedModel model(system);
    return std::pair(model.conservative, model.dissipative);
  };
  EXPECT_EQ(loads(true), loads(false));
}

TEST(SpringDamper, SwappedEndsAreTheSameSpring) {
  for_random_springs(127, 0.7, [](LoadedModel& model, const planar::SpringDamper& spring) {
    System system = model.assembly.system();
    system.remove(system.elements()[0]);
    planar::SpringDamper swapped = spring;
    std::swap(swapped.from, swapped.to);
    system.add(swapped);
    const LoadedModel other(system);
    EXPECT_EQ(other.conservative, model.conservative);
    EXPECT_EQ(other.dissipative, model.dissipative);
  });
}

class ZeroLengthTest : public testing::Test {
protected:
  static System make(double free_length) {
    using namespace planar;
    System system;
    const BodyId a = system.add(Particle{.mass = 1.0, .position = {1, 2}, .velocity = {3, 4}});
    const BodyId b = system.add(Particle{.mass = 1.0, .position = {1, 2}});
    system.add(
        SpringDamper{.from = a, .to = b, .stiffness = 8.0, .damping = 2.0, .free_length = free_length});
    const BodyId plate = system.add(RigidBody{.mass = disc(1.0, 1.0), .position = {0, 1}, .spin = 1.0});
    system.add(SpringDamper{.from = {plate, {0, 1}},
                            .to = {ground, {0, 2}},
                            .stiffness = 8.0,
                            .damping = 2.0,
                            .free_length = free_length});
    return system;
  }
};

TEST_F(ZeroLengthTest, HasNoForceBecauseItHasNoDirection) {
  for (const double free_length : {0.0, 1.0}) {
    LoadedModel model(make(free_length));
    EXPECT_EQ(largest(model.conservative), 0.0);
    EXPECT_EQ(largest(model.dissipative), 0.0);
    EXPECT_EQ(model.energies()[StoredEnergy::elastic], 2 * 4.0 * free_length * free_length);
  }
}

TEST_F(ZeroLengthTest, DerivativesAreThoseOfTheForceThere) {
  for (const double free_length : {0.0, 1.0}) {
    const LoadedModel model(make(free_length));
    for (Index element = 0; element < 2; ++element) {
      const EvaluationContext at{model.assembly, model.state.view(), model.evaluation, element};
      std::vector<LoadDerivative> entries;
      model.assembly.force_kinds()[0]->derivatives(at, element, entries);
      for (const LoadDerivative& entry : entries) {
        EXPECT_EQ(entry.by_velocity, 0.0);
        EXPECT_TRUE(std::isfinite(entry.by_position));
        if (free_length > 0.0) {
          EXPECT_EQ(entry.by_position, 0.0);
        } else if (entry.row == entry.column && element == 0) {
          EXPECT_EQ(entry.by_position, -8.0);
        }
      }
    }
  }
}

TEST_F(ZeroLengthTest, WithoutFreeLengthTheForceIsLinearThroughZero) {
  using namespace planar;
  for (const double distance : {1e-3, 1e-9, 1e-100, -1e-100}) {
    System system;
    const BodyId body = system.add(Particle{.mass = 1.0, .position = {distance, 0}});
    system.add(SpringDamper{.from = ground, .to = body, .stiffness = 8.0});
    EXPECT_NEAR(LoadedModel(system).conservative[0] / distance, -8.0, 32 * epsilon);
  }
}

TEST(SpringDamper, ManyAtOnceAreTheSameBitsAsTwoByTwo) {
  // Long ranges go four by four where the processor can; ranges of two never do. 23 springs leave a pair and
  // one over; some bodies are shared by neighbouring springs, one spring has no length, properties vary.
  Random random(71);
  for (const bool alike : {false, true}) {
    System system;
    std::vector<BodyId> ids;
    const Vec<2> start(0.3, -0.2);
    for (int i = 0; i < 10; ++i) {
      const bool at_start = i == 0 || i == 9;
      const Vec<2> elsewhere(random.uniform(-1, 1), random.uniform(-1, 1));
      ids.push_back(system.add(planar::Particle{.mass = 1.0,
                                                .position = at_start ? start : elsewhere,
                                                .velocity = {random.uniform(-1, 1), random.uniform(-1, 1)}}));
    }
    constexpr Index springs = 23;
    for (Index i = 0; i < springs; ++i) {
      const std::size_t from = i == 5 ? 0 : i / 4, to = i == 5 ? 9 : from + 1 + i % 3;
      system.add(planar::SpringDamper{.from = ids[from],
                                      .to = ids[to],
                                      .stiffness = alike ? 300.0 : random.uniform(0, 1000),
                                      .damping = alike ? 2.0 : random.uniform(0, 10),
                                      .free_length = alike ? 0.7 : random.uniform(0, 1)});
    }
    LoadedModel model(std::move(system));
    const ForceKind& kind = *model.assembly.force_kinds()[0];
    const EvaluationContext at{model.assembly, model.state.view(), model.evaluation, 0};
    const std::size_t size = model.state.v.size();
    for (const bool by_cause : {false, true}) {
      std::vector<double> all(size), pairs(size), plain(size);
      std::vector<double> all_losses(size), pair_losses(size), plain_losses(size);
      const auto loads = [&](std::vector<double>& total, std::vector<double>& losses) {
        return Loads{total.data(), by_cause ? losses.data() : total.data(), total.data()};
      };
      const double potential = kind.evaluate_with_potential(at, {0, springs}, loads(all, all_losses));
      kind.evaluate(at, {0, springs}, loads(plain, plain_losses));
      double sum = 0.0;
      for (Index i = 0; i < springs; i += 2) {
        sum += kind.evaluate_with_potential(at, {i, std::min(i + 2, springs)}, loads(pairs, pair_losses));
      }
      EXPECT_EQ(all, pairs);
      EXPECT_EQ(all_losses, pair_losses);
      EXPECT_EQ(all, plain);
      EXPECT_EQ(all_losses, plain_losses);
      EXPECT_GT(largest(all), 1.0);
      EXPECT_NEAR(potential, sum,
                  springs * epsilon * sum);  // the sum over pairs is rounded in every addition
    }
  }
}

TEST(SpringDamper, WithoutStiffnessOrDampingDoesNothing) {
  using namespace planar;
  System system;
  const BodyId body = system.add(Particle{.mass = 1.0, .position = {1, 1}, .velocity = {1, 1}});
  system.add(SpringDamper{.from = ground, .to = body});
  LoadedModel model(system);
  EXPECT_EQ(largest(model.conservative), 0.0);
  EXPECT_EQ(largest(model.dissipative), 0.0);
  EXPECT_EQ(model.energies().potential(), 0.0);
}

TEST(SpringDamper, InSpaceForceAndDerivativesMeetDifferences) {
  using spatial::Particle, spatial::SpringDamper;
  Random random(128);
  for (int repeat = 0; repeat < 20; ++repeat) {
    System system;
    const BodyId a =
        system.add(Particle{.mass = 1.0, .position = random.vec<3>(), .velocity = random.vec<3>()});
    const BodyId b = system.add(
        Particle{.mass = 1.0, .position = Vec<3>(4, 0, 0) + random.vec<3>(), .velocity = random.vec<3>()});
    const bool anchored = repeat % 2 == 0;
    system.add(SpringDamper{.from = anchored ? End<3>(ground, random.vec<3>()) : End<3>(a),
                            .to = b,
                            .stiffness = random.uniform(0.5, 5.0),
                            .damping = 0.7,
                            .free_length = 1.5});
    LoadedModel model(system);
    expect_loads_near(model.conservative, model.minus_gradient(), 1e-10);
    expect_derivatives_meet_differences(model);
  }
}

}  // namespace
