#pragma once

/// \file
/// The kind of rigid bodies.

#include <carom/bodies/rigid_body.h>
#include <carom/core/body_kind.h>

#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace carom::generic {

template <int D>
class RigidBodyKind;

/// All planar rigid bodies of a system.
template <>
class CAROM_API RigidBodyKind<2> final : public BodyKind {
public:
  static constexpr int part_dimension() { return 2; }
  static constexpr std::string_view part_label() { return "rigid body"; }

  /// Checks and stores a body. Throws ModelError.
  void add(const RigidBody<2>& part, const PartCheck& check);

  [[nodiscard]] std::unique_ptr<BodyKind> clone() const override;
  [[nodiscard]] std::unique_ptr<BodyKind> arranged(std::span<const Index> order) const override;
  void remove(Index slot) override;
  [[nodiscard]] std::string_view label() const override { return part_label(); }
  [[nodiscard]] int dimension() const override { return 2; }
  [[nodiscard]] Index size() const override { return static_cast<Index>(masses_.size()); }
  [[nodiscard]] Index q_size() const override { return 3; }
  [[nodiscard]] Index v_size() const override { return 3; }
  [[nodiscard]] bool has_orientation() const override { return true; }
  [[nodiscard]] double mass(Index slot) const override { return masses_[slot].mass; }
  [[nodiscard]] BodyMasses masses(Index slot) const override {
    const Inertia& first = masses_[slot];
    return {.layout = BodyMasses::Layout::planar_bodies,
            .stride = sizeof(Inertia) / sizeof(double),
            .mass = &first.mass,
            .inertia = &first.inertia,
            .gyration_radius = &first.gyration_radius};
  }
  [[nodiscard]] double length_scale(Index slot, Index i) const override {
    return i < 2 ? 1.0 : masses_[slot].gyration_radius;
  }
  [[nodiscard]] bool has_contact_point(Index) const override { return false; }
  [[nodiscard]] MaterialId material(Index) const override { return {}; }
  void initial(Index slot, double* q, double* v) const override;
  void rotations(Range slots, const double* q, double* rotation) const override;
  void advance(Range slots, const double* q0, const double* delta, double* q1) const override;
  void coordinate_rates(Range slots, const double* q, const double* v, double* rates) const override;
  void apply_inverse_mass(Range slots, const double* f, double* a) const override;
  void apply_mass(Range slots, const double* v, double* p) const override;
  [[nodiscard]] double kinetic_energy(Range slots, const double* v) const override;
  void add_weight(Range slots, const double* g, double* load) const override;
  [[nodiscard]] double weight_potential(Range slots, const double* g, const double* q) const override;
  void fingerprint(Fingerprint& print) const override;

private:
  struct Inertia {
    double mass, inertia, gyration_radius;
  };
  std::vector<Inertia> masses_;
  std::vector<RigidBody<2>> parts_;  // the description; empty in an arranged kind
};

}  // namespace carom::generic
