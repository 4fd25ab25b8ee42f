#pragma once

/// \file
/// Closings of a step: gaps that reach a level on its way (first_closing.h).
///
/// Two kinds of levels are looked for. Where impacts are located and no body is followed by itself
/// (LocatedMotion), contacts that did not act in the step close: the level is zero (TimeStepping::impacts).
/// And nothing may come so deep into another thing that it could leave that on its far side: the level is a
/// depth (passage_levels.h; OverlapRules::never_tunnel, and where impacts are located). Pairs come from the
/// broad phase of the way (swept_pairs.h). So a contact is found too that closes and is open again by the end
/// of the step, if it closes faster than the capture speed; a slower one comes at most as deep as a quarter
/// of what that speed makes in the step.
///
/// The way of a step is that between its ends on which velocities change evenly; of a body that is hit on it,
/// those of its flights. It leads to the time at which a step is to end, and the
/// step that ends there says what is true: so an error of the way costs a step, unless it hides a closing.

#include <carom/contact/detection/detector.h>
#include <carom/contact/detection/first_closing.h>
#include <carom/contact/detection/outline_depth.h>
#include <carom/contact/detection/swept_pairs.h>
#include <carom/core/assembly.h>
#include <carom/core/constraint_set.h>
#include <carom/core/export.h>
#include <carom/core/function_ref.h>
#include <carom/integrators/run/time_stepping.h>
#include <carom/integrators/time_stepping/capture_rule.h>
#include <carom/integrators/time_stepping/passage_levels.h>
#include <carom/integrators/time_stepping/way_paths.h>

#include <cstdint>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

namespace carom {

/// A gap that reaches a level.
struct StepClosing {
  double time = never;      ///< when, on the way; infinite: none does [s]
  bool is_passage = false;  ///< the level is a depth
  SweptPair pair;           ///< whose gap it is; not of a passage
  ConstraintKey key;        ///< of the contact
  Index body = none;        ///< one of its bodies
  double shallow = 0.0;     ///< a step may end at any gap from this one down [m]
  double deep = 0.0;        ///< to this one [m]
  bool dips = false;        ///< the gap is open again where the way ends on which it was found
  double gap = 0.0;         ///< where the way ends [m]
  double rate = 0.0;        ///< of the gap, there [m/s]

  /// The gap at which a step is to end [m].
  [[nodiscard]] double aim() const { return 0.5 * (shallow + deep); }
  /// True where a way ends at the closing. A gap that grows does not close, however small it is: the last
  /// impact may have opened it.
  [[nodiscard]] bool is_reached() const { return gap <= shallow && rate < 0.0; }
  /// The time of the gap at which a step is to end, by its rate where a way ends; infinite where it grows.
  /// \param end of the way [s]
  [[nodiscard]] double time_by_rate(double end) const {
    return rate < 0.0 ? end - (gap - aim()) / rate : never;
  }
  /// True of a dip that is none where a way ends there: the gap is open and grows.
  [[nodiscard]] bool is_refuted() const { return dips && gap > shallow && rate > 0.0; }
};

/// Which contacts are looked for, beside passages.
enum class StepContacts : std::uint8_t {
  nothing,   ///< none
  of_turns,  ///< such as may open again within the step: of outlines, and of points that turn
  all        ///< also those of other points, and limits of joints
};

/// Searches ways of steps for closings. Keeps memory only.
class CAROM_API StepClosings {
public:
  /// \param assembly,detector must outlive it
  StepClosings(const Assembly& assembly, const Detector& detector, const TimeStepping& options,
               StepContacts contacts);

  /// False if there is nothing to look for.
  [[nodiscard]] bool finds_any() const { return of_contacts_ || levels_.thinnest() < never; }
  /// A contact hits within this if a step ends there, and takes part in the next (gap_rounding.h) [m].
  [[nodiscard]] double rounding() const { return rounding_; }
  /// A step begins: nothing is left aside any more.
  void begin_step() { aside_.clear(); }
  /// Leaves the closings of a pair aside in the rest of the step: it is none of those that the detector
  /// finds.
  void leave_aside(const ContactPair& pair) { aside_.push_back(pair); }
  /// A phase of the step begins: nothing is refuted any more.
  void begin_phase() { refuted_.clear(); }
  /// Leaves the closings of a pair aside in the phase at hand: a shorter one has shown that there is none.
  void refute(const ContactPair& pair) { refuted_.push_back(pair); }
  /// The first closing on a way. \param closes whether a contact is looked for that closes; of others nothing
  /// but their passages is
  [[nodiscard]] StepClosing first(const StepWay& way, FunctionRef<bool(const SweptPair&)> closes);
  /// All closings on a way, in any order: of each pair the first.
  /// \param closes as of first()
  [[nodiscard]] std::span<const StepClosing> all(const StepWay& way,
                                                 FunctionRef<bool(const SweptPair&)> closes);
  /// Extends boxes around all that outlines of bodies sweep, by outline: by a way.
  void add_boxes(const StepWay& way, std::vector<Box<2>>& boxes);
  /// True if a contact has closed on the way that was searched last, and was not looked for.
  [[nodiscard]] bool any_left_out() const { return left_out_; }
  /// Brings gap, rate and key of a closing to the end of the way that was searched last; not of a passage.
  void look_at_end(StepClosing& closing);

private:
  // A contact of the step, by its pair or, where that has no outline, by its key.
  struct Acted {
    Index feature, outline;
    ConstraintKey key;
    std::size_t place;  // in the list
    bool open;

    [[nodiscard]] auto name() const { return std::tie(outline, feature, key); }
  };
  void list_acted(std::span<const std::pair<ConstraintKey, ContactMode>> modes);
  [[nodiscard]] bool acts(Index feature, Index outline, const ConstraintKey& key) const;
  [[nodiscard]] double most_approach() const;
  [[nodiscard]] WayPaths::Form form() const {
    return of_contacts_ ? WayPaths::Form::parabola : WayPaths::Form::chord;
  }
  // Which closings are kept.
  enum class Keeps : std::uint8_t { first, all };
  void begin(const StepWay& way);
  void search(const StepWay& way, FunctionRef<bool(const SweptPair&)> closes, Keeps which);
  void search_contacts(const StepWay& way, FunctionRef<bool(const SweptPair&)> closes, Keeps which);
  void search_depths(std::span<const NearOutlines> near, double approach, Keeps which);
  [[nodiscard]] double until(Keeps which) const;
  void keep(const StepClosing& closing, Keeps which);
  [[nodiscard]] bool looks_at(const StepWay& way, const ContactPair& pair) const;
  [[nodiscard]] bool reaches(StepClosing& closing, double until);
  [[nodiscard]] bool counts(const StepClosing& closing, double rate);

  const Assembly* assembly_;
  const Detector* detector_;
  bool of_contacts_;
  double rounding_;
  CaptureRule capture_;
  PassageLevels levels_;
  WayPaths paths_;
  SweptPairs pairs_;
  OutlineDepth depths_;
  std::vector<Acted> acted_;
  std::vector<ContactPair> aside_, refuted_;
  std::vector<StepClosing> found_;  // on the way at hand
  bool left_out_ = false;
};

}  // namespace carom
