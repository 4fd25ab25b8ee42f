#pragma once

/// \file
/// Contacts that stay closed for a while (docs/method.md, section 7). Their normals, and the tangents of
/// those that stick, are constraints on the accelerations; those that slip rub against their motion. With the
/// rows G of the constraints and the columns D along which their forces act (the normal turned into the cone
/// of friction where a contact slips) find lambda with
///
///     G a + drift = 0,   a = a_free + B D lambda,
///
/// B the response of the bodies: M^-1, or what joints leave of it (core/dynamics/body_response.h). Contacts
/// of different bodies do not know of each other, unless joints bind the bodies together, or bodies that they
/// touch: they are solved island by island.

#include <carom/contact/active_contact.h>
#include <carom/contact/delassus.h>
#include <carom/contact/detection/detector.h>
#include <carom/contact/force_margins.h>
#include <carom/contact/island_partition.h>
#include <carom/contact/least_forces.h>
#include <carom/core/assembly.h>
#include <carom/core/dynamics/components_response.h>
#include <carom/core/export.h>
#include <carom/core/numerics/full_pivoting.h>

#include <span>
#include <vector>

namespace carom {

/// Memory that active sets share: one at a time uses it.
struct CAROM_API ActiveSetMemory {
  IslandPartition islands;          ///< of mechanisms, named by their first bodies
  std::vector<JoinedNodes> joined;  ///< by contact: the mechanisms that it joins
  std::vector<Index> last;          ///< by contact: the last one of its island
  // Of the group at hand:
  std::vector<ContactPivot::Row> rows;
  std::vector<ImpulseDirection> directions;  ///< columns of the equations of the group
  Delassus delassus;
  FullPivoting factors;         ///< of G B D
  std::vector<double> unknown;  ///< right side, then lambda
  std::vector<double> load;     ///< over all velocities, of bodies that joints bind
  std::vector<int> exponents;   ///< of its rows' own responses, by powers of two; empty: not scaled
  // Of the set whose forces were found last:
  std::vector<ContactPivot> pivots;
  LeastForces least_forces;
  ForceMargins margins;
};

/// The closed contacts of one clock group, those of an island together. What it tells of the last
/// add_reactions() holds until another set finds its forces.
class CAROM_API ActiveSet {
public:
  /// A pivot below this part of the largest one is rounding: its constraint is taken to follow from the
  /// others.
  static constexpr double dependent = 1e-11;
  /// Velocities and accelerations that may be left along a constraint that is taken to follow from others,
  /// against those of the bodies. A pivot goes with the square of the row, which may keep sqrt(dependent) =
  /// 3e-6 of them, and levers in piles amplify that: with 3e-6 twelve dominoes go through, twenty need more.
  /// Bodies that lie flush on each other stick and slip by less than this without anything being able to
  /// tell.
  static constexpr double left_by_dependent = 1e-4;

  /// \param memory must outlive it
  explicit ActiveSet(ActiveSetMemory& memory) : memory_(&memory) {}
  /// Tells which joints bind the bodies; they must outlive it, and be located wherever forces are asked for.
  void bind(const Assembly& assembly, ComponentsResponse& response);
  /// Of forces that are not unique the least in the sense of least squares that the law of contact allows, in
  /// place of any: for those who depend on them, since they are continuous, also where modes change.
  void ask_least() { least_ = true; }

  /// The contacts.
  [[nodiscard]] std::vector<ActiveContact>& list() { return contacts_; }
  [[nodiscard]] const std::vector<ActiveContact>& list() const { return contacts_; }

  /// Brings `at` and the coefficients of sliding contacts to a state.
  void update(const Detector& detector, const StateView& state, const Evaluation& evaluation,
              const GroundPlaces& places);
  /// Finds the forces and adds what they do to the accelerations. \param acceleration of all bodies, in:
  /// a_free False where no forces keep the constraints; the contacts' forces are then not finite.
  bool add_reactions(const Assembly& assembly, double* acceleration);
  /// How it found them. Constraints that follow from others are not among them, nor are forces that were
  /// left zero.
  [[nodiscard]] std::span<const ContactPivot> pivots() const {
    if (contacts_.empty()) return {};  // no forces were asked for
    return memory_->pivots;
  }
  /// True if the forces of the last add_reactions() are not unique: constraints follow from others.
  [[nodiscard]] bool has_open_forces() const { return memory_->margins.has_vectors(); }
  /// Calls f(first, numbers) for every change of the forces of the last add_reactions() that no constraint
  /// feels, as ForceMargins::for_vectors(): others may have found other forces.
  template <class F>
  void for_open_forces(F&& f) const {
    memory_->margins.for_vectors(contacts_, f);
  }
  /// Margins of the forces of the last add_reactions(), a number for every island of bodies that touch. Where
  /// forces are not unique, they are distributed so that the margin is largest.
  void margins(std::vector<ForceMargin>& out);

  /// Takes the gaps out of the positions, and what moves the constraints out of the velocities, by the
  /// smallest changes in the sense of the masses; both are added to changes of all velocity coordinates that
  /// are under way. False where there are none.
  bool corrections(const Assembly& assembly, const double* velocity, double* of_position,
                   double* of_velocity);

private:
  using Row = ContactPivot::Row;
  template <class F>
  void for_groups(F&& f);
  [[nodiscard]] bool find_islands();
  [[nodiscard]] Index mechanism(Index body) const;
  [[nodiscard]] bool answers_with_joints(std::size_t first, std::size_t last) const;
  [[nodiscard]] double lever(std::size_t contact) const;
  [[nodiscard]] static int row_of(const Row& row, const Constraint& at);
  void state_equations(const Assembly& assembly, std::size_t first, std::size_t last, bool slips);
  void scale_rows(bool matrix_too);
  [[nodiscard]] bool solve(bool again);
  void refine(double size, double* acceleration);
  void add_dry_friction(std::size_t first, std::size_t last, double* acceleration);
  bool react(std::size_t first, std::size_t last, double* acceleration);

  ActiveSetMemory* memory_;
  std::vector<ActiveContact> contacts_;
  const Assembly* assembly_ = nullptr;
  ComponentsResponse* response_ = nullptr;  // null where there are no joints
  bool least_ = false;
};

}  // namespace carom
