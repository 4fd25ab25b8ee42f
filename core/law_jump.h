#pragma once

/// \file
/// Prescribed displacements that are none: jumps, and rates that are not theirs. A displacement is
/// continuous; its velocity may jump. One that jumps has no velocity, and a difference across the jump gives
/// one that throws what it touches; a rate that is not its own moves bodies one way and strikes them another.

#include <carom/core/export.h>
#include <carom/core/function_ref.h>

#include <array>
#include <optional>
#include <string>

namespace carom {

/// A prescribed place at one time, with its rates. A single coordinate is the first number of `place`.
struct LawPoint {
  double time = 0.0;                 ///< [s]
  std::array<double, 3> place{};     ///< [m]; a coordinate in its own unit
  std::array<double, 3> velocity{};  ///< rate of the place
  double angle = 0.0;                ///< [rad]; where whole turns do not matter
  double spin = 0.0;                 ///< rate of the angle [rad/s]
  bool velocity_given = false;       ///< by a function of its own, not from the place by differences
  bool spin_given = false;           ///< by a function of its own, not from the angle by differences
};

/// A jump that was found.
struct LawJump {
  double time = 0.0;      ///< the last time before it [s]
  double size = 0.0;      ///< |change| of the place, or change of the angle
  bool of_angle = false;  ///< true: the angle jumps; false: the place
};

/// A given rate that is not the rate of what it belongs to.
struct FalseRate {
  double time = 0.0;      ///< [s]
  double off = 0.0;       ///< |given rate - rate of the place or of the angle|
  bool of_angle = false;  ///< true: the rate is that of the angle; false: that of the place
};

/// Part of the way that velocities may miss: two points of a law are taken as parts of a smooth motion where
///     |x1 - x0 - h (v0 + v1)/2|  <=  smooth_share (|x1 - x0| + h (|v0| + |v1|)/2) + resolved_share max|x|.
/// and the velocities do not change much, |v1 - v0| <= bent_share (|v0| + |v1|): a jump that velocities by
/// differences have felt may look like a start from rest. By the rule's error h^3 |x'''|/12 a law of angular
/// frequency w passes for h w < 1 or so, but where it turns back.
inline constexpr double smooth_share = 0.1;
inline constexpr double bent_share = 0.5;  ///< see smooth_share
/// Smallest jump that is looked for, as part of the largest |x|: rounding of usual laws is far below.
inline constexpr double resolved_share = 1e-9;

/// True if two points of a law look like points of one smooth motion, by the rule at smooth_share.
[[nodiscard]] CAROM_API bool looks_smooth(const LawPoint& from, const LawPoint& to);

/// Looks for a jump between two points of a law that do not look smooth: the interval is halved as long as
/// its parts do not look smooth either, down to the rounding of time. A jump is a change that over the last
/// interval is still most of what it is over one a thousand times as long: fast and rough motions, and kinks,
/// have none. A jump that velocities by differences have felt (core/numerics/time_difference.h) may lie a
/// little outside of the interval, and is found there. Not found are jumps of less than smooth_share of the
/// way of the motion around them, and all but the eight roughest parts of an interval.
[[nodiscard]] CAROM_API std::optional<LawJump> find_jump(FunctionRef<LawPoint(double time)> law,
                                                         const LawPoint& from, const LawPoint& to);

/// Looks for a given rate that contradicts its place or angle between two points that do not look smooth: by
/// more than smooth_share of the way, at five times of five, however short the way. Not found are rates that
/// are false for less than that, and ways below 1e-8 of the largest |x|.
[[nodiscard]] CAROM_API std::optional<FalseRate> find_false_rate(FunctionRef<LawPoint(double time)> law,
                                                                 const LawPoint& from, const LawPoint& to);

/// A law of time of a user, as its part prescribes it: the only place where such laws are checked in a run. A
/// view.
class CAROM_API PrescribedLaw {
public:
  /// Quantities as errors name them, with their units; no unit of a coordinate.
  struct Names {
    const char *place = "position", *unit = "";                 ///< of the place
    const char *velocity = "velocity", *unit_of_velocity = "";  ///< of its rate
    const char *angle = "angle", *unit_of_angle = "rad";        ///< of the angle
    const char *spin = "spin", *unit_of_spin = "rad/s";         ///< of its rate
  };

  /// All must outlive it. \param law at a time [s] \param part name of the part, asked for errors
  PrescribedLaw(FunctionRef<LawPoint(double time)> law, FunctionRef<std::string()> part, const Names& names)
      : law_(law), part_(part), names_(&names) {}
  /// Demands that the law is continuous between two of its points, and that rates which are given are its
  /// own. Throws SolverError naming the part, the time, and by how much it jumps or the rate is off.
  void demand_continuous(const LawPoint& from, const LawPoint& to) const;

private:
  [[noreturn]] void fail(const LawJump& jump) const;
  [[noreturn]] void fail(const FalseRate& found) const;

  FunctionRef<LawPoint(double time)> law_;
  FunctionRef<std::string()> part_;
  const Names* names_;
};

/// Throws the SolverError of a law that is not finite. \param part whose law it is \param quantity what is
/// not finite, with its value in `unit` \param time [s]
[[noreturn]] CAROM_API void fail_law_not_finite(const std::string& part, const std::string& quantity,
                                                double value, const char* unit, double time);

}  // namespace carom
