#pragma once

/// \file
/// How the bodies of an island answer impulses, as one of the two makers of W has it.

#include <carom/contact/delassus.h>
#include <carom/contact/factor_maker.h>

#include <span>

namespace carom {

/// W of an island: in full, with the responses that it is made of, or left in factors.
struct IslandResponse {
  Delassus dense;       ///< made last, unless the factors are of bodies that answer for themselves
  FactorMaker factors;  ///< of large islands; else none

  /// x += scale B D^T P. \param impulses P, by row \param x velocities of all bodies
  void add(std::span<const double> impulses, double* x, double scale) const {
    factors.answer_alone() ? factors.add_response(impulses, x, scale)
                           : dense.add_response(impulses, x, scale);
  }
};

}  // namespace carom
