// Problem: how far the normal impulse of one contact goes by the energetic law, and what friction does on the
// way. All is piecewise linear in it.

#include <carom/contact/solvers/impact_path.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace carom {

namespace {

constexpr double endless = std::numeric_limits<double>::infinity();

/// Numbers of the two rows with dry friction: the tangential one, and that of rolling resistance.
using Pair = std::array<double, 2>;

/// The rows with dry friction, as the normal impulse p drives them.
struct DryRows {
  Pair normal;                  // W_nt, W_nr
  std::array<double, 3> among;  // W_tt, W_tr, W_rr
  Pair bound;                   // mu, rho

  /// Rates of their velocities over p, for impulses dP = ratio dp.
  [[nodiscard]] Pair rates(const Pair& ratio) const {
    return {normal[0] + (among[0] * ratio[0] + among[1] * ratio[1]),
            normal[1] + (among[1] * ratio[0] + among[2] * ratio[1])};
  }
  [[nodiscard]] double diagonal(std::size_t row) const { return among[2 * row]; }
};

DryRows rows_of(const ImpactPathInput& in) {
  return {{in.wnt, in.wnr}, {in.wtt, in.wtr, in.wrr}, {in.friction, in.rolling_resistance}};
}

/// The ratio that keeps a row at rest beside a given one of the other row; 0 of a row that nothing moves.
double ratio_at_rest(const DryRows& rows, std::size_t row, double other) {
  const double diagonal = rows.diagonal(row);
  return diagonal > 0.0 ? -(rows.normal[row] + rows.among[1] * other) / diagonal : 0.0;
}

/// Ratios that keep both at rest; where the rows depend on each other the first one does it alone.
Pair ratios_at_rest(const DryRows& rows) {
  constexpr double dependent = 1e-14;  // of the product of the diagonals: rounding
  const double product = rows.among[0] * rows.among[2], off = rows.among[1] * rows.among[1];
  if (!(product - off > dependent * product)) {
    const double first = ratio_at_rest(rows, 0, 0.0);
    return {first, rows.among[0] > 0.0 ? 0.0 : ratio_at_rest(rows, 1, first)};
  }
  return {(rows.among[1] * rows.normal[1] - rows.among[2] * rows.normal[0]) / (product - off),
          (rows.among[1] * rows.normal[0] - rows.among[0] * rows.normal[1]) / (product - off)};
}

/// Way of a row over a stretch: moved against by its whole bound (-1, 1), or kept at rest (0).
using Ways = std::array<int, 2>;

/// Ratios by the ways of both rows.
Pair ratios_of(const DryRows& rows, const Ways& ways) {
  if (ways[0] == 0 && ways[1] == 0) return ratios_at_rest(rows);
  Pair ratio{};
  for (std::size_t row = 0; row < 2; ++row) ratio[row] = ways[row] * rows.bound[row];
  for (std::size_t row = 0; row < 2; ++row) {
    if (ways[row] == 0) ratio[row] = ratio_at_rest(rows, row, ratio[1 - row]);
  }
  return ratio;
}

/// By how much [m/s per N s] a row breaks its law: at rest beyond its bound, or moved the way that its
/// friction points.
double violation(const DryRows& rows, const Ways& ways, const Pair& ratio, const Pair& rate,
                 std::size_t row) {
  if (ways[row] != 0) return std::max(0.0, ways[row] * rate[row]);
  return rows.diagonal(row) * std::max(0.0, std::abs(ratio[row]) - rows.bound[row]);
}

/// A stretch of constant ratios dP/dp.
struct Stretch {
  Pair ratio{}, rate{};  // rate: of velocities over p
  double normal_rate = 0.0;
  Pair lengths{endless, endless};  // to velocity 0
  Ways ways{};
};

/// The stretch that begins at velocities of the dry rows. A row that moves is pushed against by its bound; of
/// those at rest the ways are tried, rest first. W is positive semidefinite, so that all ways that are
/// possible have the same rates.
Stretch stretch_from(const ImpactPathInput& in, const DryRows& rows, const Pair& velocity) {
  constexpr std::array<int, 3> to_try{0, -1, 1};
  Stretch best;
  double least = endless;
  for (const int first : to_try) {
    if (velocity[0] != 0.0 && first != (velocity[0] > 0.0 ? -1 : 1)) continue;
    for (const int second : to_try) {
      if (velocity[1] != 0.0 && second != (velocity[1] > 0.0 ? -1 : 1)) continue;
      const Ways ways{first, second};
      const Pair ratio = ratios_of(rows, ways), rate = rows.rates(ratio);
      double worst = 0.0;
      for (std::size_t row = 0; row < 2; ++row) {
        if (velocity[row] == 0.0) worst = std::max(worst, violation(rows, ways, ratio, rate, row));
      }
      if (!(worst < least)) continue;
      least = worst;
      best.ways = ways;
      best.ratio = ratio;
      best.rate = rate;
    }
  }
  best.normal_rate = in.wnn + rows.normal[0] * best.ratio[0] + rows.normal[1] * best.ratio[1];
  for (std::size_t row = 0; row < 2; ++row) {
    if (best.ways[row] == 0) best.rate[row] = 0.0;
    if (velocity[row] * best.rate[row] < 0.0) best.lengths[row] = -velocity[row] / best.rate[row];
  }
  return best;
}

/// Impulse after which gamma_n = 0 at a rate; infinite if never.
double length_to_rest(double normal, double rate) { return rate > 0.0 ? -normal / rate : endless; }

/// Impulse after which the work of expansion from gamma_n is `left` more. The root of
/// rate p^2/2 + normal p = left that is not negative.
double length_of_work(double normal, double rate, double left) {
  const double root = normal * normal + 2.0 * rate * left;
  if (root < 0.0) return endless;
  const double sum = normal + std::sqrt(root);
  return sum > 0.0 ? 2.0 * left / sum : (left > 0.0 ? endless : 0.0);
}

/// The way so far.
struct Path {
  double normal, impulse = 0.0;       // gamma_n, p
  Pair velocity;                      // of the dry rows
  Pair dry{};                         // their impulses
  double work = 0.0, returned = 0.0;  // of compression and of expansion
  bool compresses = true, sticks = false;

