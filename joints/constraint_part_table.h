#pragma once

/// \file
/// Storage of the constraint parts of planar joints, and their rows.

#include <carom/core/column.h>
#include <carom/core/export.h>
#include <carom/core/joint_kind.h>
#include <carom/core/layout.h>
#include <carom/core/space.h>
#include <carom/joints/constraint_part.h>

#include <span>
#include <type_traits>
#include <vector>

namespace carom::planar {

/// The constraint parts of many joints of one kind, property by property: a value that all joints share is
/// stored once. All constraint parts of a joint are between the same ends; conditions on angles alone do not
/// depend on the points.
class CAROM_API ConstraintPartTable {
public:
  /// Appends a joint. All joints have the same number of constraint parts.
  void add(std::span<const ConstraintPart> constraints);
  /// Removes a joint; later ones move up.
  void erase(Index joint);
  /// The joints named by `order`, in that order, with their places in the arrays.
  [[nodiscard]] ConstraintPartTable arranged(std::span<const Index> order, const Layout& layout) const;

  [[nodiscard]] Index size() const { return static_cast<Index>(ends_.size()); }  ///< number of joints
  /// A constraint part of a joint, as it was added.
  [[nodiscard]] ConstraintPart constraint(Index joint, Index which) const;
  /// Appends the bodies of a joint.
  void ends(Index joint, std::vector<BodyId>& out) const;
  /// Adds all that distinguishes the joints.
  void fingerprint(Fingerprint& print) const;

  /// Writes which velocities the rows of a joint have blocks for. The table must be an arranged one, here and
  /// below.
  void pattern(Index joint, JointRow& row) const;
  /// Writes one row of a joint.
  void evaluate(const JointView& at, Index joint, Index which, JointRow& row) const;
  /// Writes the first `rows` rows of several joints.
  void evaluate(const JointView& at, Range joints, Index rows, JointNumbers out) const;
  /// Writes the derivatives of one row of a joint.
  void derivatives(const JointView& at, Index joint, Index which, JointRowDerivative& out) const;
  /// Points of the ends of a joint.
  [[nodiscard]] JointPlaces places(const JointView& at, Index joint) const;
  /// Load of the multipliers of the first `rows` rows on `to`.
  [[nodiscard]] JointReaction reaction(const JointView& at, Index joint, Index rows,
                                       const double* multipliers) const;

private:
  // Serial numbers of bodies.
  struct Ends {
    Index from, to;
  };
  // Coefficients of angles.
  struct Turns {
    double from, to, carrier;
  };
  // A condition, of all joints.
  struct Condition {
    Column<ConstraintPart::Form> form;
    Column<Vec<2>> axis;
    Column<Turns> turns;
    Column<double> offset;
  };
  // Place of a body.
  struct Place {
    Index q = none, v = none, rotation = none;

    [[nodiscard]] Vec<2> lever(const JointView& at, const Vec<2>& local) const;
    [[nodiscard]] Vec<2> position(const JointView& at, const Vec<2>& local, const Vec<2>& lever) const;
    [[nodiscard]] Vec<2> velocity(const JointView& at, const Vec<2>& lever) const;
    [[nodiscard]] double spin(const JointView& at) const {
      return rotation == none ? 0.0 : at.state.v[v + 2];
    }
    [[nodiscard]] double angle(const JointView& at) const {
      return rotation == none ? 0.0 : at.state.q[q + 2];
    }
    [[nodiscard]] int columns() const { return rotation == none ? 2 : 3; }
  };
  struct Places {
    Place from, to;
  };
  struct Geometry;
  [[nodiscard]] BodyId id(Index serial) const {
    return serial == ground.serial ? ground : BodyId{serial, token_};
  }
  template <bool WithMotion = true>
  [[nodiscard]] Geometry geometry(const JointView& at, Index joint) const;
  template <bool WithDrift>
  void evaluate_rows(const JointView& at, Range joints, Index rows, JointNumbers out) const;
  // Rows along axes that do not turn, without angles (constraint_pins.cpp).
  [[nodiscard]] bool are_pins(Index rows) const;
  void evaluate_pins(const JointView& at, Range joints, Index rows, JointNumbers out) const;
  template <Index Rows>
  void evaluate_pins(const JointView& at, Range joints, std::integral_constant<Index, Rows> rows,
                     JointNumbers out) const;
  [[nodiscard]] Vec<2> direction(const JointView& at, const Geometry& geometry, const Condition& condition,
                                 Index joint) const;
  template <bool WithDrift>
  double* write(const JointView& at, const Geometry& geometry, const Condition& condition, Index joint,
                double& gap, double& drift, double* jacobian) const;

  std::vector<Condition> conditions_;
  std::vector<Ends> ends_;
  Column<Index> carrier_;  // serial numbers
  Column<Vec<2>> from_point_, to_point_;
  Index token_ = 0;
  // Of an arranged table.
  std::vector<Places> places_;
  Column<Place> carrier_place_;  // nowhere unless it has a part in a row
};

}  // namespace carom::planar
