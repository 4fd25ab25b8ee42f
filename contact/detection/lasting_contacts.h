#pragma once

/// \file
/// Contacts that last from one time step to the next although they are a little open.
///
/// Contact velocities of a step are taken along the rows at its start. A feature on an arm that turns leaves
/// a flat boundary meanwhile: with d the rate of the normal velocity at constant velocities (docs/method.md,
/// section 6), a contact that the law holds at gamma_n+ = 0 begins the next step with gamma_n- = h d and has
/// opened by h^2 d. It is closed in the motion that the steps approach, so it stays in the contact problem.

#include <carom/core/constraint_table.h>
#include <carom/core/export.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace carom {

/// Opening of contacts that is none [m].
struct OpeningSlack {
  double of_all = 0.0;      ///< of all contacts: rounding
  double of_pressed = 0.0;  ///< of contacts that pushed in the step before: errors of answers too;
                            ///< infinity: they last whatever their gap
};

/// The contacts of the step before that turning may have opened, and by how much. A workspace:
/// Detector::remember() fills it at the start of every step.
class CAROM_API LastingContacts {
public:
  /// Gaps up to this many times h^2 d count as opened by turning. The steady gap is h^2 d. From 0 a contact
  /// comes there with at most h^2 d (1 + d/(2 (a - d))), a the normal acceleration towards the ground that
  /// the body would have without it, and d < a while the contact lasts: one about to lift off, a < 15/14 d,
  /// may be lost on that way.
  static constexpr double most_opening = 8.0;

  /// Which contacts had an impulse.
  struct Pressed {
    bool itself = false;
    bool other = false;  ///< one that may be the other contact of the same two corners
  };

  /// Forgets all contacts. \param step length of a step that gaps may come from [s]
  void start(double step, const OpeningSlack& slack = {}) {
    step_ = step;
    slack_ = slack;
    contacts_.clear();
    pressed_.clear();
    centres_.clear();
  }
  /// Adds a contact of which nobody asks whether it had an impulse.
  void add(const ConstraintKey& key) { add(key, Pressed{}); }
  /// Adds a contact. \param centre its body, in the order of assembly, where it touches at its centre of mass
  void add(const ConstraintKey& key, const Pressed& pressed, Index centre = none) {
    contacts_.add(key);
    if (slack_.of_pressed > 0.0) pressed_.push_back(pressed);
    if (centre != none) centres_.push_back(centre);
  }
  /// Makes the contacts ready to be looked up.
  void finish() {
    contacts_.finish();
    if (centres_.size() > 1) put_in_order();
  }

  /// True if there are none.
  [[nodiscard]] bool empty() const { return contacts_.keys().empty(); }
  /// Keys of all contacts, in the order of add().
  [[nodiscard]] std::span<const ConstraintKey> keys() const { return contacts_.keys(); }
  /// True if a contact is among them.
  [[nodiscard]] bool contains(const ConstraintKey& key) const { return contacts_.find(key) != none; }
  /// True if a contact is among them and had an impulse, where these have a slack of their own.
  /// \param of_corners whether it is one of the two of corners that meet, which may change names from step to
  /// step: then it is enough that the other one had an impulse
  [[nodiscard]] bool is_pressed(const ConstraintKey& key, bool of_corners) const {
    const Index known = contacts_.find(key);
    if (!(known < pressed_.size())) return false;
    return pressed_[known].itself || (of_corners && pressed_[known].other);
  }
  /// True if a body within a range, in the order of assembly, touched at its centre of mass.
  [[nodiscard]] bool any_centre(Range bodies) const;
  /// Length of the step that gaps come from [s].
  [[nodiscard]] double step() const { return step_; }
  /// True if contacts that pushed last whatever their gap.
  [[nodiscard]] bool keeps_pressed() const { return std::isinf(slack_.of_pressed); }
  /// The largest opening that counts as none and has a bound [m].
  [[nodiscard]] double slack() const {
    return keeps_pressed() ? slack_.of_all : std::max(slack_.of_all, slack_.of_pressed);
  }
  /// True if a contact is among them and turning explains its gap, or slack. \param turning bound on |d|
  /// [m/s^2] \param of_corners as of is_pressed()
  [[nodiscard]] bool lasts(const ConstraintKey& key, double gap, double turning,
                           bool of_corners = false) const {
    const double explained = reach(turning);
    if (gap <= explained + slack_.of_all) return contains(key);
    return gap <= explained + slack_.of_pressed && is_pressed(key, of_corners);
  }
  /// The largest gap [m] that turning explains. \param turning bound on |d| [m/s^2]
  [[nodiscard]] double reach(double turning) const { return most_opening * step_ * step_ * turning; }

private:
  void put_in_order();

  double step_ = 0.0;
  OpeningSlack slack_;
  ConstraintTable contacts_;
  std::vector<Pressed> pressed_;  // in the order of add(); empty without a slack of theirs
  std::vector<Index> centres_;    // ascending
};

}  // namespace carom
