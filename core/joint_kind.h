#pragma once

/// \file
/// Interface of a kind of joints: bilateral rows g(q, t) = 0, their first derivatives, and the terms of the
/// second ones without accelerations. Joints of one kind are stored together.

#include <carom/core/export.h>
#include <carom/core/fingerprint.h>
#include <carom/core/ids.h>
#include <carom/core/law_jump.h>
#include <carom/core/state.h>

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace carom {

/// State at which joints are evaluated, with the rotations of its bodies (Evaluation::rotation).
struct JointView {
  StateView state;                   ///< positions, velocities, time
  const double* rotation = nullptr;  ///< by BodySlot::rotation, up to date
};

/// A bilateral row g at one configuration:  dg/dt = G v + rate,  d2g/dt2 = G a + drift.
struct JointRow {
  static constexpr int max_bodies = 3;   ///< most bodies of a row
  static constexpr int max_columns = 3;  ///< most velocities of a body
  /// The part of G for one body.
  struct Block {
    Index v = none;   ///< first velocity of the body
    int columns = 0;  ///< velocities of the body
    std::array<double, static_cast<std::size_t>(max_columns)> jacobian{};
  };

  std::array<Block, static_cast<std::size_t>(max_bodies)> blocks{};  ///< of G
  int bodies = 0;                                                    ///< blocks in use
  double gap = 0.0;                                                  ///< g [m, rad]
  double rate = 0.0;   ///< dg/dt at rest: of a row that depends on time
  double drift = 0.0;  ///< d2g/dt2 without accelerations

  /// G times numbers. \param numbers an array over all velocities
  [[nodiscard]] double times(const double* numbers) const {
    double sum = 0.0;
    for (int b = 0; b < bodies; ++b) {
      const Block& block = blocks[static_cast<std::size_t>(b)];
      for (int c = 0; c < block.columns; ++c) {
        sum += block.jacobian[static_cast<std::size_t>(c)] * numbers[block.v + static_cast<Index>(c)];
      }
    }
    return sum;
  }
  /// Adds G^T times a number. \param out an array over all velocities
  void add_transposed(double factor, double* out) const {
    for (int b = 0; b < bodies; ++b) {
      const Block& block = blocks[static_cast<std::size_t>(b)];
      for (int c = 0; c < block.columns; ++c) {
        out[block.v + static_cast<Index>(c)] += factor * block.jacobian[static_cast<std::size_t>(c)];
      }
    }
  }
};

/// Derivatives of a row by positions and velocities, in the order of the velocities of its blocks; a
/// derivative by position is along that velocity.
struct JointRowDerivative {
  static constexpr int most = JointRow::max_bodies * JointRow::max_columns;
  using Numbers = std::array<double, static_cast<std::size_t>(most)>;

  std::array<Numbers, static_cast<std::size_t>(most)> jacobian{};  ///< dG_i / dq_j
  Numbers drift_by_position{};                                     ///< of `drift`
  Numbers drift_by_velocity{};                                     ///< of `drift`
};

/// Arrays for the rows of many joints, one for each quantity. Null: not needed.
struct JointNumbers {
  double* jacobian = nullptr;  ///< G: row by row, the blocks of a row one behind the other
  double* gap = nullptr;       ///< by row, never null
  double* rate = nullptr;      ///< by row; needed if rows depend on time
  double* drift = nullptr;     ///< by row
};

/// A unilateral row of a joint: gap >= 0, impulses that open it.
struct JointLimit {
  JointRow row;              ///< the gap and its derivatives
  double restitution = 0.0;  ///< coefficient of restitution
};

/// Dry friction along the coordinate of a joint.
struct JointDryFriction {
  double bound = 0.0;          ///< of the friction while it slides, constant part [N, N m]
  double static_factor = 1.0;  ///< ratio of the bound of sticking to that of sliding
  double coefficient = 0.0;  ///< of the force between the bodies of the joint, which adds to the bound [1, m]
};

/// Load of a joint on its body `to`; the opposite acts on `from`, at the same place.
struct JointReaction {
  std::array<double, 3> force{};  ///< on `to`, at its end, in the fixed frame [N], or impulse [N s]
  double moment = 0.0;            ///< on `to`, about its end, counter-clockwise [N m], or its impulse [N m s]
};

/// Points of the two bodies of a joint, in the fixed frame [m].
struct JointPlaces {
  std::array<double, 3> from{};  ///< of the end on `from`
  std::array<double, 3> to{};    ///< of the end on `to`
};

/// All joints of one kind.
class CAROM_API JointKind {
public:
  static constexpr Index most_rows = 6;  ///< of a joint: degrees of freedom between two bodies

  virtual ~JointKind() = default;

  /// A copy.
  [[nodiscard]] virtual std::unique_ptr<JointKind> clone() const = 0;
  /// A copy with the joints named by `order`, in that order, and their ends looked up in `layout`, which
  /// outlives it.
  [[nodiscard]] virtual std::unique_ptr<JointKind> arranged(std::span<const Index> order,
                                                            const Layout& layout) const = 0;
  /// Removes a joint; later ones move up.
  virtual void remove(Index slot) = 0;

  [[nodiscard]] virtual std::string_view label() const = 0;  ///< name used in messages, e.g. "revolute joint"
  [[nodiscard]] virtual int dimension() const = 0;           ///< 2 or 3
  [[nodiscard]] virtual Index size() const = 0;              ///< number of joints
  /// Rows of each joint, at most most_rows; they count as constraints.
  [[nodiscard]] virtual Index rows() const = 0;
  /// Appends the bodies of a joint (ground included).
  virtual void ends(Index joint, std::vector<BodyId>& out) const = 0;
  /// The joint on whose coordinate this one acts (a driver), or an invalid identity.
  [[nodiscard]] virtual JointId on_joint(Index /*joint*/) const { return {}; }

  /// Writes the velocities that the rows of a joint have blocks for, the same for all rows. Values are not
  /// used.
  virtual void pattern(Index joint, JointRow* out) const = 0;
  /// Writes the rows of a joint.
  virtual void evaluate(const JointView& at, Index joint, JointRow* out) const = 0;
  /// Writes the rows of several joints, in order. Unless overridden, one after the other by evaluate().
  virtual void evaluate_all(const JointView& at, Range joints, JointNumbers out) const;
  /// Writes the derivatives of the rows of a joint.
  virtual void derivatives(const JointView& at, Index joint, JointRowDerivative* out) const = 0;
  /// True if rows depend on time.
  [[nodiscard]] virtual bool depends_on_time() const { return false; }
  /// True if a joint prescribes its coordinate as a function of time.
  [[nodiscard]] virtual bool prescribes(Index /*joint*/) const { return false; }
  /// The coordinate that a joint prescribes and its rate at a time [s].
  [[nodiscard]] virtual LawPoint prescribed(Index /*joint*/, double time) const { return {.time = time}; }
  /// Appends the times at which the rate of a joint's law of time jumps, or a function of it has a kink [s].
  virtual void discontinuity_times(Index /*joint*/, std::vector<double>& /*out*/) const {}

  /// True if joints of this kind have a coordinate, on which drivers, motors and stops act.
  [[nodiscard]] virtual bool has_coordinate() const { return false; }
  /// Writes the coordinate of a joint (gap: its value) as a row.
  virtual void coordinate(const JointView& /*at*/, Index /*joint*/, JointRow& /*out*/) const {}
  /// Writes the derivatives of that row.
  virtual void coordinate_derivatives(const JointView& /*at*/, Index /*joint*/,
                                      JointRowDerivative& /*out*/) const {}
  /// Writes which velocities the coordinate's row has blocks for.
  virtual void coordinate_pattern(Index /*joint*/, JointRow& /*out*/) const {}
  /// Unilateral rows (limits) of each joint, in addition to rows().
  [[nodiscard]] virtual Index limits() const { return 0; }
  /// True if a joint has the unilateral row at that place.
  [[nodiscard]] virtual bool has_limit(Index /*joint*/, Index /*which*/) const { return false; }
  /// Writes a unilateral row.
  virtual void limit(const JointView& /*at*/, Index /*joint*/, Index /*which*/, JointLimit& /*out*/) const {}
  /// Name of a unilateral row in messages, e.g. "upper".
  [[nodiscard]] virtual std::string_view limit_label(Index /*which*/) const { return {}; }
  /// Rows of dry friction of each joint, in addition to rows(): 0, or 1 along the coordinate of the joint
  /// that it acts on.
  [[nodiscard]] virtual Index friction_rows() const { return 0; }
  /// The friction of a joint.
  [[nodiscard]] virtual JointDryFriction dry_friction(Index /*joint*/) const { return {}; }
  /// Load of the multipliers of the rows of a joint on its body `to`; for dry friction, that of the friction.
  [[nodiscard]] virtual JointReaction reaction(const JointView& at, Index joint,
                                               const double* multipliers) const = 0;
  /// Points of the bodies that a joint binds to each other; none if it binds no points, as a driver.
  [[nodiscard]] virtual std::optional<JointPlaces> places(const JointView& /*at*/, Index /*joint*/) const {
    return std::nullopt;
  }
  /// Adds all data that distinguish the joints of this kind (except functions).
  virtual void fingerprint(Fingerprint& print) const = 0;
};

/// The joints of an assembly by identity.
class CAROM_API JointTable {
public:
  /// Place of a joint.
  struct Place {
    Index kind = none;
    Index slot = none;
  };

  std::vector<std::unique_ptr<JointKind>> kinds;  ///< arranged
  std::vector<Place> places;                      ///< by serial number; slot `none` where there is none

  /// Place of a joint; slot `none` if there is none.
  [[nodiscard]] Place place(Index serial) const { return serial < places.size() ? places[serial] : Place{}; }
};

}  // namespace carom
