#pragma once

/// \file
/// The path between two states: how all bodies of a model move in a span of time at whose ends they are
/// known.

#include <carom/contact/detection/chosen_bodies.h>
#include <carom/contact/detection/detector.h>
#include <carom/contact/detection/first_closing.h>
#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/core/ids.h>
#include <carom/core/state.h>

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace carom {

/// A path on which coordinates change from those of one state to those of another, by parabolas or evenly:
///
///   q(s) = q_0 + s d - s (1 - s) h c/2,   v(s) = d/h + (s - 1/2) c,   s from 0 to 1,
///
/// with the displacement d, the length h and the change c of velocities. A flight under constant loads is
/// such a path, and a step of the midpoint rule, whose displacement is h (v_0 + v_1)/2. Ground moves as it is
/// prescribed. Each coordinate belongs to one velocity: bodies of the plane, and particles. Keeps memory.
class CAROM_API StatePath final : public PairPath {
public:
  /// \param assembly,detector must outlive it
  StatePath(const Assembly& assembly, const Detector& detector);

  /// Makes it the path between two states, which must have different times. \param change of velocities from
  /// one end to the other, an array over all velocities; null: coordinates change evenly \param bodies whose
  /// path is asked for
  void set(const State& from, const State& to, const double* change, const ChosenBodies& bodies = {});
  /// The motion of all bodies where the path begins. Valid until set().
  [[nodiscard]] PathSample begin() const {
    return {begin_.view(), acceleration_.data(), at_begin_, ground_[0]};
  }
  /// The motion of all bodies where the path ends. Valid until set().
  [[nodiscard]] PathSample end() const { return {end_.view(), acceleration_.data(), at_end_, ground_[1]}; }
  /// Time between its ends [s].
  [[nodiscard]] double length() const { return end_.time - begin_.time; }
  /// Displacement along a velocity over the whole path [m, rad].
  [[nodiscard]] double displacement(Index v) const { return displacement_[v]; }
  /// How far a coordinate is at most off the chord between its ends [m, rad].
  [[nodiscard]] double bend(Index v) const;
  /// Chooses the bodies that samples between the ends are of. \param bodies three at most, by number
  void watch(std::span<const Index> bodies);
  /// The motion of the bodies that are watched, at a time of the path.
  [[nodiscard]] PathSample sample(double time, PathLook how) override;

private:
  void write(const BodySlot& slot, double share, State& out) const;

  static constexpr std::size_t most_watched = 3;
  const Assembly* assembly_;
  const Detector* detector_;
  State begin_, end_, between_;
  Evaluation at_begin_, at_end_, at_between_;
  std::array<GroundPlaces, 3> ground_;  // then
  std::vector<double> displacement_, acceleration_;
  std::array<BodySlot, most_watched> watched_{};
  std::size_t watches_ = 0;
};

}  // namespace carom
