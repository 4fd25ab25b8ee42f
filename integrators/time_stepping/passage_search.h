#pragma once

/// \file
/// Passages: where on the way of a step something would come deeper into another thing than it may, and could
/// leave it on the far side (OverlapRules::never_tunnel; TimeStepping::impacts, where contacts that have
/// closed are looked for at the ends of steps).
///
/// The way of a step is the chord between its ends: positions and angles change evenly, ground moves as it is
/// prescribed. Where a body is hit on the way it is a chord up to the impact and another one from there. Two
/// convex things that are apart by g along a normal n stay apart for at least g/c, c the largest rate at
/// which they come nearer along n: that of their translation, and for each turning one the size of its spin
/// times the reach of its vertices. So looks from one such time to the next miss nothing (conservative
/// advancement: B. Mirtich, Impulse-based Dynamic Simulation of Rigid Body Systems, Berkeley 1996, chapter
/// 2). Inside a circle, which is not convex from within, c is the whole rate of the translation. Of moving
/// ground the velocity at the look is taken, and twice what it changes up to the step's end.

#include <carom/contact/detection/body_touches.h>
#include <carom/contact/detection/contact_look.h>
#include <carom/contact/detection/detector.h>
#include <carom/core/assembly.h>
#include <carom/core/constraint_set.h>
#include <carom/core/export.h>
#include <carom/core/state.h>
#include <carom/integrators/run/time_stepping.h>
#include <carom/integrators/time_stepping/step_flights.h>

#include <cstdint>
#include <limits>
#include <map>
#include <utility>
#include <vector>

namespace carom {

/// Which passages are looked for.
enum class Passages : std::uint8_t {
  /// All passages: nothing may be deep in anything.
  all,
  /// Passages that closings at the end of the step do not show. Ground without a far side is left out; things
  /// that turn while they are near each other, and are thinner than 1/64 of their way in the step, may be
  /// missed.
  of_far_sides
};

/// Searches steps for passages. Keeps memory only.
class CAROM_API PassageSearch {
public:
  /// A time at which a pair is deep enough for a step to end there.
  struct Passage {
    double time = std::numeric_limits<double>::infinity();  ///< [s]; infinite: there is none
    ConstraintKey key;                                      ///< of the pair
  };

  /// Assembly and detector must outlive it.
  PassageSearch(const Assembly& assembly, const Detector& detector, const TimeStepping& options,
                Passages which);

  /// False if nothing has a far side that it could leave on.
  [[nodiscard]] bool finds_any() const { return !std::isinf(thinnest_); }
  /// The first passage on the way from one state to another, by the flights of bodies that are hit on it. A
  /// pair may come as deep as an eighth of the radii of the largest circles in both, beyond its depth at the
  /// start; found is a depth up to half as much more. The outside of a box or a circle has no far side and
  /// counts with none. Of things without a thickness (points, bare segments) a thousand times gap_rounding()
  /// stands for it, 1e-9 m by default.
  [[nodiscard]] Passage first(const State& start, const State& end, StepFlights& flights);

private:
  using Pair = std::pair<FeatureKey, FeatureKey>;  // first features of two outlines
  struct Thickness {
    double circle;   // radius of a circle in it; infinite of what is not to be looked for [m]
    bool is_hollow;  // the inside of a circle
  };
  using Thicknesses = std::map<FeatureKey, Thickness>;  // of outlines, by their first feature
  void add(const FeatureKey& key, const Thickness& thickness);
  void set_thinnest();
  [[nodiscard]] Thicknesses::const_iterator outline(const FeatureKey& key) const;
  [[nodiscard]] Pair pair_of(const Constraint& contact) const;
  [[nodiscard]] double allowed(const Constraint& contact) const;
  [[nodiscard]] double turning(const Constraint& contact) const;
  [[nodiscard]] double stride(const Constraint& contact, double most_deep) const;
  [[nodiscard]] Passage first_on_chord(const State& start, const State& end, const State& begin);
  [[nodiscard]] double approach_along(const Constraint& contact, int i) const;
  [[nodiscard]] double approach(const Constraint& contact) const;
  [[nodiscard]] double most_approach(const State& start, const State& end);
  void look(const State& start, double share);
  void keep_depths();
  [[nodiscard]] double depth_at_start(const Constraint& contact) const;

  ContactLook look_;
  Passages which_;
  Thicknesses thickness_;
  std::vector<double> reach_;  // by body, of vertices from its centre of mass [m]
  double least_depth_;         // stands for the thickness of what has none [m]
  double thinnest_ = 0.0;      // depth that any pair may have; infinite: there is none to look for [m]
  bool knows_depths_ = false;  // those at the start of the way at hand
  State at_;
  std::vector<State> way_;  // corners of the way
  GroundPlaces places_at_end_;
  ConstraintSet contacts_;
  std::vector<double> displacement_;               // over all velocities, of the whole step
  std::vector<std::pair<Pair, double>> at_start_;  // pairs that overlap then, by how much [m]
  double step_ = 0.0;                              // [s]
  double margin_ = 0.0;                            // of what may come near in the rest of the step [m]
};

}  // namespace carom
