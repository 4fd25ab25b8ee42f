#pragma once

/// \file
/// Storage of planar shapes that touch a half-plane with rounded points, and each other with convex outlines.

#include <carom/core/export.h>
#include <carom/core/part.h>
#include <carom/core/part_check.h>
#include <carom/core/shape_kind.h>

#include <vector>

namespace carom::generic {

/// Adds bodies, materials and rounded points of all shapes of a kind.
CAROM_API void add_features(Fingerprint& print, const ShapeKind& shapes);

/// All shapes of one description. `P` has body, material, label, check(PartCheck),
/// features(std::vector<RoundedPoint>&) and, if it touches other bodies, Outline outline(PartCheck); it may
/// have a filter.
template <class P>
class FeatureShapeKind final : public ShapeKind {
public:
  static constexpr int part_dimension() { return P::dimension; }
  static constexpr std::string_view part_label() { return P::label; }

  /// Checks and stores a shape. Throws ModelError.
  void add(const P& part, const PartCheck& check) {
    check.oriented_body(part.body, "body");
    check.material(part.material);
    if constexpr (requires { part.filter; }) check.filter(part.filter);
    part.check(check);
    parts_.push_back(part);
  }

  [[nodiscard]] std::unique_ptr<ShapeKind> clone() const override {
    return std::make_unique<FeatureShapeKind>(*this);
  }
  void remove(Index slot) override { parts_.erase(parts_.begin() + slot); }
  [[nodiscard]] std::string_view label() const override { return part_label(); }
  [[nodiscard]] int dimension() const override { return P::dimension; }
  [[nodiscard]] Index size() const override { return static_cast<Index>(parts_.size()); }
  [[nodiscard]] BodyId body(Index slot) const override { return parts_[slot].body; }
  [[nodiscard]] MaterialId material(Index slot) const override { return parts_[slot].material; }
  [[nodiscard]] ContactFilter filter(Index slot) const override {
    if constexpr (requires { parts_[slot].filter; }) {
      return parts_[slot].filter;
    } else {
      return ShapeKind::filter(slot);
    }
  }
  void rounded_points(Index slot, std::vector<RoundedPoint>& out) const override {
    parts_[slot].features(out);
  }
  void outlines(Index slot, const PartCheck& check, std::vector<Outline>& out) const override {
    if constexpr (requires { parts_[slot].outline(check); }) out.push_back(parts_[slot].outline(check));
  }
  void fingerprint(Fingerprint& print) const override { add_features(print, *this); }

private:
  std::vector<P> parts_;
};

}  // namespace carom::generic
