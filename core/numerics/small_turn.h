#pragma once

/// \file
/// Cosine and sine of an angle that differs little from one of which they are known: for a tenth of the cost
/// of computing them anew.

#include <carom/core/numerics/pair.h>

namespace carom {

/// Largest difference of angles for small_turn() [rad].
inline constexpr double largest_small_turn = 0.1;

/// (cos(a + d), sin(a + d)) by (cos a, sin a), to the last digit: addition theorem with the Taylor series of
/// cos d - 1 and sin d, whose first terms left out, d^12/12! and d^11/11!, are below 3e-19. \param d at most
/// largest_small_turn in size
inline Pair small_turn(Pair known, double d) {
  constexpr double factorial3 = 6.0, factorial4 = 24.0, factorial5 = 120.0, factorial6 = 720.0,
                   factorial7 = 5040.0, factorial8 = 40320.0, factorial9 = 362880.0, factorial10 = 3628800.0;
  const Pair square = both(d * d);
  Pair sum{-1.0 / factorial10, 1.0 / factorial9};
  sum = Pair{1.0 / factorial8, -1.0 / factorial7} + square * sum;
  sum = Pair{-1.0 / factorial6, 1.0 / factorial5} + square * sum;
  sum = Pair{1.0 / factorial4, -1.0 / factorial3} + square * sum;
  sum = Pair{-0.5, 1.0} + square * sum;
  sum *= Pair{d * d, d};  // cos d - 1, sin d
  return known + (known * both(sum[0]) + Pair{-known[1], known[0]} * both(sum[1]));
}

}  // namespace carom
