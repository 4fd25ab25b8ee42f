#pragma once

/// \file
/// Random contact problems in factors, the same on every machine for the same seed.

#include <carom/contact/solvers/contact_problem.h>

#include "tests/contact/random_problems.h"

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace carom::contact_test {

/// Contacts between random bodies of the plane, in factors.
struct FactorOptions {
  int contacts = 8;
  int bodies = 6;
  double lever = 1.0;        ///< largest, against a radius of gyration of about 1
  double friction = 0.3;     ///< largest coefficient
  double ground = 0.3;       ///< share of contacts with the ground
  double mass_ratio = 10.0;  ///< of the heaviest to the lightest body
};

inline ContactProblem random_factors(std::uint64_t seed, const FactorOptions& options) {
  Random random(seed);
  ContactProblem problem;
  problem.reset_factors(2 * options.contacts, options.bodies);
  for (std::size_t slot = 0; slot < static_cast<std::size_t>(options.bodies); ++slot) {
    const double mass = random.log_uniform(1.0, options.mass_ratio);
    double* const inverse = problem.factors().inverse_mass.data() + 3 * slot;
    inverse[0] = inverse[1] = 1.0 / mass;
    inverse[2] = 1.0 / (mass * random.uniform(0.5, 1.5));
  }
  for (int c = 0; c < options.contacts; ++c) {
    const double angle = random.uniform(-3.14159, 3.14159);
    const double n[2] = {std::cos(angle), std::sin(angle)}, t[2] = {n[1], -n[0]};
    const auto first = static_cast<std::size_t>(2 * c);
    const int a = c < options.bodies ? c : random.integer(0, options.bodies - 1);
    const bool alone = random.chance(options.ground);
    for (std::size_t i = 0; i < (alone ? 1u : 2u); ++i) {
      const double sign = i == 0 ? 1.0 : -1.0, x = options.lever * random.uniform(-1.0, 1.0),
                   y = options.lever * random.uniform(-1.0, 1.0);
      for (std::size_t row = 0; row < 2; ++row) {
        const double* const d = row == 0 ? n : t;
        ResponseFactors::Row& to = problem.factors().rows[first + row];
        to.slot[i] = i == 0 ? a : (a + 1) % options.bodies;
        to.h[3 * i] = sign * d[0];
        to.h[3 * i + 1] = sign * d[1];
        to.h[3 * i + 2] = sign * (x * d[1] - y * d[0]);
      }
    }
    problem.vector()[first] = random.uniform(-1.0, 0.3);
    problem.vector()[first + 1] = random.uniform(-1.0, 1.0);
    problem.sets()[first + 1] = {.kind = SetKind::bounded_interval,
                                 .bound = static_cast<int>(first),
                                 .coefficient = random.uniform(0.0, options.friction)};
  }
  problem.group();
  return problem;
}

}  // namespace carom::contact_test
