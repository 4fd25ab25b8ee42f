#pragma once

/// \file
/// Contacts that close where a part of a step ends: which of them rebound in the impact with which the next
/// part begins, and how often one may in a step (TimeStepping::most_impacts).

#include <carom/contact/detection/contact_look.h>
#include <carom/contact/detection/detector.h>
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
#include <span>
#include <utility>
#include <vector>

namespace carom {

/// Counts the closings of a step. Keeps memory, and what has closed in the step.
class CAROM_API ClosingCounts {
public:
  /// Modes of the contacts that acted in a step, as Companion::modes.
  using Modes = std::span<const std::pair<ConstraintKey, ContactMode>>;

  /// \param assembly,detector must outlive it
  ClosingCounts(const Assembly& assembly, const Detector& detector, const TimeStepping& options)
      : look_(assembly, detector),
        most_impacts_(options.most_impacts),
        rounding_(gap_rounding(assembly, options)),
        capture_(CaptureRule::of(assembly, options)) {}

  /// Forgets what has closed: a step begins.
  void begin_step() { closed_.clear(); }
  /// True of a contact that has closed often enough: nobody is to look for it any more.
  [[nodiscard]] bool is_given_up(const ConstraintKey& key) const;
  /// Lists the contacts that close at the end of a phase, of those that did not act up to there.
  /// \param bodies whose end it is
  void find(const State& end, Modes acted, const ChosenBodies& bodies);
  /// True if any of these is of the same bodies, or of the same body and shape on ground, as a contact.
  [[nodiscard]] bool lists_parts_of(const ConstraintKey& contact) const;
  /// Says which of them rebound although they are slow, and which do not although they are fast. \param end
  /// as of find() \param hit contact at which the part ends, which may be deeper than rounding, as times
  /// cannot be told apart; null at the end of a step, where nothing is counted: else one contact rebounds as
  /// often as TimeStepping::most_impacts says in a step, and closes without as often; after these it acts
  /// from the next step on. Where one does not rebound any more the others of its bodies may as often again:
  /// a light body between two heavy ones stays with one of them \param accelerations of all bodies up to
  /// there, over all velocities; asked for slow contacts alone
  void note(const State& end, const ConstraintKey* hit,
            FunctionRef<const std::vector<double>&()> accelerations, ClosingNotes& out);

private:
  struct Count {
    ConstraintKey key;
    std::array<Constraint::Block, std::size_t{Constraint::max_bodies}> bodies;
    int rebounds = 0, others = 0;
  };
  void count(const Constraint& contact, bool rebounds, ClosingNotes& out);
  void allow_more(const Constraint& contact);

  ContactLook look_;
  int most_impacts_;
  double rounding_;
  CaptureRule capture_;
  ConstraintSet at_end_;
  std::vector<Count> closed_;
};

}  // namespace carom
