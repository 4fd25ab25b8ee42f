#pragma once

/// \file
/// A pile of discs in a box, stepped crudely: contacts from a grid, velocities from a problem in factors,
/// positions by Euler. It makes problems such as a large model asks of the solver, from the collapse to rest.

#include <carom/contact/solvers/solver_chain.h>

#include "tests/contact/random_problems.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace carom::contact_test {

/// Parameters of a pile.
struct PileOptions {
  int discs = 100;
  double width = 2.0;  ///< of the box [m]; the default holds 2,000 discs about a metre high
  double radius = 0.02;
  double friction = 0.3;
  double restitution = 0.0;  ///< of normal and tangential direction
  double gravity = 9.81;
  double speed = 0.1;  ///< largest at the start, each way [m/s]
  double step = 1e-3;
  std::uint64_t seed = 1;
};

/// Discs over the floor y = 0 between the walls x = 0 and x = width.
class DiscPile {
public:
  explicit DiscPile(const PileOptions& options) : options_(options) {
    Random random(options.seed);
    const double pitch = 2.3 * options.radius;
    const int columns = std::max(1, static_cast<int>((options.width - 2.0 * options.radius) / pitch));
    for (int i = 0; i < options.discs; ++i) {
      const int row = i / columns;
      x_.push_back(1.2 * options.radius + pitch * (i % columns) + random.uniform(0.0, 0.1 * options.radius));
      y_.push_back(1.2 * options.radius + pitch * row);
      r_.push_back(options.radius * random.uniform(0.8, 1.0));
      for (int k = 0; k < 3; ++k) v_.push_back(k < 2 ? random.uniform(-options.speed, options.speed) : 0.0);
    }
    for (const double r : r_) {
      const double mass = 1000.0 * 3.14159 * r * r;
      inverse_mass_.insert(inverse_mass_.end(), {1.0 / mass, 1.0 / mass, 2.0 / (mass * r * r)});
    }
  }

  /// Finds what touches, and writes the problem of the next step with impulses of the last one to start from.
  const ContactProblem& state() {
    find_contacts();
    const int rows = 2 * static_cast<int>(contacts_.size());
    problem_.reset_factors(rows, static_cast<int>(x_.size()));
    problem_.factors().inverse_mass = inverse_mass_;
    solution_.impulse.assign(static_cast<std::size_t>(rows), 0.0);
    for (std::size_t c = 0; c < contacts_.size(); ++c) write_rows(c);
    problem_.group();
    return problem_;
  }
  /// Solves it and moves on. \tparam Chain SolverChain, or what solves as it does
  template <class Chain>
  const ContactReport& advance(Chain& chain) {
    chain.solve(problem_, solution_);
    move();
    return solution_.report;
  }
  /// Moves on with the impulses of solution().
  void move() {
    for (std::size_t i = 0; i < x_.size(); ++i) v_[3 * i + 1] -= options_.gravity * options_.step;
    const double before = kinetic_energy();
    problem_.factors().respond(solution_.impulse, change_);
    for (std::size_t i = 0; i < v_.size(); ++i) v_[i] += change_[i];
    gain_ = kinetic_energy() - before;
    for (std::size_t i = 0; i < x_.size(); ++i) {
      x_[i] += options_.step * v_[3 * i];
      y_[i] += options_.step * v_[3 * i + 1];
    }
  }
  template <class Chain>
  const ContactReport& step(Chain& chain) {
    state();
    return advance(chain);
  }

  [[nodiscard]] const ContactProblem& problem() const { return problem_; }
  [[nodiscard]] const ContactSolution& solution() const { return solution_; }
  [[nodiscard]] ContactSolution& solution() { return solution_; }
  [[nodiscard]] std::span<const double> velocities() const { return v_; }
  [[nodiscard]] std::span<const double> heights() const { return y_; }
  /// Kinetic energy that the impulses of the last step added [J].
  [[nodiscard]] double gain() const { return gain_; }
  /// Kinetic energy [J].
  [[nodiscard]] double kinetic_energy() const {
    double sum = 0.0;
    for (std::size_t i = 0; i < v_.size(); ++i) sum += 0.5 * v_[i] * v_[i] / inverse_mass_[i];
    return sum;
  }

private:
  struct Contact {
    std::uint64_t key = 0;  // of the two bodies, or of body and wall
    int a = 0, b = 0;       // b < 0: ground
    std::array<double, 2> normal{};
  };

