#pragma once

/// \file
/// Planar contacts by brute force in 113-bit arithmetic: every mode solved and tested as it is written in the
/// law, without a thought for rounding. The judge of the library's closed forms, and of its lists.

#include <carom/contact/solvers/contact_problem.h>

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace carom::contact_test {

#if defined(__SIZEOF_FLOAT128__)
__extension__ typedef __float128 Quad;
#else
typedef long double Quad;
#endif

inline Quad magnitude(Quad x) { return x < 0 ? -x : x; }

/// A mode of a contact and how firmly it holds.
struct QuadMode {
  int kind = 0;         ///< 0 open, 1 stick, 2 slip+, 3 slip-
  bool exists = false;  ///< its equations could be solved
  Quad normal = 0, tangential = 0;
  Quad xi_n = 0, xi_t = 0;
  Quad margin = 0;     ///< smallest of its conditions, each relative to its terms; a solution if >= 0
  Quad condition = 1;  ///< (W_nn + mu |W_nt|) / |W_nn -+ mu W_nt| for slip
};

/// The four modes of  xi = W P + b.
inline std::vector<QuadMode> quad_modes(double w_nn, double w_nt, double w_tt, double b_n, double b_t,
                                        double mu) {
  const Quad a = w_nn, c = w_nt, d = w_tt, bn = b_n, bt = b_t, m = mu;
  const auto ratio = [](Quad value, Quad scale) { return scale > 0 ? value / scale : Quad(0); };
  const Quad b_scale = std::max(magnitude(bn), magnitude(bt));
  const Quad s_scale = magnitude(bt) * (a + m * magnitude(c)) + magnitude(bn) * (magnitude(c) + m * d);
  std::vector<QuadMode> modes(4);

  QuadMode& open = modes[0];
  open.exists = true;
  open.xi_n = bn;
  open.xi_t = bt;
  open.margin = ratio(bn, b_scale);

  QuadMode& stick = modes[1];
  stick.kind = 1;
  const Quad determinant = a * d - c * c;
  stick.exists = determinant > 0;
  if (stick.exists) {
    stick.normal = (c * bt - d * bn) / determinant;
    stick.tangential = (c * bn - a * bt) / determinant;
    const Quad room = std::min(m * stick.normal - stick.tangential, m * stick.normal + stick.tangential);
    stick.margin = std::min(ratio(room * determinant, s_scale), determinant / (a * d));
    // Implied by the two others unless there is no friction.
    if (stick.normal < 0) {
      stick.margin =
          std::min(stick.margin, stick.normal * determinant / (magnitude(c * bt) + magnitude(d * bn)));
    }
    stick.condition = a * d / determinant;
  }

  for (int k = 2; k < 4; ++k) {
    QuadMode& slip = modes[static_cast<std::size_t>(k)];
    slip.kind = k;
    const Quad s = k == 2 ? 1 : -1;
    const Quad p = a - s * m * c;
    slip.exists = p < 0 || p > 0;
    if (!slip.exists) {
      // The impulse is infinite here; how near is the mode when p is slightly positive, slightly negative?
      const Quad infinite = ratio(s * (c - s * m * d) * bn, s_scale);
      slip.margin = std::max(std::min({-ratio(bn, b_scale), Quad(0), -infinite}),
                             std::min({ratio(bn, b_scale), Quad(0), infinite}));
      continue;
    }
    slip.normal = -bn / p;
    slip.tangential = -s * m * slip.normal;
    slip.xi_t = bt + c * slip.normal + d * slip.tangential;
    const Quad p_ratio = magnitude(p) / (a + m * magnitude(c));
    slip.margin = std::min(
        {ratio(slip.normal * magnitude(p), b_scale), p_ratio, ratio(s * slip.xi_t * magnitude(p), s_scale)});
    slip.condition = 1 / p_ratio;
  }
  return modes;
}

/// Whether two modes give the same impulses (a boundary reached from both sides).
inline bool same_impulse(const QuadMode& a, const QuadMode& b, Quad relative) {
  const Quad size = std::max({magnitude(a.normal), magnitude(b.normal), magnitude(a.tangential)});
  return magnitude(a.normal - b.normal) <= relative * size &&
         magnitude(a.tangential - b.tangential) <= relative * size;
}

/// All solutions of a problem of planar contacts, as far as they hold firmly.
struct QuadList {
  std::vector<std::vector<Quad>> impulses;  ///< of solutions whose every condition holds by `firm`
  bool firm = true;                         ///< false: some set of modes is neither a solution nor refuted
};

/// Solves A x = r (row-major, n x n) with complete pivoting; false where pivots differ by more than 1e6.
inline bool quad_solve(std::vector<Quad> a, std::vector<Quad> r, std::vector<Quad>& x) {
  const std::size_t n = r.size();
  std::vector<std::size_t> order(n);
  for (std::size_t i = 0; i < n; ++i) order[i] = i;
  Quad first = 0;
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t row = k, column = k;
    for (std::size_t i = k; i < n; ++i) {
      for (std::size_t j = k; j < n; ++j) {
        if (magnitude(a[i * n + j]) > magnitude(a[row * n + column])) {
          row = i;
          column = j;
        }
      }
    }
    for (std::size_t j = 0; j < n; ++j) std::swap(a[k * n + j], a[row * n + j]);
    for (std::size_t i = 0; i < n; ++i) std::swap(a[i * n + k], a[i * n + column]);
    std::swap(r[k], r[row]);
    std::swap(order[k], order[column]);
    if (k == 0) first = magnitude(a[0]);
    if (!(magnitude(a[k * n + k]) > Quad(1e-6) * first)) return false;
    for (std::size_t i = k + 1; i < n; ++i) {
      const Quad factor = a[i * n + k] / a[k * n + k];
      for (std::size_t j = k; j < n; ++j) a[i * n + j] -= factor * a[k * n + j];
      r[i] -= factor * r[k];
    }
  }
  x.assign(n, 0);
  for (std::size_t k = n; k-- > 0;) {
    Quad sum = r[k];
    for (std::size_t j = k + 1; j < n; ++j) sum -= a[k * n + j] * x[order[j]];
    x[order[k]] = sum / a[k * n + k];
  }
  return true;
}

