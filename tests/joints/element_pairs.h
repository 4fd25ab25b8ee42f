#pragma once

// Two bodies at random places, for elements between two ends, and what every element must obey.

#include <carom/bodies/particle.h>
#include <carom/bodies/rigid_body.h>
#include <carom/core/end.h>
#include <carom/integrators/simulation.h>

#include "tests/energy/ledger_check.h"
#include "tests/random.h"
#include <carom/testing/loaded_model.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace carom_test {

using carom::energy_test::LoadedModel;

/// Two plates, two dots and a bystander before them, so that offsets are not zero; all moving.
struct Bodies {
  explicit Bodies(Random& random) {
    using namespace carom::planar;
    system.add(RigidBody{.mass = carom::planar::disc(1.0, 1.0)});
    const auto plate = [&](double x) {
      return system.add(RigidBody{.mass = carom::planar::disc(1.5, 0.8),
                                  .position = carom::Vec<2>(x, 0.0) + random.vec<2>(),
                                  .angle = random.uniform(-3.0, 3.0),
                                  .velocity = random.vec<2>(2.0),
                                  .spin = random.uniform(-2.0, 2.0)});
    };
    const auto dot = [&](double x) {
      return system.add(Particle{
          .mass = 0.7, .position = carom::Vec<2>(x, 0.0) + random.vec<2>(), .velocity = random.vec<2>(2.0)});
    };
    plates[0] = plate(0.0);
    plates[1] = plate(3.5);
    dots[0] = dot(0.0);
    dots[1] = dot(3.5);
  }

  carom::System system;
  carom::BodyId plates[2], dots[2];
};

/// Ends of every sort, at least half a metre apart: centres, points of plates, dots, the ground.
inline std::vector<std::pair<carom::End<2>, carom::End<2>>> pairs_of_ends(const Bodies& bodies,
                                                                          Random& random) {
  using carom::End;
  const auto point = [&] { return random.vec<2>(0.3); };
  const End<2> here(carom::ground, random.vec<2>());
  const End<2> there(carom::ground, carom::Vec<2>(3.5, 0.0) + random.vec<2>());
  return {{End<2>(bodies.plates[0], point()), End<2>(bodies.plates[1], point())},
          {bodies.plates[0], End<2>(bodies.plates[1], point())},
          {bodies.dots[0], End<2>(bodies.plates[1], point())},
          {bodies.dots[0], bodies.dots[1]},
          {here, End<2>(bodies.plates[1], point())},
          {bodies.plates[0], there},
          {here, bodies.dots[1]}};
}

inline void expect_near(const std::vector<double>& found, const std::vector<double>& expected,
                        double tolerance) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], expected[i], tolerance) << "at " << i;
}

inline double largest(const std::vector<double>& numbers) {
  double result = 0.0;
  for (const double x : numbers) result = std::max(result, std::abs(x));
  return result;
}

/// Sum of forces and sum of moments of each cause vanish (both ends on bodies).
inline void expect_action_is_reaction(const LoadedModel& model) {
  for (const auto* load : {&model.conservative, &model.dissipative, &model.external}) {
    const double tolerance = 1e-13 * (1.0 + largest(*load));  // levers are below 5 m
    for (const double sum : model.resultant(*load)) EXPECT_NEAR(sum, 0.0, tolerance);
  }
}

/// Runs a while: the ledger closes within round-off and nothing of the kinds left out flowed.
inline void expect_ledger_closes(const carom::System& system, double duration, double step = 1e-3) {
  carom::Simulation simulation(system, carom::TimeStepping{.step = step});
  simulation.run_until(duration);
  EXPECT_TRUE(ledger_closes(simulation.energy()));
  EXPECT_GE(simulation.energy().flow(carom::EnergyFlow::dashpot), 0.0);
}

/// Order of convergence at `duration` by three step lengths; `error` says how far a run ended from the truth.
template <class F>
double measured_order(const carom::System& system, double duration, double step, F&& error) {
  const auto run = [&](double h) {
    carom::Simulation simulation(system, carom::TimeStepping{.step = h});
    simulation.run_until(duration);
    return error(simulation);
  };
  return 0.5 * std::log2(run(step) / run(0.25 * step));
}

}  // namespace carom_test
