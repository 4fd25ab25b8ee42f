#pragma once

/// \file
/// When the gap of two bodies closes, in a span of time in which their motion can be looked at anywhere.
///
/// Such a gap is not a polynomial, even in free flight: the normal of two discs turns with the line between
/// their centres, and where the nearest feature of an outline changes the rate has a kink or a jump. No
/// closing is missed all the same: a gap is left alone only where its values at two looks and a bound of its
/// rate exclude zero between them; in free flight, where velocities of centres are linear in time and spins
/// constant, the bound is exact. Of two discs with radii of sum rho and centres d apart (d^2 - rho^2)/(2 rho)
/// is searched, which has the same zero and rate there and in free flight is a polynomial of degree 4 at
/// most.

#include <carom/contact/detection/contact_pair.h>
#include <carom/contact/detection/detector.h>
#include <carom/core/export.h>
#include <carom/core/numerics/step_polynomial.h>
#include <carom/integrators/event_driven/body_pair_bound.h>
#include <carom/integrators/event_driven/motion_sample.h>

namespace carom {

/// A pair of a vertex and an outline of two bodies, with the bounds of its gap.
struct PairGap {
  const Assembly& assembly;
  const Detector& detector;
  const ContactPair& pair;
  const BodyPairBound& bound;
};

/// The motion of two bodies in a span of time.
class CAROM_API PairPath {
public:
  virtual ~PairPath() = default;
  /// The motion at a time of the span. Valid until the next look.
  [[nodiscard]] virtual const MotionSample& sample(double time) = 0;
};

/// Gap of a pair at one time.
struct GapLook {
  double time = 0.0;          ///< [s]
  bool known = true;          ///< false: `gap` is a lower bound
  StepPolynomial::End gap{};  ///< with two derivatives
};

/// How a gap is searched.
struct ClosingRule {
  double noise = 0.0;         ///< rounding of gaps [m]
  double fine = 0.0;          ///< a gap this far off a polynomial still counts as found [m]
  double level = 0.0;         ///< a gap closes where it falls below this by the noise, <= 0 [m]
  double fastest = 0.0;       ///< bound of its rate [m/s]
  bool flies_freely = false;  ///< both bodies: nothing but constant fields acts
  double until = 0.0;         ///< later closings are of no interest [s]
};

/// True of a gap whose rate may have kinks, or that turns: it is searched by looks and a bound of its rate.
[[nodiscard]] CAROM_API bool has_kinks(const BodyPairBound& bound);
/// The gap of a pair in a sample, with two derivatives.
[[nodiscard]] CAROM_API StepPolynomial::End gap_in(const PairGap& of, const MotionSample& at);
/// (d^2 - rho^2)/(2 rho) by d - rho, with derivatives.
[[nodiscard]] CAROM_API StepPolynomial::End smooth_gap(const StepPolynomial::End& gap, double rho);
/// About the first time at which a gap closes between two looks; infinity: it does not.
[[nodiscard]] CAROM_API double first_closing(PairPath& path, const PairGap& of, const ClosingRule& rule,
                                             const GapLook& from, const GapLook& to);

}  // namespace carom
