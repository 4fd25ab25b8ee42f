#pragma once

/// \file
/// Loops over the bodies of one kind, for the rule of a step: everything that is done with a number is done
/// while it is at hand. Templates over how the masses of a kind lie in memory (BodyMasses).

#include <carom/core/body_kind.h>
#include <carom/core/export.h>
#include <carom/integrators/time_stepping/step_rule.h>

namespace carom {

/// Arrays of a sweep, beginning with the first body of a range.
struct SweepArrays {
  const double* q0 = nullptr;        ///< coordinates at the start
  const double* v0 = nullptr;        ///< velocities at the start
  const float* carried = nullptr;    ///< compensation of the velocities: their rounding errors
  const double* load0 = nullptr;     ///< loads at the start
  const double* load1 = nullptr;     ///< loads at the end, as guessed
  const double* response = nullptr;  ///< change of velocity by impulses, null without any
  double* q1 = nullptr;              ///< out: coordinates at the end
  double* v1 = nullptr;              ///< out: velocities at the end
  float* cut = nullptr;              ///< out: rounding error of v1
  bool rational_turn = false;        ///< turn by 2 atan(h w/2) instead of h w
};

/// Arrays of the loads before and after a sweep, beginning with the first body of a range.
struct LoadArrays {
  const double* made_with = nullptr;  ///< x
  const double* led_to = nullptr;     ///< g
  const double* q1 = nullptr;         ///< coordinates the sweep led to
  const double* v1 = nullptr;         ///< velocities the sweep led to
};

/// v1 = v0 + M^-1 h (load0 + load1)/2 + response,   q1 = q0 advanced by h (v0 + v1)/2, of `count` bodies.
CAROM_API void sweep_bodies(const BodyMasses& masses, Index count, double step, const SweepArrays& arrays);
/// Change that another sweep, with g instead of x, would make: `weight` h M^-1 (g - x).
CAROM_API void add_next_change(const BodyMasses& masses, Index count, double weight, double step,
                               const LoadArrays& loads, SweepChange& change);

}  // namespace carom
