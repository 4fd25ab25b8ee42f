#pragma once

/// \file
/// Rows that joints have in common with contacts: their limits, and dry friction along their coordinates.

#include <carom/contact/detection/contact_pair.h>
#include <carom/contact/detection/contact_query.h>
#include <carom/core/assembly.h>
#include <carom/core/constraint_set.h>
#include <carom/core/export.h>
#include <carom/core/joint_kind.h>

#include <array>
#include <vector>

namespace carom {

/// Limits of the joints of an assembly, by component, then friction in them, by component. A row is known by
/// its number in this list (Constraint::OfJoint::source, ContactPair::joint_row).
///
/// Coordinates that are angles count times an arm, Constraint::OfJoint::length: contacts, limits and friction
/// in joints are compared with each other and with speeds and gaps in m/s and m, and what is the faster of
/// two must not depend on the unit of length. The arm is that of the smallest change of velocities, spins
/// times radii of gyration, that makes a unit rate, 1/|(1/k_a, 1/k_b)| for the angle between two bodies; up
/// to a power of two, so that nothing is rounded.
class CAROM_API JointRows {
public:
  /// \param assembly outlives it
  explicit JointRows(const Assembly& assembly);

  /// True if there is none.
  [[nodiscard]] bool empty() const { return rows_.empty(); }
  /// True if there is friction in a joint.
  [[nodiscard]] bool has_friction() const { return first_friction_ < rows_.size(); }
  /// True if there is in a component.
  [[nodiscard]] bool has_friction(Index component) const {
    return !of_component_[component].friction.empty();
  }
  /// True of friction in a joint whose bound depends on the force of the joint. False of any other
  /// constraint.
  [[nodiscard]] bool depends_on_joint_force(const Constraint& constraint) const {
    if (constraint.of_joint.source == none) return false;
    const Row& row = rows_[constraint.of_joint.source];
    return row.kind->dry_friction(row.slot).coefficient > 0.0;
  }

  /// Appends the limits of one component that a query asks for.
  void find_limits(Index component, const ContactQuery& query, ConstraintSet& out) const;
  /// Appends the friction in the joints of one component as constraints, whose `friction_bound` has the
  /// constant part of the bound. Sets nothing of the past.
  void find_friction(Index component, const StateView& state, const Evaluation& evaluation,
                     ConstraintSet& out) const;
  /// Appends all limits of one component.
  void append_limits(Index component, std::vector<ContactPair>& out) const;
  /// Appends all friction in its joints.
  void append_friction(Index component, std::vector<ContactPair>& out) const;

  /// Writes a row as a constraint, whatever its gap.
  void constraint(Index number, const StateView& state, const Evaluation& evaluation, Constraint& out) const;
  /// Brings the row of friction in a joint to a configuration, and its drift.
  void update_friction(const JointView& at, Constraint& constraint) const;

private:
  // Bodies that a joint binds, in the order of assembly; `none` behind the last.
  using JointBodies = std::array<Index, std::size_t{Constraint::max_bodies}>;
  // A unilateral row of a joint, or friction in one.
  struct Row {
    const JointKind* kind;
    Index slot;
    Index limit;  // which of the joint's limits; `none`: friction
    Index serial;
    JointBodies bodies;
  };
  // Ranges of rows_.
  struct OfComponent {
    Range limits, friction;
  };

  // Calls f(a row without a limit) for joints of one component that may have limits or friction.
  template <class F>
  void for_joints(Index component, F&& f) const;
  template <class F>
  void collect(Range OfComponent::*rows, F&& add);
  void append(Range rows, std::vector<ContactPair>& out) const;
  [[nodiscard]] static ConstraintKey key_of(const Row& row);
  void fill_limit(Index number, const JointLimit& limit, Constraint& out) const;
  void fill_friction(Index number, const JointView& at, Constraint& out) const;
  // Makes a row of a joint that of a constraint, in lengths.
  void take(const JointRow& from, const JointBodies& bodies, Constraint& out) const;
  // Constraint::OfJoint::length of a row.
  [[nodiscard]] double length_of(const JointRow& coordinate) const;

  const Assembly* assembly_;
  std::vector<double> arms_;  // by velocity: radius of gyration of a spin [m], else 0
  std::vector<Row> rows_;
  Index first_friction_ = 0;  // behind the last limit
  std::vector<OfComponent> of_component_;
};

}  // namespace carom
