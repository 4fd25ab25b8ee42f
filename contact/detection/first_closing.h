#pragma once

/// \file
/// The first closing of a gap along a path: the only search for a gap that reaches a level.
///
/// A path is the motion of both sides of a pair in a span of time, which can be looked at anywhere: a step of
/// a flow, a flight, a chord, two steps of two groups. Along it a gap is not a polynomial, even in free
/// flight: the normal of two discs turns with the line between their centres, and where the nearest feature
/// of an outline changes the rate has a kink or a jump. No closing is missed all the same: a gap is left
/// alone only where its values at two looks and a bound of its rate exclude the level between them; in free
/// flight, where velocities of centres are linear in time and spins constant, the bound is exact. Of two
/// discs with radii of sum rho and centres d apart (d^2 - rho^2)/(2 rho) is searched, which has the same zero
/// and rate there and in free flight is a polynomial of degree 4 at most. Bounds are the caller's word:
/// one that is too small may hide a closing, and nothing says so.
///
/// Looks may be taken from an interpolation. The closing that they lead to is then found on the exact motion,
/// each look at which may cost much.

#include <carom/contact/detection/body_pair_bound.h>
#include <carom/contact/detection/contact_pair.h>
#include <carom/contact/detection/detector.h>
#include <carom/core/evaluation.h>
#include <carom/core/export.h>
#include <carom/core/numerics/never.h>
#include <carom/core/numerics/step_polynomial.h>
#include <carom/core/state.h>

#include <cstdint>

namespace carom {

/// A pair, with the bounds of its gap.
struct PairGap {
  const Detector& detector;
  const ContactPair& pair;
  const BodyPairBound* bound;  ///< of a pair with an outline; null: a point and a flat boundary, or a limit
};

/// Motion of both sides of a pair at one time of a path. A view.
struct PathSample {
  StateView state;               ///< with the time
  const double* acceleration;    ///< of the velocities of the state
  const Evaluation& evaluation;  ///< with its position group up to date
  const GroundPlaces& places;    ///< of shapes on ground, at the time
};

/// How exactly a path is looked at.
enum class PathLook : std::uint8_t {
  between,     ///< by interpolation, where the path has one
  exact,       ///< as accurate as the motion is known
  exact_rates  ///< places and velocities as accurate as the motion is known; accelerations may be anything
};

/// The motion of both sides of a pair in a span of time.
class CAROM_API PairPath {
public:
  virtual ~PairPath() = default;
  /// The motion at a time of the span. Valid until the next look.
  [[nodiscard]] virtual PathSample sample(double time, PathLook how) = 0;
};

/// Gap of a pair at one time.
struct GapLook {
  double time = 0.0;          ///< [s]
  bool known = true;          ///< false: `gap` is a lower bound
  StepPolynomial::End gap{};  ///< with two derivatives
};

/// How a gap is searched, and when its closing counts as found.
struct ClosingRule {
  double noise = 0.0;         ///< rounding of gaps [m]
  double fine = 0.0;          ///< a gap this far off a polynomial still counts as found [m]
  double level = 0.0;         ///< a gap closes where it falls below this by the noise, <= 0 [m]
  double fastest = never;     ///< bound of its rate [m/s]
  bool flies_freely = false;  ///< nothing but constant fields acts on the two bodies
  double sixth = 0.0;    ///< of a pair without an outline, by turning: bound of its sixth derivative [m/s^6]
  double until = never;  ///< later closings are of no interest [s]
  double found = 0.0;    ///< a gap this near the level on the exact motion has closed there [m]
  double slow = 0.0;     ///< rates up to this are none [m/s]
  /// An interpolation that is this far off the exact gap at the closing that it leads to is given up: all
  /// looks are exact then [m].
  double misleading = never;
  /// Values and rates of steps of low order contradict each other by the tolerance: a gap that opens where it
  /// reaches its level is searched for what is deeper than that, by up to this [m]. 0: it counts as open
  /// there, and what is behind that is searched.
  double contradiction = 0.0;
};

/// The gap that is found where a closing was predicted.
struct ClosingRoot {
  /// The kind of place that was found.
  enum class Kind : std::uint8_t {
    closes,    ///< the gap reaches the level and falls
    touches,   ///< the gap reaches the level, but does not fall
    opens,     ///< the gap is above the level, and rises
    misleads,  ///< the exact gap is not the one that was predicted
  };
  double time = 0.0;  ///< [s]
  Kind kind = Kind::opens;
  double rate = 0.0;  ///< of the gap there [m/s]
};

/// True of a gap whose rate may have kinks, or that turns: it is searched by looks and a bound of its rate.
[[nodiscard]] CAROM_API bool has_kinks(const BodyPairBound& bound);
/// The gap of a pair in a sample, with two derivatives.
[[nodiscard]] CAROM_API StepPolynomial::End gap_in(const PairGap& of, const PathSample& at);
/// (d^2 - rho^2)/(2 rho) by d - rho, with derivatives.
[[nodiscard]] CAROM_API StepPolynomial::End smooth_gap(const StepPolynomial::End& gap, double rho);

/// The first time at which a gap closes between two looks of a path; infinity: it does not. A gap that opens
/// where it seemed to close is searched anew behind that.
[[nodiscard]] CAROM_API double first_closing(PairPath& path, const PairGap& of, const ClosingRule& rule,
                                             const GapLook& from, const GapLook& to);
/// First half of first_closing(): about that time, by looks between two.
[[nodiscard]] CAROM_API double predict_closing(PairPath& path, const PairGap& of, const ClosingRule& rule,
                                               const GapLook& from, const GapLook& to,
                                               PathLook how = PathLook::between);
/// Second half of first_closing(): the closing on the exact motion, between a look and a later time, by
/// Newton's method from the time predicted; kept between a time at which the gap is open and falls, and one
/// at which it is closed, or open and rises.
/// \param is_below the gap is known to be below the level at the later time
[[nodiscard]] CAROM_API ClosingRoot locate_closing(PairPath& path, const PairGap& of, const ClosingRule& rule,
                                                   const GapLook& from, double to, bool is_below,
                                                   double predicted);

}  // namespace carom
