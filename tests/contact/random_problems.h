#pragma once

/// \file
/// Random contact problems, the same on every machine for the same seed.

#include <carom/contact/solvers/contact_problem.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace carom::contact_test {

/// SplitMix64 (Steele, Lea, Flood 2014). Distributions of the standard library differ between compilers.
class Random {
public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(next() >> 11) * 0x1p-53);
  }
  /// Decades evenly.
  double log_uniform(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
  int integer(int low, int high) {
    return low + static_cast<int>(next() % static_cast<std::uint64_t>(high - low + 1));
  }
  bool chance(double probability) { return uniform(0.0, 1.0) < probability; }

private:
  std::uint64_t state_;
};

/// One planar impact in the notation of docs/method.md, sections 1 and 3.
struct Impact {
  double mass = 1.0, inertia = 1.0, r_x = 0.0, r_y = 0.0;  // contact from centre: r_x along t, r_y along n
  double x_minus = 0.0, y_minus = 0.0;                     // contact velocity before: tangential, normal
  double load_x = 0.0, load_y = 0.0, load_m = 0.0;         // impulses of all other loads
  double friction = 0.0, e_n = 0.0, e_t = 0.0;

  double w_tt() const { return 1.0 / mass + r_y * r_y / inertia; }
  double w_nn() const { return 1.0 / mass + r_x * r_x / inertia; }
  double w_nt() const { return -r_x * r_y / inertia; }
  double b_n() const { return (1.0 + e_n) * y_minus + load_y / mass + r_x * load_m / inertia; }
  double b_t() const { return (1.0 + e_t) * x_minus + load_x / mass - r_y * load_m / inertia; }
};

/// Problem with rows (normal, tangential).
inline void make_problem(double w_nn, double w_nt, double w_tt, double b_n, double b_t, double friction,
                         ContactProblem& problem) {
  problem.reset(2);
  problem.w(0, 0) = w_nn;
  problem.w(0, 1) = problem.w(1, 0) = w_nt;
  problem.w(1, 1) = w_tt;
  problem.vector()[0] = b_n;
  problem.vector()[1] = b_t;
  problem.sets()[1] = {.kind = SetKind::bounded_interval, .bound = 0, .coefficient = friction};
  problem.group();
}

inline void make_problem(const Impact& impact, ContactProblem& problem) {
  make_problem(impact.w_nn(), impact.w_nt(), impact.w_tt(), impact.b_n(), impact.b_t(), impact.friction,
               problem);
}

/// Masses over six decades, any offset, radius of gyration 1/1000 to 100 times the offset, mu in [0, 5], e in
/// [0, 1], a third with load impulses. One in eight has round numbers, so that boundaries are hit exactly.
inline Impact random_impact(std::uint64_t seed) {
  Random random(seed);
  Impact impact;
  const bool round = random.chance(0.125);
  const auto value = [&](double low, double high) {
    const double v = random.uniform(low, high);
    return round ? std::round(2.0 * v) / 2.0 : v;
  };
  impact.mass = round ? std::exp2(random.integer(-10, 10)) : random.log_uniform(1e-3, 1e3);
  impact.r_x = value(-1.0, 1.0);
  impact.r_y = value(-1.0, 1.0);
  const double gyration = round ? 1.0 : random.log_uniform(1e-3, 1e2) * std::hypot(impact.r_x, impact.r_y);
  impact.inertia = impact.mass * gyration * gyration;
  impact.friction = random.chance(0.05) ? 0.0 : value(0.0, random.chance(0.5) ? 1.0 : 5.0);
  impact.e_n = random.chance(0.1) ? 0.0 : value(0.0, 1.0);
  impact.e_t = random.chance(0.1) ? 0.0 : (random.chance(0.2) ? impact.e_n : value(0.0, 1.0));
  impact.x_minus = value(-5.0, 5.0);
  impact.y_minus = value(-5.0, random.chance(0.8) ? 0.0 : 5.0);
  if (random.chance(1.0 / 3.0)) {
    impact.load_x = impact.mass * value(-2.0, 2.0);
    impact.load_y = impact.mass * value(-2.0, 2.0);
    impact.load_m = impact.mass * gyration * value(-2.0, 2.0);
  }
  return impact;
}

/// Random problem, and the knowledge of it before it is solved.
struct RandomProblem {
  ContactProblem problem;
  int bodies = 0;
  int contacts = 0;
  bool existence_guaranteed =
      false;  // docs/method.md section 3: one common e and obstacles at rest, or no jam
  bool common_restitution = false;
  double restitution = 0.0;  // the common one
};

