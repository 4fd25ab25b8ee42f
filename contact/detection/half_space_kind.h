#pragma once

/// \file
/// The kind of half-planes and half-spaces.

#include <carom/contact/detection/half_space.h>
#include <carom/core/ground_shape_kind.h>

#include <memory>
#include <string_view>
#include <vector>

namespace carom::generic {

/// All half-spaces of a system.
template <int D>
class CAROM_API HalfSpaceKind final : public GroundShapeKind {
public:
  static constexpr int part_dimension() { return D; }
  static constexpr std::string_view part_label() { return D == 2 ? "half-plane" : "half-space"; }

  /// Checks and stores a half-space. Throws ModelError.
  void add(const HalfSpace<D>& part, const PartCheck& check);

  [[nodiscard]] std::unique_ptr<ShapeKind> clone() const override;
  void remove(Index slot) override { parts_.erase(parts_.begin() + slot); }
  [[nodiscard]] std::string_view label() const override { return part_label(); }
  [[nodiscard]] int dimension() const override { return D; }
  [[nodiscard]] Index size() const override { return static_cast<Index>(parts_.size()); }
  [[nodiscard]] MaterialId material(Index slot) const override { return parts_[slot].material; }
  [[nodiscard]] ContactFilter filter(Index slot) const override { return parts_[slot].filter; }
  [[nodiscard]] bool moves(Index slot) const override;
  [[nodiscard]] bool is_flat(Index /*slot*/) const override { return true; }
  [[nodiscard]] double surface_speed(Index slot) const override;
  [[nodiscard]] GroundMotion place(Index slot, double time) const override;
  void discontinuity_times(Index slot, std::vector<double>& out) const override;
  [[nodiscard]] Gap gap(Index slot, const double* point) const override;
  [[nodiscard]] Gap moved_gap(Index slot, const GroundMotion& motion, const double* point) const override;
  [[nodiscard]] std::uint64_t points_within(Index slot, const PointRow& row, double margin) const override;
  [[nodiscard]] std::uint64_t points_within_moved(Index slot, const GroundMotion& motion, const PointRow& row,
                                                  double margin) const override;
  void fingerprint(Fingerprint& print) const override;

private:
  std::vector<HalfSpace<D>> parts_;  // normals of unit length
};

extern template class HalfSpaceKind<2>;
extern template class HalfSpaceKind<3>;

}  // namespace carom::generic
