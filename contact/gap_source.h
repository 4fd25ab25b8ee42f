#pragma once

/// \file
/// Where bodies that are moved stand, and the gaps that they have there: what `separate` asks (separation.h).

#include <carom/core/constraint.h>
#include <carom/core/dynamics/body_response.h>
#include <carom/core/export.h>
#include <carom/core/state.h>

#include <span>
#include <vector>

namespace carom {

/// Bodies that may be moved, from where they stand by displacements over all velocities (a displacement has
/// the units of a velocity times a time), and the contacts that they have.
class CAROM_API GapSource {
public:
  virtual ~GapSource() = default;

  /// Contacts where the bodies are: all that are closed, and those up to `margin` apart [m]. Of each the gap
  /// and row 0 are read. They may be reordered, and are valid until the next call.
  [[nodiscard]] virtual std::span<Constraint> find(double margin) = 0;
  /// Number of bodies that contacts are of.
  [[nodiscard]] virtual Index bodies() const = 0;
  /// The first of the bodies that answer together with one.
  [[nodiscard]] virtual Index first_together(Index body) const = 0;
  /// Velocities of all bodies that may be moved.
  [[nodiscard]] virtual Range velocities() const = 0;
  /// Length by which a displacement is weighed, by velocity: 1 of a place, an arm of an angle [m].
  [[nodiscard]] virtual const std::vector<double>& lengths() const = 0;
  /// Gaps of this size are rounding of the coordinates [m].
  [[nodiscard]] virtual double rounding() const = 0;

  /// Displacements are from where all bodies are now.
  virtual void begin() = 0;
  /// The bodies of contacts that share some, and those that answer together with them, are the ones at hand
  /// from now on. Returns their velocities, one range a body.
  [[nodiscard]] virtual std::span<const Range> select(std::span<const Constraint> contacts) = 0;
  /// Answer of the bodies at hand to impulses.
  [[nodiscard]] virtual BodyResponse& response() = 0;
  /// Places bodies at hand by a displacement; the others stay.
  virtual void move(const double* displacement) = 0;
  /// Gaps are found where the bodies have been moved to.
  virtual void update() = 0;

  /// True if a gap of the joints of the bodies at hand is larger than `depth` [m].
  [[nodiscard]] virtual bool is_off(double depth) = 0;
  /// Adds the smallest displacement d0 of the bodies at hand that closes their joints: J d0 = J d - j.
  /// \param displacement d, by which they have been moved \param sum d0 is added to it
  virtual void close_joints(const double* displacement, double* sum) = 0;
};

}  // namespace carom
