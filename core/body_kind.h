#pragma once

/// \file
/// Interface of a kind of bodies. Bodies of one kind are stored together; every call is for a range of
/// them.

#include <carom/core/export.h>
#include <carom/core/fingerprint.h>
#include <carom/core/ids.h>

#include <memory>
#include <span>
#include <string_view>

namespace carom {

/// Arrays of one sweep of the trapezoidal rule; each points at the first number of a range of bodies.
struct SweepArrays {
  const double* q0 = nullptr;        ///< coordinates at the start of the step
  const double* v0 = nullptr;        ///< velocities at the start
  const float* carried = nullptr;    ///< compensation of the velocities: their rounding errors
  const double* load0 = nullptr;     ///< loads at the start
  const double* load1 = nullptr;     ///< loads at the end, of the previous iterate
  const double* response = nullptr;  ///< change of velocity by contact, null without contact
  double* q1 = nullptr;              ///< out: coordinates at the end
  double* v1 = nullptr;              ///< out: velocities at the end
  float* cut = nullptr;              ///< out: rounding error of v1
  /// Turn by 2 atan(h w/2) instead of h w, w the mean spin. A lever r then moves by h w x (r0 + r1)/2
  /// exactly, so that a force at the mean lever does the work of its own displacement.
  bool rational_turn = false;
};

/// Arrays of the loads before and after a sweep, like SweepArrays.
struct LoadArrays {
  const double* made_with = nullptr;  ///< x
  const double* led_to = nullptr;     ///< g
  const double* q1 = nullptr;         ///< coordinates the sweep led to
  const double* v1 = nullptr;         ///< velocities the sweep led to
};

/// Difference between an iterate and the next, angles times the radius of gyration [m].
struct SweepChange {
  double change = 0.0;  ///< largest change of positions and of h times velocities; NaN if any is
  double size = 0.0;    ///< largest of the numbers themselves

  /// Takes one number: its change and its size. A NaN is kept.
  void take(double difference, double number) {
    difference = difference < 0.0 ? -difference : difference;
    number = number < 0.0 ? -number : number;
    // Written so that a NaN is stored, and kept because no number compares greater.
    if (difference > change || difference != difference) change = difference;
    if (number > size || number != number) size = number;
  }
};

/// All bodies of one kind. Slots are the places of bodies within the kind; `q` and `v` point at the numbers
/// of the first body of a range, bodies of a range being consecutive in every array.
class CAROM_API BodyKind {
public:
  virtual ~BodyKind() = default;

  /// A copy.
  [[nodiscard]] virtual std::unique_ptr<BodyKind> clone() const = 0;
  /// A kind with the data of a run for the bodies named by `order`, in that order. Starting values, contact
  /// points and materials are read from the described kind only and need not be copied.
  [[nodiscard]] virtual std::unique_ptr<BodyKind> arranged(std::span<const Index> order) const = 0;
  /// Removes the body at a slot; later ones move up.
  virtual void remove(Index slot) = 0;

  /// Name used in messages, e.g. "particle".
  [[nodiscard]] virtual std::string_view label() const = 0;
  /// 2 or 3.
  [[nodiscard]] virtual int dimension() const = 0;
  /// Number of bodies.
  [[nodiscard]] virtual Index size() const = 0;
  /// Coordinates of one body.
  [[nodiscard]] virtual Index q_size() const = 0;
  /// Velocities of one body.
  [[nodiscard]] virtual Index v_size() const = 0;
  /// True if coordinates include an orientation.
  [[nodiscard]] virtual bool has_orientation() const = 0;
  /// Mass [kg].
  [[nodiscard]] virtual double mass(Index slot) const = 0;
  /// Length that weights a change of velocity coordinate `i`: 1 for translations, the radius of
  /// gyration [m] for rotations.
  [[nodiscard]] virtual double length_scale(Index slot, Index i) const = 0;
  /// True if the body can touch obstacles with its centre (a particle with `contact`).
  [[nodiscard]] virtual bool has_contact_point(Index slot) const = 0;
  /// Material of that contact point.
  [[nodiscard]] virtual MaterialId material(Index slot) const = 0;

  /// Writes coordinates and velocities as described.
  virtual void initial(Index slot, double* q, double* v) const = 0;
  /// Writes the rotations of a range (nothing for bodies without orientation).
  virtual void rotations(Range slots, const double* q, double* rotation) const = 0;
  /// q1 = q0 advanced along the motion whose velocity times time is `delta`.
  virtual void advance(Range slots, const double* q0, const double* delta, double* q1) const = 0;
  /// dq/dt of a range from its coordinates and velocities.
  virtual void coordinate_rates(Range slots, const double* q, const double* v, double* rates) const = 0;
  /// One sweep of the implicit trapezoidal rule with step h, bodies of a range at once:
  ///     v1 = v0 + M^-1 h (load0 + load1)/2 + response,   q1 = q0 advanced by h (v0 + v1)/2.
  virtual void sweep(Range slots, double step, const SweepArrays& arrays) const = 0;
  /// Change that another sweep, with g instead of x, would make: velocities by `weight` M^-1 (g - x), and
  /// coordinates by h/2 times that, which is less than h times it.
  virtual void next_change(Range slots, double weight, double step, const LoadArrays& loads,
                           SweepChange& change) const = 0;
  /// a = M^-1 f.
  virtual void apply_inverse_mass(Range slots, const double* f, double* a) const = 0;
  /// p = M v.
  virtual void apply_mass(Range slots, const double* v, double* p) const = 0;
  /// Kinetic energy of a range [J].
  [[nodiscard]] virtual double kinetic_energy(Range slots, const double* v) const = 0;
  /// Adds the weight of a range in the uniform field g [m/s^2] to generalised loads [N].
  virtual void add_weight(Range slots, const double* g, double* load) const = 0;
  /// Potential energy -sum m g.x of a range in that field [J].
  [[nodiscard]] virtual double weight_potential(Range slots, const double* g, const double* q) const = 0;
  /// Adds all data that distinguish the bodies of this kind.
  virtual void fingerprint(Fingerprint& print) const = 0;
};

}  // namespace carom
