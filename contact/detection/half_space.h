#pragma once

/// \file
/// Half-planes and half-spaces: shapes on ground, where a half-plane may move as prescribed.

#include <carom/contact/detection/prescribed_motion.h>
#include <carom/core/ground_shape_kind.h>
#include <carom/core/part.h>
#include <carom/core/part_check.h>
#include <carom/core/space.h>

#include <cmath>
#include <limits>
#include <vector>

namespace carom {

namespace generic {

// With the mark already here: HalfSpace<2> below names the class before its definition.
template <int D>
class CAROM_API HalfSpaceKind;

/// Everything behind a plane is solid.
template <int D>
struct HalfSpace {
  static constexpr Role role = Role::obstacle;
  using Kind = HalfSpaceKind<D>;

  Vec<D> point = Vec<D>::Zero();  ///< a point of the boundary [m]
  Vec<D> normal =
      Vec<D>::Constant(std::numeric_limits<double>::quiet_NaN());  ///< into free space, any length > 0
  MaterialId material{};                                           ///< for laws between materials
  ContactFilter filter{};                                          ///< what it may touch
};

/// Everything behind a line is solid; the line may move.
template <>
struct HalfSpace<2> {
  static constexpr Role role = Role::obstacle;
  using Kind = HalfSpaceKind<2>;

  Vec<2> point = Vec<2>::Zero();  ///< a point of the boundary, about which it turns [m]
  Vec<2> normal =
      Vec<2>::Constant(std::numeric_limits<double>::quiet_NaN());  ///< into free space, any length > 0
  MaterialId material{};                                           ///< for laws between materials
  planar::PrescribedMotion motion{};  ///< of `point`, and about it; empty: at rest
  double surface_speed =
      0.0;                 ///< of a conveyor along itself; positive to the right of who stands on it [m/s]
  ContactFilter filter{};  ///< what it may touch
};

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
  [[nodiscard]] bool any_within(Index slot, const double* points, Index stride, Index count,
                                double margin) const override;
  [[nodiscard]] bool any_within_moved(Index slot, const GroundMotion& motion, const double* points,
                                      Index stride, Index count, double margin) const override;
  void fingerprint(Fingerprint& print) const override;

private:
  std::vector<HalfSpace<D>> parts_;  // normals of unit length
};

extern template class HalfSpaceKind<2>;
extern template class HalfSpaceKind<3>;

}  // namespace generic

namespace planar {

using HalfPlane = generic::HalfSpace<2>;  ///< generic::HalfSpace in the plane

/// Normal of a plane through which the ground rises with +x at the angle `slope` [rad].
[[nodiscard]] inline Vec<2> incline(double slope) { return {-std::sin(slope), std::cos(slope)}; }

}  // namespace planar

namespace spatial {
using HalfSpace = generic::HalfSpace<3>;  ///< generic::HalfSpace in space
}

}  // namespace carom