  /// Goes along a stretch, as far as p grows by `length`; `ends`: it ends the phase.
  void go(const Stretch& along, double length, bool ends) {
    const double next = ends && compresses ? 0.0 : normal + along.normal_rate * length;
    (compresses ? work : returned) += 0.5 * length * (normal + next);
    impulse += length;
    normal = next;
    for (std::size_t row = 0; row < 2; ++row) {
      dry[row] += along.ratio[row] * length;
      velocity[row] = along.lengths[row] <= length ? 0.0 : velocity[row] + along.rate[row] * length;
    }
    sticks = along.ways[0] == 0;
  }
  [[nodiscard]] ImpactPathEnd end() const {
    return {impulse, dry[0], normal, velocity[0], sticks, dry[1], velocity[1]};
  }
};

}  // namespace

std::optional<ImpactPathEnd> follow_impact(const ImpactPathInput& contact) {
  const DryRows rows = rows_of(contact);
  Path at{.normal = contact.normal, .velocity = {contact.tangential, contact.spin}};
  if (!(at.normal < 0.0)) return at.end();
  // Each row comes to rest once or twice in a phase; this is far more.
  constexpr int most_stretches = 32;
  for (int i = 0; i < most_stretches; ++i) {
    const Stretch along = stretch_from(contact, rows, at.velocity);
    const double left = contact.restitution * contact.restitution * -at.work - at.returned;
    const double to_end = at.compresses ? length_to_rest(at.normal, along.normal_rate)
                                        : length_of_work(at.normal, along.normal_rate, left);
    const double to_rest = std::min(along.lengths[0], along.lengths[1]);
    const bool ends = to_end <= to_rest;
    const double length = ends ? to_end : to_rest;
    if (!(length < endless)) return std::nullopt;
    at.go(along, length, ends);
    if (!ends) continue;
    if (!at.compresses || contact.restitution == 0.0) return at.end();
    at.compresses = false;
  }
  return std::nullopt;
}

}  // namespace carom
