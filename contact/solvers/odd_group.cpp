// Problem: the few contacts of a large problem that no formula fits.

#include <carom/contact/solvers/odd_group.h>

#include <carom/contact/solvers/single_contact.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom {

namespace {

constexpr std::size_t columns = ResponseFactors::columns;

double along(const OddGroup& odd, std::size_t row, const SlotVelocity* velocity) {
  double sum = 0.0;
  for (std::size_t i = 0; i < odd.slot.size(); ++i) {
    const SlotVelocity& u = velocity[odd.slot[i]];
    for (std::size_t k = 0; k < columns; ++k) sum += odd.h[row][columns * i + k] * u.v[k];
  }
  return sum + odd.b[row];
}

// Impulse within bounds that ends a velocity xi; the bound that it drives at where nothing moves.
double clamped(double impulse, double w, double xi, double lower, double upper) {
  if (w > 0.0) return std::clamp(impulse - xi / w, lower, upper);
  const double bound = xi > 0.0 ? lower : (xi < 0.0 ? upper : impulse);
  return std::isfinite(bound) ? bound : impulse;
}

struct Impulses {
  double n = 0.0, t = 0.0;
};

// Whether there is a solution of a planar contact.
bool solve_planar(const OddGroup& odd, double xi_n, double xi_t, Impulses& p) {
  const PlanarSolutions found =
      solve_planar_contact({odd.w_nn, odd.w_nt, odd.w_tt, xi_n - odd.w_nn * p.n - odd.w_nt * p.t,
                            xi_t - odd.w_nt * p.n - odd.w_tt * p.t, odd.set[1].coefficient});
  if (found.count == 0) return false;
  if (found.count == 1) {
    p = {found.list[0].normal, found.list[0].tangential};
    return true;
  }
  double least = std::numeric_limits<double>::infinity();
  Impulses nearest;
  for (std::size_t i = 0; i < static_cast<std::size_t>(found.count); ++i) {
    const PlanarImpulse& one = found.list[i];
    const double distance = std::hypot(one.normal - p.n, one.tangential - p.t);
    if (!(distance < least)) continue;
    least = distance;
    nearest = {one.normal, one.tangential};
  }
  p = nearest;
  return true;
}

// The first row alone, with what is proportional to it.
void solve_leading(const OddGroup& odd, double xi_n, Impulses& p) {
  const bool half_line = odd.set[0].kind == SetKind::half_line;
  const double lower = half_line ? 0.0 : odd.set[0].lower;
  const double upper = half_line ? std::numeric_limits<double>::infinity() : odd.set[0].upper;
  if (odd.rows == 2 && odd.set[1].kind == SetKind::proportional) {
    const double ratio = odd.set[1].coefficient, w = odd.w_nn + ratio * odd.w_nt;
    const double b = xi_n - odd.w_nn * p.n - odd.w_nt * p.t;  // without its own impulses
    // More impulse closes it more where w < 0: open if it can be, else the impulse that others have to
    // change.
    if (w > 0.0) {
      p.n = std::clamp(-b / w, lower, upper);
    } else if (b + w * lower >= 0.0) {
      p.n = lower;
    }
    p.t = ratio * p.n;
    return;
  }
  p.n = clamped(p.n, odd.w_nn, xi_n, lower, upper);
}

/// Slots that answer together.
void push_bound(const OddGroup& odd, const std::array<double, 2>& impulse, SlotVelocity* velocity) {
  const ResponseFactors& factors = *odd.factors;
  for (std::size_t row = 0; row < static_cast<std::size_t>(odd.rows); ++row) {
    for (const ResponseFactors::Answer& answer : factors.answers(odd.first + row)) {
      const double* number = &factors.bound.numbers[answer.number];
      SlotVelocity* const u = velocity + answer.first_slot;
      for (std::size_t slot = 0; slot < answer.slots; ++slot, number += columns) {
        u[slot].v += Lanes{number[0], number[1], number[2], 0.0} * impulse[row];
      }
    }
  }
}

}  // namespace

void push(const OddGroup& odd, const std::array<double, 2>& impulse, SlotVelocity* velocity) {
  if (odd.factors != nullptr) push_bound(odd, impulse, velocity);
  for (std::size_t i = 0; i < odd.slot.size(); ++i) {
    if (odd.factors != nullptr && odd.factors->is_bound(static_cast<std::size_t>(odd.slot[i]))) continue;
    SlotVelocity& u = velocity[odd.slot[i]];
    for (std::size_t k = 0; k < columns; ++k) {
      u.v[k] += odd.h[0][columns * i + k] * impulse[0] + odd.h[1][columns * i + k] * impulse[1];
    }
  }
}

void solve(OddGroup& odd, SlotVelocity* velocity) {
  const double xi_n = along(odd, 0, velocity), xi_t = odd.rows == 2 ? along(odd, 1, velocity) : 0.0;
  Impulses p{odd.p[0], odd.p[1]};
  const bool planar =
      odd.rows == 2 && odd.set[0].kind == SetKind::half_line && odd.set[1].kind == SetKind::bounded_interval;
  if (!planar) {
    solve_leading(odd, xi_n, p);
  } else if (!solve_planar(odd, xi_n, xi_t, p)) {
    solve_leading(odd, xi_n, p);
    const double limit = odd.set[1].coefficient * p.n;
    p.t = clamped(odd.p[1], odd.w_tt, xi_t + odd.w_nt * (p.n - odd.p[0]), -limit, limit);
  }
  if (odd.rows == 2 && odd.set[0].kind == SetKind::interval && odd.set[1].kind == SetKind::bounded_interval) {
    const double limit = odd.set[1].coefficient * std::max(p.n, 0.0);
    p.t = clamped(odd.p[1], odd.w_tt, xi_t + odd.w_nt * (p.n - odd.p[0]), -limit, limit);
  }
  odd.g = {p.n - odd.p[0], p.t - odd.p[1]};
  odd.p = {p.n, p.t};
  push(odd, odd.g, velocity);
}

void judge(const OddGroup& odd, const SlotVelocity* velocity, double& error, double& size) {
  const double p_n = odd.p[0], xi_n = along(odd, 0, velocity), moved_n = p_n - odd.rho * xi_n;
  const bool half_line = odd.set[0].kind == SetKind::half_line;
  const double allowed =
      half_line ? std::max(moved_n, 0.0) : std::min(std::max(moved_n, odd.set[0].lower), odd.set[0].upper);
  double worst = std::abs(p_n - allowed), sum = xi_n + p_n;
  size = std::max(size, std::abs(p_n));
  if (odd.rows == 2) {
    const double p_t = odd.p[1], xi_t = along(odd, 1, velocity), moved_t = p_t - odd.rho * xi_t;
    const double limit = odd.set[1].coefficient * std::max(p_n, 0.0);
    const double of_set = odd.set[1].kind == SetKind::proportional
                              ? odd.set[1].coefficient * p_n
                              : std::min(std::max(moved_t, -limit), limit);
    worst = std::max(worst, std::abs(p_t - of_set));
    size = std::max(size, std::abs(p_t));
    sum += xi_t + p_t;
  }
  error = std::max(error, worst) + 0.0 * sum;  // carries a NaN along
}

}  // namespace carom
