#pragma once

/// \file
/// The kind of particles.

#include <carom/bodies/particle.h>
#include <carom/core/body_kind.h>
#include <carom/core/column.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

namespace carom::generic {

/// All particles of a system.
template <int D>
class CAROM_API ParticleKind final : public BodyKind {
public:
  static constexpr int part_dimension() { return D; }
  static constexpr std::string_view part_label() { return "particle"; }

  /// Checks and stores a particle. Throws ModelError.
  void add(const Particle<D>& part, const PartCheck& check);

  [[nodiscard]] std::unique_ptr<BodyKind> clone() const override;
  [[nodiscard]] std::unique_ptr<BodyKind> arranged(std::span<const Index> order) const override;
  void remove(Index slot) override;
  [[nodiscard]] std::string_view label() const override { return part_label(); }
  [[nodiscard]] int dimension() const override { return D; }
  [[nodiscard]] Index size() const override { return masses_.size(); }
  [[nodiscard]] Index q_size() const override { return D; }
  [[nodiscard]] Index v_size() const override { return D; }
  [[nodiscard]] bool has_orientation() const override { return false; }
  [[nodiscard]] double mass(Index slot) const override { return masses_[slot]; }
  [[nodiscard]] BodyMasses masses(Index slot) const override {
    constexpr auto layout = D == 2 ? BodyMasses::Layout::planar_points : BodyMasses::Layout::spatial_points;
    return {.layout = layout, .stride = masses_.stride(), .mass = masses_.data() + masses_.stride() * slot};
  }
  [[nodiscard]] double length_scale(Index, Index) const override { return 1.0; }
  [[nodiscard]] bool has_contact_point(Index slot) const override { return contact_[slot] != 0; }
  [[nodiscard]] MaterialId material(Index slot) const override { return material_[slot]; }
  [[nodiscard]] ContactFilter filter(Index slot) const override { return filter_[slot]; }
  void initial(Index slot, double* q, double* v) const override;
  void rotations(Range, const double*, double*) const override {}
  void advance(Range slots, const double* q0, const double* delta, double* q1) const override;
  void coordinate_rates(Range slots, const double* q, const double* v, double* rates) const override;
  void apply_inverse_mass(Range slots, const double* f, double* a) const override;
  void apply_mass(Range slots, const double* v, double* p) const override;
  [[nodiscard]] double kinetic_energy(Range slots, const double* v) const override;
  void add_weight(Range slots, const double* g, double* load) const override;
  [[nodiscard]] double weight_potential(Range slots, const double* g, const double* q) const override;
  void fingerprint(Fingerprint& print) const override;

private:
  Column<double> masses_;
  // The description; empty in an arranged kind.
  Column<Vec<D>> position_, velocity_;
  Column<std::uint8_t> contact_;
  Column<MaterialId> material_;
  Column<ContactFilter> filter_;
};

extern template class ParticleKind<2>;
extern template class ParticleKind<3>;

}  // namespace carom::generic
