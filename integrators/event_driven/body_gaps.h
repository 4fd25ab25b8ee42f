#pragma once

/// \file
/// Gaps of two bodies within a step: their values and rates, and when the first of them closes.
///
/// Such a gap is not a polynomial, even in free flight: the normal of two discs turns with the line between
/// their centres, and where the nearest feature of an outline changes the rate has a kink or a jump. No
/// closing is missed all the same: a gap is left alone only where its values at two looks and a bound of its
/// rate exclude zero between them; in free flight, where velocities of centres are linear in time and spins
/// constant, the bound is exact. Of two discs with radii of sum rho and centres d apart (d^2 - rho^2)/(2 rho)
/// is searched, which has the same zero and rate there and in free flight is a polynomial of degree 4 at
/// most.

#include <carom/core/export.h>
#include <carom/core/numerics/step_polynomial.h>
#include <carom/integrators/event_driven/event.h>
#include <carom/integrators/event_driven/searched_step.h>

#include <cstddef>
#include <span>

namespace carom {

/// The gap of a pair of two bodies in a sample, with two derivatives.
[[nodiscard]] CAROM_API StepPolynomial::End body_gap(const SmoothMotion& motion, std::size_t pair,
                                                     const MotionSample& at);

/// Samples the gaps of all pairs of two bodies that are open, or bounds of them, and of their rates. False if
/// one is not finite. \param is_active by pair
[[nodiscard]] CAROM_API bool sample_body_gaps(const SmoothMotion& motion, std::span<const char> is_active,
                                              const MotionSample& at, StepEnd& out);

/// The first closing before an event, else that event. \param passed_over by pair: not looked at
[[nodiscard]] CAROM_API Event predict_body_gap(SearchedStep& step, std::span<const char> passed_over,
                                               Event before);

}  // namespace carom
