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

#include <cstdint>
#include <span>
#include <vector>

namespace carom {

/// The contacts of the step before that turning may have opened, and by how much. A workspace:
/// Detector::remember() fills it at the start of every step.
class CAROM_API LastingContacts {
public:
  /// Gaps up to this many times h^2 d count as opened by turning. The steady gap is h^2 d. From 0 a contact
  /// comes there with at most h^2 d (1 + d/(2 (a - d))), a the normal acceleration towards the ground that
  /// the body would have without it, and d < a while the contact lasts: one about to lift off, a < 15/14 d,
  /// may be lost on that way.
  static constexpr double most_opening = 8.0;

  /// Forgets all contacts. \param step length of a step that gaps may come from [s]
  /// \param slack opening that is none [m] \param keeps_pressed whether contacts that pressed last whatever
  /// their gap
  void start(double step, double slack = 0.0, bool keeps_pressed = false) {
    step_ = step;
    slack_ = slack;
    keeps_pressed_ = keeps_pressed;
    contacts_.clear();
    centres_.clear();
    pressed_.clear();
  }
  /// Adds a contact. \param centre its body, in the order of assembly, where it touches at its centre of mass
  /// \param pressed whether it had an impulse
  void add(const ConstraintKey& key, Index centre = none, bool pressed = false) {
    contacts_.add(key);
    if (centre != none) centres_.push_back(centre);
    if (keeps_pressed_) pressed_.push_back(pressed ? 1 : 0);
  }
  /// Makes the contacts ready to be looked up.
  void finish() {
    contacts_.finish();
    if (centres_.size() > 1) put_in_order();
  }

  /// True if there are none.
  [[nodiscard]] bool empty() const { return contacts_.keys().empty(); }
  /// All, in the order of add().
  [[nodiscard]] std::span<const ConstraintKey> keys() const { return contacts_.keys(); }
  /// True if a contact is among them.
  [[nodiscard]] bool contains(const ConstraintKey& key) const { return contacts_.find(key) != none; }
  /// True if a body within a range, in the order of assembly, touched at its centre of mass.
  [[nodiscard]] bool any_centre(Range bodies) const;
  /// Length of the step that gaps come from [s].
  [[nodiscard]] double step() const { return step_; }
  /// Opening that counts as none [m].
  [[nodiscard]] double slack() const { return slack_; }
  /// True if contacts that pressed last whatever their gap.
  [[nodiscard]] bool keeps_pressed() const { return keeps_pressed_; }
  /// True if a contact is among them and turning explains its gap, or it pressed and that is enough.
  /// \param turning bound on |d| [m/s^2]
  [[nodiscard]] bool lasts(const ConstraintKey& key, double gap, double turning) const {
    if (gap <= reach(turning) + slack_) return contains(key);
    if (!keeps_pressed_) return false;
    const Index place = contacts_.find(key);
    return place != none && pressed_[place] != 0;
  }
  /// The largest gap [m] that turning explains. \param turning bound on |d| [m/s^2]
  [[nodiscard]] double reach(double turning) const { return most_opening * step_ * step_ * turning; }

private:
  void put_in_order();

  double step_ = 0.0, slack_ = 0.0;
  bool keeps_pressed_ = false;
  ConstraintTable contacts_;
  std::vector<Index> centres_;         // ascending
  std::vector<std::uint8_t> pressed_;  // in the order of add(), where that is asked
};

}  // namespace carom
