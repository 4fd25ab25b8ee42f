#pragma once

/// \file
/// Closings: contacts that close within a step although they did not act in it. Of second order are steps
/// that end there, whose rest begins with the impact (TimeStepping::impacts, where LocatedMotion does not
/// follow a body alone: bodies that touch each other).

#include <carom/contact/detection/contact_look.h>
#include <carom/contact/detection/detector.h>
#include <carom/contact/solvers/contact_mode.h>
#include <carom/core/assembly.h>
#include <carom/core/constraint_set.h>
#include <carom/core/export.h>
#include <carom/core/function_ref.h>
#include <carom/core/state.h>
#include <carom/integrators/run/companion.h>
#include <carom/integrators/run/time_stepping.h>
#include <carom/integrators/time_stepping/capture_rule.h>
#include <carom/integrators/time_stepping/gap_rounding.h>

#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace carom {

/// Searches the ends of steps for closings. Keeps memory, and what has closed in a step.
class CAROM_API ClosingSearch {
public:
  /// Modes of the contacts that acted in a step, as Companion::modes.
  using Modes = std::span<const std::pair<ConstraintKey, ContactMode>>;

  /// The contact that is deepest at the end of a part of a step, of those that did not act in it.
  struct Closing {
    double gap = std::numeric_limits<double>::infinity();  ///< [m]; infinite: none is near
    double rate = 0.0;                                     ///< of the gap [m/s]
    ConstraintKey key;                                     ///< which it is
  };

  /// \param assembly,detector must outlive it
  ClosingSearch(const Assembly& assembly, const Detector& detector, const TimeStepping& options)
      : look_(assembly, detector),
        most_impacts_(options.most_impacts),
        rounding_(gap_rounding(assembly, options)),
        capture_(CaptureRule::of(assembly, options)) {}

  /// Forgets what has closed: a step begins.
  void begin_step() { closed_.clear(); }
  /// The closing that a part of a step from one state to another passes first, or nearly reaches.
  [[nodiscard]] Closing look(const State& start, const State& end, Modes acted);
  /// A contact hits within this if a part ends there, and takes part in the next (gap_rounding.h) [m].
  [[nodiscard]] double rounding() const { return rounding_; }
  /// True if the part ends too late for a closing.
  [[nodiscard]] bool is_late(const Closing& closing) const { return closing.gap < -rounding_; }
  /// True if it ends when the contact closes.
  [[nodiscard]] bool is_now(const Closing& closing) const { return closing.gap <= 0.0 && !is_late(closing); }
  /// True if a contact has closed in the part that was looked at last, and nobody is to look for it any more.
  [[nodiscard]] bool any_given_up() const { return given_up_; }
  /// Says which of the contacts that close at the end looked at last rebound although they are slow, and
  /// which do not although they are fast. \param hit at which the part ends; none at the end of a step, where
  /// nothing is counted: else one contact rebounds as often as TimeStepping::most_impacts says in a step, and
  /// closes without as often; after these it acts from the next step on. Where one does not rebound any more
  /// the others of its bodies may as often again: a light body between two heavy ones stays with one of them
  /// \param accelerations of all bodies up to there, over all velocities; asked for slow contacts alone
  void note(const State& end, const Closing* hit, FunctionRef<const std::vector<double>&()> accelerations,
            ClosingNotes& out);

private:
  struct Count {
    ConstraintKey key;
    std::array<Constraint::Block, std::size_t{Constraint::max_bodies}> bodies;
    int rebounds = 0, others = 0;
  };
  [[nodiscard]] static bool acts(const Constraint& contact, Modes acted);
  [[nodiscard]] bool is_given_up(const ConstraintKey& key) const;
  void count(const Constraint& contact, bool rebounds, ClosingNotes& out);
  void allow_more(const Constraint& contact);
  [[nodiscard]] bool was_open(const Constraint& contact, const State& start);
  [[nodiscard]] double gap_at_start(const Constraint& contact, double reach) const;
  [[nodiscard]] double gap_of_vertex(const Constraint& contact, const State& start);

  ContactLook look_;
  int most_impacts_;
  double rounding_;
  CaptureRule capture_;
  bool given_up_ = false;  // any_given_up()
  ConstraintSet at_start_, at_end_, left_out_;
  std::vector<Count> closed_;
  double near_ = 0.0;  // gaps that are looked at, for the parts of one search [m]
};

}  // namespace carom
