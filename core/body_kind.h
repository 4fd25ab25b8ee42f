#pragma once

/// \file
/// Interface of a kind of bodies. Bodies of one kind are stored together; every call is for a range of
/// them.

#include <carom/core/contact_filter.h>
#include <carom/core/export.h>
#include <carom/core/fingerprint.h>
#include <carom/core/ids.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

namespace carom {

/// How the masses of bodies of a kind lie in memory, for loops over many of them: body i of a range has
/// mass[stride * i], inertia[stride * i] and gyration_radius[stride * i].
struct BodyMasses {
  /// Meaning of the numbers of a body.
  enum class Layout : std::uint8_t {
    planar_points,   ///< two coordinates
    spatial_points,  ///< three coordinates
    planar_bodies    ///< two coordinates and an angle
  };
  Layout layout = Layout::planar_points;    ///< of coordinates and velocities
  Index stride = 1;                         ///< 0: all bodies have the same mass
  const double* mass = nullptr;             ///< [kg]
  const double* inertia = nullptr;          ///< of bodies that turn [kg m^2]
  const double* gyration_radius = nullptr;  ///< of bodies that turn [m]
};

/// All bodies of one kind. Slots are the places of bodies within the kind; `q` and `v` point at the numbers
/// of the first body of a range, bodies of a range being consecutive in every array.
class CAROM_API BodyKind {
public:
  virtual ~BodyKind() = default;

  /// A copy.
  [[nodiscard]] virtual std::unique_ptr<BodyKind> clone() const = 0;
  /// A kind with the data of a run for the bodies named by `order`, in that order. Starting values, contact
  /// points, materials and filters are read from the described kind only and need not be copied.
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
  /// Masses of the bodies from a slot on.
  [[nodiscard]] virtual BodyMasses masses(Index slot) const = 0;
  /// Length that weights a change of velocity coordinate `i`: 1 for translations, the radius of
  /// gyration [m] for rotations.
  [[nodiscard]] virtual double length_scale(Index slot, Index i) const = 0;
  /// True if the body can touch shapes on ground with its centre (a particle with `contact`).
  [[nodiscard]] virtual bool has_contact_point(Index slot) const = 0;
  /// Material of that contact point.
  [[nodiscard]] virtual MaterialId material(Index slot) const = 0;
  /// Groups that the contact point may touch. The fingerprint of a system takes it from here.
  [[nodiscard]] virtual ContactFilter filter(Index /*slot*/) const { return {}; }

  /// Writes coordinates and velocities as described.
  virtual void initial(Index slot, double* q, double* v) const = 0;
  /// Writes the rotations of a range (nothing for bodies without orientation).
  virtual void rotations(Range slots, const double* q, double* rotation) const = 0;
  /// q1 = q0 advanced along the motion whose velocity times time is `delta`.
  virtual void advance(Range slots, const double* q0, const double* delta, double* q1) const = 0;
  /// dq/dt of a range from its coordinates and velocities.
  virtual void coordinate_rates(Range slots, const double* q, const double* v, double* rates) const = 0;
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