/// 2 to `most_contacts` planar contacts on one or more rigid bodies. Families: points of bodies on a floor
/// (impulses of the cones cannot cancel: a solution exists for any e); contacts with obstacles of any
/// direction and between bodies with one common e (a solution exists). With `jams` only contacts of any
/// direction, each with its own e: a solution need not exist. Masses over `decades` decades.
inline RandomProblem random_problem(std::uint64_t seed, int most_contacts, double decades = 3.0,
                                    bool jams = false) {
  Random random(seed);
  RandomProblem result;
  const bool floor = random.chance(0.5) && !jams;
  const bool equal = (!floor || random.chance(0.5)) && !jams;
  const int contacts = random.integer(2, most_contacts);
  const int bodies = random.integer(1, random.chance(0.5) ? 1 : contacts);
  result.bodies = bodies;
  result.contacts = contacts;
  result.existence_guaranteed = !jams;
  result.common_restitution = equal;

  const auto nb = static_cast<std::size_t>(bodies);
  std::vector<double> inverse_mass(3 * nb), velocity(3 * nb);
  for (std::size_t k = 0; k < nb; ++k) {
    const double half = std::pow(10.0, 0.5 * decades);
    const double mass = random.log_uniform(1.0 / half, half), gyration = random.log_uniform(0.1, 2.0);
    inverse_mass[3 * k] = inverse_mass[3 * k + 1] = 1.0 / mass;
    inverse_mass[3 * k + 2] = 1.0 / (mass * gyration * gyration);
    for (std::size_t i = 0; i < 3; ++i) velocity[3 * k + i] = random.uniform(-3.0, 3.0);
  }

  const std::size_t rows = 2 * static_cast<std::size_t>(contacts);
  std::vector<double> h(rows * 3 * nb, 0.0), e(rows);
  std::vector<double> mu(rows);
  const double common_e = random.chance(0.2) ? 0.0 : random.uniform(0.0, 1.0);
  result.restitution = common_e;
  const double common_mu = random.chance(0.1) ? 0.0 : random.uniform(0.0, random.chance(0.7) ? 1.0 : 5.0);
  const double height = random.uniform(-1.0, -0.2);
  const bool level = random.chance(0.3);
  for (std::size_t c = 0; c < static_cast<std::size_t>(contacts); ++c) {
    const double angle = floor ? 0.0 : random.uniform(-3.14159, 3.14159);
    const std::array<double, 2> n{-std::sin(angle), std::cos(angle)}, t{n[1], -n[0]};
    const auto add_body = [&](int body, double sign) {
      const double x = random.uniform(-1.0, 1.0);
      const double y = floor ? (level ? height : random.uniform(-1.0, -0.2)) : random.uniform(-1.0, 1.0);
      for (std::size_t k = 0; k < 2; ++k) {
        const auto& d = k == 0 ? n : t;
        double* out = h.data() + (2 * c + k) * 3 * nb + 3 * static_cast<std::size_t>(body);
        out[0] += sign * d[0];
        out[1] += sign * d[1];
        out[2] += sign * (x * d[1] - y * d[0]);
      }
    };
    // Every body gets a contact before one gets two.
    const int first = static_cast<int>(c) < bodies ? static_cast<int>(c) : random.integer(0, bodies - 1);
    add_body(first, 1.0);
    if (!floor && bodies > 1 && random.chance(0.6))
      add_body((first + random.integer(1, bodies - 1)) % bodies, -1.0);
    e[2 * c] = equal ? common_e : random.uniform(0.0, 1.0);
    e[2 * c + 1] = equal ? common_e : random.uniform(0.0, 1.0);
    mu[2 * c + 1] = random.chance(0.5) ? common_mu : random.uniform(0.0, 1.5);
  }

  ContactProblem& problem = result.problem;
  problem.reset(static_cast<int>(rows));
  for (std::size_t i = 0; i < rows; ++i) {
    double gamma = 0.0;
    for (std::size_t k = 0; k < 3 * nb; ++k) gamma += h[i * 3 * nb + k] * velocity[k];
    problem.vector()[i] = (1.0 + e[i]) * gamma;
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = 0.0;
      for (std::size_t k = 0; k < 3 * nb; ++k) sum += h[i * 3 * nb + k] * inverse_mass[k] * h[j * 3 * nb + k];
      problem.w(static_cast<int>(i), static_cast<int>(j)) = sum;
      problem.w(static_cast<int>(j), static_cast<int>(i)) = sum;
    }
    if (i % 2 == 1) {
      problem.sets()[i] = {
          .kind = SetKind::bounded_interval, .bound = static_cast<int>(i) - 1, .coefficient = mu[i]};
    }
  }
  problem.group();
  return result;
}

/// `groups` planar contacts, each of which slips in a known direction (proportional row) with probability
/// `sliding`, coefficients up to `most_friction`. W is of condition below 10 (eigenvalues of A A^T / n + 0.2
/// for A of random entries), so that every set of modes has a regular system for nearly all seeds.
inline ContactProblem random_sliding_problem(std::uint64_t seed, int groups, double sliding,
                                             double most_friction) {
  Random random(seed);
  const int rows = 2 * groups;
  const auto n = static_cast<std::size_t>(rows);
  std::vector<double> a(n * n);
  for (double& value : a) value = random.uniform(-1.0, 1.0);
  ContactProblem problem;
  problem.reset(rows);
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j <= i; ++j) {
      double sum = i == j ? 0.2 : 0.0;
      for (std::size_t k = 0; k < n; ++k) {
        sum += a[static_cast<std::size_t>(i) * n + k] * a[static_cast<std::size_t>(j) * n + k] /
               static_cast<double>(rows);
      }
      problem.w(i, j) = problem.w(j, i) = sum;
    }
    const auto row = static_cast<std::size_t>(i);
    problem.vector()[row] = random.uniform(-2.0, 2.0);
    if (i % 2 == 0) continue;
    const bool slides = random.chance(sliding);
    const double mu = random.uniform(0.0, most_friction);
    const double direction = random.chance(0.5) ? 1.0 : -1.0;
    problem.sets()[row] = {.kind = slides ? SetKind::proportional : SetKind::bounded_interval,
                           .bound = i - 1,
                           .coefficient = slides ? -direction * mu : mu};
  }
  problem.group();
  return problem;
}

}  // namespace carom::contact_test
