#pragma once

/// \file
/// One planar contact by brute force in 113-bit arithmetic: every mode solved and tested as it is written in
/// the law, without a thought for rounding. The judge of the library's closed form.

#include <algorithm>
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

}  // namespace carom::contact_test
