// How fast may the fixed-point iteration contract? rho(h) = (h^2/4) |M^-1 K| + (h/2) |M^-1 C|.

#include <carom/carom.h>
#include <carom/core/assembly.h>
#include <carom/core/dynamics/coupling_rating.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

struct Rated {
  explicit Rated(const System& system, double step) : assembly(system) {
    const State state = assembly.initial_state();
    Evaluation evaluation = make_evaluation(assembly);
    for (Index component = 0; component < assembly.components().size(); ++component) {
      evaluate_positions(assembly, component, state.view(), evaluation);
      ratings.push_back(rate_couplings(assembly, component, state.view(), evaluation, step));
    }
  }
  Assembly assembly;
  std::vector<CouplingRating> ratings;
};

System pair(double stiffness, double damping, double m1 = 1.0, double m2 = 1.0, double distance = 2.0) {
  System system;
  const BodyId a = system.add(Particle{.mass = m1});
  const BodyId b = system.add(Particle{.mass = m2, .position = {distance, 0.0}});
  system.add(SpringDamper{.from = a, .to = b, .stiffness = stiffness, .damping = damping, .free_length = 2.0},
             "spring");
  return system;
}

constexpr double h = 1e-3;

TEST(CouplingRating, SpringBetweenTwoMasses) {
  // Rows of M^-1 K along the axis: (k/m, -k/m), sum 2 k/m for equal masses; the smaller mass decides.
  EXPECT_DOUBLE_EQ(Rated(pair(1000.0, 0.0), h).ratings[0].rate, 0.25 * h * h * 2000.0);
  EXPECT_DOUBLE_EQ(Rated(pair(1000.0, 0.0, 0.25, 4.0), h).ratings[0].rate, 0.25 * h * h * 8000.0);
  EXPECT_DOUBLE_EQ(Rated(pair(0.0, 7.0), h).ratings[0].rate, 0.5 * h * 14.0);
  EXPECT_DOUBLE_EQ(Rated(pair(1000.0, 7.0), h).ratings[0].rate, 0.25 * h * h * 2000.0 + 0.5 * h * 14.0);
}

TEST(CouplingRating, StepAtWhichItContracts) {
  // rho(h) = 1/2: h = sqrt(2/(k/m sum)) for a spring, 1/(c/m sum) for a dashpot, a root of both for both.
  EXPECT_DOUBLE_EQ(Rated(pair(1000.0, 0.0), h).ratings[0].contracting_step, std::sqrt(2.0 / 2000.0));
  EXPECT_DOUBLE_EQ(Rated(pair(0.0, 7.0), h).ratings[0].contracting_step, 1.0 / 14.0);
  const double step = Rated(pair(1000.0, 7.0), h).ratings[0].contracting_step;
  EXPECT_NEAR(0.25 * step * step * 2000.0 + 0.5 * step * 14.0, 0.5, 1e-15);
}

TEST(CouplingRating, NothingToContractWithoutCouplings) {
  System system;
  const BodyId body = system.add(Particle{.mass = 1.0});
  system.add(Gravity{{0.0, -9.81}});
  system.add(AppliedForce{.on = body, .force = [](double t) { return Vec<2>(t, 1.0); }});
  const CouplingRating rating = Rated(system, h).ratings[0];
  EXPECT_FALSE(rating.worst.valid());
  EXPECT_EQ(rating.rate, 0.0);
  EXPECT_EQ(rating.component_rate, 0.0);
  EXPECT_EQ(rating.contracting_step, 0.0);
}

TEST(CouplingRating, NamesTheWorstOfItsComponent) {
  System system = pair(10.0, 0.0);
  const BodyId c = system.add(Particle{.mass = 1.0, .position = {4.0, 0.0}});
  system.add(SpringDamper{.from = system.bodies()[1], .to = c, .stiffness = 500.0, .free_length = 2.0},
             "stiff");
  // Another component: does not count here.
  const BodyId d = system.add(Particle{.mass = 1.0, .position = {9.0, 0.0}});
  system.add(SpringDamper{.from = ground, .to = d, .stiffness = 1e6, .free_length = 1.0}, "elsewhere");
  const Rated rated(system, h);
  ASSERT_EQ(rated.ratings.size(), 2u);
  EXPECT_EQ(rated.ratings[0].worst, system.element("stiff"));
  EXPECT_DOUBLE_EQ(rated.ratings[0].rate, 0.25 * h * h * 1000.0);
  // Row of the middle mass: 10 + 500 + 510.
  EXPECT_DOUBLE_EQ(rated.ratings[0].component_rate, 0.25 * h * h * 1020.0);
  EXPECT_DOUBLE_EQ(rated.ratings[0].contracting_step, std::sqrt(2.0 / 1020.0));
  EXPECT_EQ(rated.ratings[1].worst, system.element("elsewhere"));
}

