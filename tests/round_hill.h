#pragma once

// A user's own obstacle, known by its distance only.

#include <carom/core/ground_shape_kind.h>
#include <carom/core/part.h>
#include <carom/core/part_check.h>
#include <carom/core/space.h>

#include <memory>
#include <string_view>
#include <vector>

namespace carom_test {

class RoundHillKind;
/// A round hill, whose inside is solid.
struct RoundHill {
  static constexpr carom::Role role = carom::Role::obstacle;
  using Kind = RoundHillKind;
  carom::Vec<2> centre = carom::Vec<2>::Zero();  // [m]
  double radius = 1.0;                           // [m]
};

class RoundHillKind final : public carom::GroundShapeKind {
public:
  static constexpr int part_dimension() { return 2; }
  static constexpr std::string_view part_label() { return "round hill"; }
  void add(const RoundHill& part, const carom::PartCheck& check) {
    check.positive(part.radius, "radius", "m");
    parts_.push_back(part);
  }
  [[nodiscard]] std::unique_ptr<carom::ShapeKind> clone() const override {
    return std::make_unique<RoundHillKind>(*this);
  }
  void remove(carom::Index slot) override { parts_.erase(parts_.begin() + slot); }
  [[nodiscard]] std::string_view label() const override { return part_label(); }
  [[nodiscard]] int dimension() const override { return 2; }
  [[nodiscard]] carom::Index size() const override { return static_cast<carom::Index>(parts_.size()); }
  [[nodiscard]] carom::MaterialId material(carom::Index) const override { return {}; }
  [[nodiscard]] carom::Gap gap(carom::Index slot, const double* point) const override {
    const carom::Vec<2> from = carom::Vec<2>(point[0], point[1]) - parts_[slot].centre;
    const carom::Vec<2> n = from.normalized();
    return {from.norm() - parts_[slot].radius, {n[0], n[1], 0.0}};
  }
  void fingerprint(carom::Fingerprint& print) const override {
    for (const RoundHill& part : parts_) print.add(part.radius);
  }

private:
  std::vector<RoundHill> parts_;
};

}  // namespace carom_test