/// Tries all sets of modes of a problem whose groups are a normal row with one friction row, bounded or
/// proportional, entries of W of order one. A condition holds, or fails, if it does by `margin` of the
/// largest impulse, or of the largest velocity that it or b could cause.
inline QuadList quad_solutions(const ContactProblem& problem, double margin) {
  const auto n = static_cast<std::size_t>(problem.rows()), groups = n / 2;
  const auto w = [&](std::size_t i, std::size_t j) { return Quad(problem.matrix()[i * n + j]); };
  QuadList list;
  std::vector<int> mode(groups, 0);  // 0 open, 1 stick, 2 slip+, 3 slip-, 4 sliding as told
  const auto last_of = [&](std::size_t g) { return problem.sets()[2 * g + 1].kind == SetKind::proportional; };
  for (;;) {
    // The law, row by row: either an impulse is given by the normal one, or a velocity is zero.
    std::vector<Quad> a(n * n, 0), r(n, 0), p, xi(n);
    for (std::size_t g = 0; g < groups; ++g) {
      const std::size_t i = 2 * g;
      const Quad c = problem.sets()[i + 1].coefficient;
      for (std::size_t k = i; k < i + 2; ++k) {
        const bool velocity = k == i ? mode[g] != 0 : mode[g] == 1;
        for (std::size_t j = 0; j < n && velocity; ++j) a[k * n + j] = w(k, j);
        if (velocity) r[k] = -Quad(problem.vector()[k]);
        if (velocity) continue;
        a[k * n + k] = 1;
        if (k > i && mode[g] > 1) a[k * n + i] = mode[g] == 2 ? c : -c;
      }
    }
    if (quad_solve(a, r, p)) {
      Quad largest = 0, worst = 1e300;
      for (std::size_t i = 0; i < n; ++i) {
        xi[i] = problem.vector()[i];
        for (std::size_t j = 0; j < n; ++j) xi[i] += w(i, j) * p[j];
        largest = std::max({largest, magnitude(p[i]), magnitude(Quad(problem.vector()[i]))});
      }
      for (std::size_t g = 0; g < groups; ++g) {
        const std::size_t i = 2 * g;
        const Quad room = problem.sets()[i + 1].coefficient * p[i] - magnitude(p[i + 1]);
        if (mode[g] == 0) worst = std::min(worst, xi[i]);
        if (mode[g] != 0) worst = std::min(worst, p[i]);
        if (mode[g] == 1) worst = std::min(worst, room);
        if (mode[g] == 2) worst = std::min(worst, xi[i + 1]);
        if (mode[g] == 3) worst = std::min(worst, -xi[i + 1]);
      }
      if (worst > margin * largest) list.impulses.push_back(p);
      if (magnitude(worst) <= margin * largest) list.firm = false;
    } else {
      list.firm = false;
    }
    std::size_t g = 0;
    for (; g < groups; ++g) {
      mode[g] = last_of(g) ? 4 - mode[g] : (mode[g] + 1) % 4;
      if (mode[g] != 0) break;
    }
    if (g == groups) return list;
  }
}

}  // namespace carom::contact_test