TEST(CouplingRating, AnglesAreWeighedByTheRadiusOfGyration) {
  // A spring across the end of a lever a turns the body: K = [k, k a; k a, k a^2]; with the angle weighed by
  // rho = sqrt(I/m): rows k/m (1 + a/rho) and k/m (a/rho + a^2/rho^2).
  System system;
  const BodyId body = system.add(RigidBody{.mass = {.mass = 2.0, .inertia = 0.5}});
  constexpr double k = 300.0, a = 1.5, rho = 0.5;
  system.add(
      SpringDamper{.from = {ground, {a, -1.0}}, .to = {body, {a, 0.0}}, .stiffness = k, .free_length = 1.0});
  const CouplingRating rating = Rated(system, h).ratings[0];
  EXPECT_NEAR(rating.rate, 0.25 * h * h * k / 2.0 * (a / rho + a * a / (rho * rho)), 1e-15);
}

/// A spring to the origin as a user would write it, without derivatives.
struct Magnet {
  static constexpr Role role = Role::force;
  static constexpr int dimension = 2;
  BodyId body;
  double stiffness = 0.0, damping = 0.0;
  std::vector<BodyId> bodies() const { return {body}; }
  void loads(const ElementView<2>& at, ElementLoads<2>& out) const {
    out.conservative(body, -stiffness * at.position(body));
    out.dissipative(body, -damping * at.velocity(body));
  }
  double potential(const ElementView<2>& at) const {
    return 0.5 * stiffness * at.position(body).squaredNorm();
  }
};

TEST(CouplingRating, UsersElementsAreRatedByDifferences) {
  System system;
  const BodyId body = system.add(Particle{.mass = 0.5, .position = {1.0, 2.0}});
  system.add(Magnet{.body = body, .stiffness = 400.0, .damping = 3.0});
  const CouplingRating rating = Rated(system, h).ratings[0];
  const double expected = 0.25 * h * h * 800.0 + 0.5 * h * 6.0;
  EXPECT_NEAR(rating.rate, expected, 1e-8 * expected);  // differences are good to about 1e-10
  EXPECT_EQ(rating.worst, system.elements()[0]);
}

TEST(CouplingRating, PredictsTheObservedContraction) {
  // Along the axis the bound is attained: the vibration is the eigenvector of the largest row sum.
  for (const auto& [stiffness, damping] : {std::pair{1000.0, 0.0}, {0.0, 50.0}, {4e5, 0.0}}) {
    Simulation simulation(pair(stiffness, damping, 1.0, 1.0, 2.1), TimeStepping{.step = h});
    simulation.step();
    State moving = simulation.state();
    moving.v = {1.0, 0.0, -1.0, 0.0};
    simulation.set_state(moving);
    simulation.step();
    const double rate = 0.25 * h * h * 2.0 * stiffness + 0.5 * h * 2.0 * damping;
    // The last two changes clear of rounding.
    EXPECT_NEAR(simulation.report().contraction, rate, 0.02 * rate) << stiffness << " " << damping;
  }
}

TEST(CouplingRating, FindsTheElementThatIsNotFinite) {
  System system = pair(1.0, 0.0);
  const BodyId body = system.bodies()[0];
  system.add(AppliedForce{.on = body, .force = [](double) { return Vec<2>(1.0, 0.0); }}, "good");
  const ElementId bad = system.add(
      AppliedForce{
          .on = body,
          .force =
              [](double t) { return Vec<2>(0.0, t > 1.0 ? std::numeric_limits<double>::quiet_NaN() : 0.0); }},
      "bad");
  const Assembly assembly(system);
  State state = assembly.initial_state();
  Evaluation evaluation = make_evaluation(assembly);
  evaluate_positions(assembly, 0, state.view(), evaluation);
  EXPECT_FALSE(find_non_finite(assembly, 0, state.view(), evaluation).valid());
  state.time = 2.0;
  EXPECT_EQ(find_non_finite(assembly, 0, state.view(), evaluation), bad);
}

}  // namespace
