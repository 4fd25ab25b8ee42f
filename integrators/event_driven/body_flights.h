#pragma once

/// \file
/// How bodies of clock groups move for a while, and the volumes that they sweep meanwhile.
///
/// A volume holds until the horizon of its group: until the step that the group has made ahead ends, or its
/// next event, or a body has gone so far that its volume would meet too many others. Groups whose volumes do
/// not overlap cannot meet before the earlier of their horizons. The bounds of the motion are safe because a
/// step is bounded after it was made, not before: a body that nothing but a uniform field accelerates moves
/// along a parabola, whose box is exact. Any other moves no faster than the faster end of its step and twice
/// what its accelerations at the ends change over the step, the bound that the search for events within a
/// group rests on.
///
/// Volumes are those in a frame that goes on evenly, with all bodies where they fly together at first, so
/// that how long they hold depends on how fast bodies move against each other; else at rest.

#include <carom/contact/detection/swept_volumes.h>
#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/integrators/event_driven/clock_group.h>
#include <carom/integrators/event_driven/motion_sample.h>
#include <carom/integrators/event_driven/step_path.h>

#include <array>
#include <vector>

namespace carom {

/// A body at one time: x, y, and the angle where it has one [m, rad].
using BodyMoment = std::array<CoordinateMotion, 3>;

/// The motion of a body from a time on.
struct CAROM_API BodyFlight {
  double time = 0.0;       ///< [s]
  double reach = -1.0;     ///< of its outlines from its centre of mass [m]; < 0: it has none
  double speed = 0.0;      ///< bound of it in the frame of the volumes, where it does not fly freely [m/s]
  Index component = none;  ///< component of the body
  bool is_free = false;    ///< nothing but uniform fields acts: the acceleration stays
  /// The motion between `time` and `due` is the curve of degree 5 that has both moments, as accurate as the
  /// steps of methods of order 5 are; else it is only known to those who sample its group.
  bool is_curve = false;
  double due = 0.0;       ///< end of the step ahead, or its event; infinite at rest [s]
  BodyMoment begin, end;  ///< at `time` and `due`

  /// Place of the centre of mass at `time` [m].
  [[nodiscard]] Vec<2> place() const { return {begin[0].place, begin[1].place}; }
  /// Velocity of the centre of mass at `time` [m/s].
  [[nodiscard]] Vec<2> velocity() const { return {begin[0].rate, begin[1].rate}; }
  /// Acceleration of the centre of mass at `time` [m/s^2].
  [[nodiscard]] Vec<2> acceleration() const { return {begin[0].acceleration, begin[1].acceleration}; }
  /// The motion at a time from `time` to `due`, of a body that flies freely or follows a curve.
  [[nodiscard]] BodyMoment moment(double at) const;
};

/// The flights of all bodies.
class CAROM_API BodyFlights {
public:
  /// All must outlive it.
  BodyFlights(const Assembly& assembly, const Detector& detector);

  /// Begins: chooses the size of cells by the places of bodies, and takes them where they are, for no time.
  /// \param extra added to volumes from here on: those of bodies nearer than twice that overlap [m]
  void start(const State& state, double extra);
  /// Follows the bodies of a group from a time on, within its step ahead. Returns its horizon [s]. \param
  /// memory samples, overwritten
  double follow(ClockGroup& group, double time, MotionSample& now, MotionSample& end);
  /// The horizon of a component [s].
  [[nodiscard]] double horizon(Index component) const { return horizons_[component]; }
  /// The flight of a body.
  [[nodiscard]] const BodyFlight& of(Index body) const { return flights_[body]; }
  /// The volumes, by body.
  [[nodiscard]] const SweptVolumes& volumes() const { return volumes_; }

private:
  void choose_frame(const State& state);
  void sweep(Index body, double length);

  const Assembly* assembly_;
  std::vector<BodyFlight> flights_;
  std::vector<double> horizons_;  // by component
  SweptVolumes volumes_;
  Vec<2> frame_ = Vec<2>::Zero();  // its velocity [m/s]
  double frame_time_ = 0.0;        // when places in it are those at rest [s]
  double travel_ = 0.0;            // the way that a volume is made for [m]
  double extra_ = 0.0;             // added to volumes: what is as near as that overlaps [m]
};

}  // namespace carom