  void find_contacts() {
    before_.swap(contacts_);
    contacts_.clear();
    impulse_before_.swap(solution_.impulse);
    const double cell = 2.0 * options_.radius;
    const int columns = static_cast<int>(options_.width / cell) + 3;
    const double top = *std::max_element(y_.begin(), y_.end());
    const int rows = static_cast<int>(std::max(top, 0.0) / cell) + 3;
    const auto place = [&](std::size_t i) {
      const int column = std::clamp(static_cast<int>(x_[i] / cell) + 1, 1, columns - 2);
      const int row = std::clamp(static_cast<int>(y_[i] / cell) + 1, 1, rows - 2);
      return static_cast<std::size_t>(row * columns + column);
    };
    head_.assign(static_cast<std::size_t>(columns * rows), -1);
    next_.assign(x_.size(), -1);
    for (std::size_t i = x_.size(); i-- > 0;) {
      next_[i] = head_[place(i)];
      head_[place(i)] = static_cast<int>(i);
    }
    const std::uint64_t count = x_.size();
    for (std::size_t i = 0; i < x_.size(); ++i) {
      const auto ground = [&](double gap, std::uint64_t wall, double nx, double ny) {
        if (gap <= 0.0)
          contacts_.push_back({i * (count + 4) + count + wall, static_cast<int>(i), -1, {nx, ny}});
      };
      ground(y_[i] - r_[i], 0, 0.0, 1.0);
      ground(x_[i] - r_[i], 1, 1.0, 0.0);
      ground(options_.width - x_[i] - r_[i], 2, -1.0, 0.0);
      const int at = static_cast<int>(place(i));
      for (const int near : {at - columns - 1, at - columns, at - columns + 1, at - 1, at, at + 1,
                             at + columns - 1, at + columns, at + columns + 1}) {
        for (int j = head_[static_cast<std::size_t>(near)]; j >= 0; j = next_[static_cast<std::size_t>(j)]) {
          const auto other = static_cast<std::size_t>(j);
          if (other <= i) continue;
          const double dx = x_[i] - x_[other], dy = y_[i] - y_[other], reach = r_[i] + r_[other];
          const double square = dx * dx + dy * dy;
          if (square > reach * reach) continue;
          const double distance = std::sqrt(square);
          contacts_.push_back(
              {i * (count + 4) + other, static_cast<int>(i), j, {dx / distance, dy / distance}});
        }
      }
    }
    std::sort(contacts_.begin(), contacts_.end(),
              [](const Contact& a, const Contact& b) { return a.key < b.key; });
  }

  // Normal from b towards a, tangent: the normal turned clockwise.
  void write_rows(std::size_t c) {
    const Contact& at = contacts_[c];
    const double nx = at.normal[0], ny = at.normal[1], tx = ny, ty = -nx;
    const auto a = static_cast<std::size_t>(at.a);
    ResponseFactors::Row &n = problem_.factors().rows[2 * c], &t = problem_.factors().rows[2 * c + 1];
    // The contact is at -r n of a: lever x t = r.
    n.slot[0] = t.slot[0] = at.a;
    n.h = {nx, ny, 0.0};
    t.h = {tx, ty, r_[a]};
    if (at.b >= 0) {
      n.slot[1] = t.slot[1] = at.b;
      n.h[3] = -nx, n.h[4] = -ny;
      t.h[3] = -tx, t.h[4] = -ty, t.h[5] = r_[static_cast<std::size_t>(at.b)];
    }
    const auto velocity = [&](const ResponseFactors::Row& row, double free) {
      double sum = 0.0;
      for (std::size_t i = 0; i < 2 && row.slot[i] >= 0; ++i) {
        const double* const v = v_.data() + 3 * row.slot[i];
        sum += row.h[3 * i] * v[0] + row.h[3 * i + 1] * (v[1] - free * options_.gravity * options_.step) +
               row.h[3 * i + 2] * v[2];
      }
      return sum;
    };
    const double e = options_.restitution;
    problem_.vector()[2 * c] = velocity(n, 1.0) + e * velocity(n, 0.0);
    problem_.vector()[2 * c + 1] = velocity(t, 1.0) + e * velocity(t, 0.0);
    problem_.sets()[2 * c + 1] = {.kind = SetKind::bounded_interval,
                                  .bound = static_cast<int>(2 * c),
                                  .coefficient = options_.friction};
    const auto old = std::lower_bound(before_.begin(), before_.end(), at.key,
                                      [](const Contact& one, std::uint64_t key) { return one.key < key; });
    if (old == before_.end() || old->key != at.key) return;
    const auto from = static_cast<std::size_t>(2 * (old - before_.begin()));
    solution_.impulse[2 * c] = impulse_before_[from];
    solution_.impulse[2 * c + 1] = impulse_before_[from + 1];
  }

  PileOptions options_;
  std::vector<double> x_, y_, r_, v_, inverse_mass_, change_, impulse_before_;
  std::vector<Contact> contacts_, before_;
  std::vector<int> head_, next_;
  ContactProblem problem_;
  ContactSolution solution_;
  double gain_ = 0.0;
};

}  // namespace carom::contact_test
