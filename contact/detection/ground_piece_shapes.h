#pragma once

/// \file
/// Storage of shapes on ground in the plane that are made of pieces, which outlines of bodies touch.

#include <carom/contact/detection/prescribed_motion.h>
#include <carom/core/ground_shape_kind.h>
#include <carom/core/part.h>
#include <carom/core/part_check.h>
#include <carom/core/space.h>

#include <cstdint>
#include <limits>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

namespace carom::generic {

/// All shapes of one description. `P` has label, pivot, motion, surface_speed, material, filter, and
/// std::vector<GroundPiece> pieces(PartCheck), which checks the rest and has places as described.
template <class P>
class PieceShapeKind final : public GroundShapeKind {
public:
  static constexpr int part_dimension() { return 2; }
  static constexpr std::string_view part_label() { return P::label; }

  /// Checks and stores a shape. Throws ModelError.
  void add(const P& part, const PartCheck& check) {
    check.material(part.material);
    check.finite({part.pivot.data(), 2}, "pivot", "m");
    check.finite(part.surface_speed, "surface_speed", "m/s");
    part.motion.check(check);
    std::vector<GroundPiece> pieces = part.pieces(check);
    for (GroundPiece& piece : pieces) {
      for (Vec<2>& point : piece.points) point -= part.pivot;
    }
    parts_.push_back({part, std::move(pieces)});
  }

  [[nodiscard]] std::unique_ptr<ShapeKind> clone() const override {
    return std::make_unique<PieceShapeKind>(*this);
  }
  void remove(Index slot) override { parts_.erase(parts_.begin() + slot); }
  [[nodiscard]] std::string_view label() const override { return part_label(); }
  [[nodiscard]] int dimension() const override { return 2; }
  [[nodiscard]] Index size() const override { return static_cast<Index>(parts_.size()); }
  [[nodiscard]] MaterialId material(Index slot) const override { return parts_[slot].part.material; }
  [[nodiscard]] ContactFilter filter(Index slot) const override { return parts_[slot].part.filter; }
  [[nodiscard]] bool moves(Index slot) const override { return !parts_[slot].part.motion.empty(); }
  [[nodiscard]] GroundMotion place(Index slot, double time) const override {
    return parts_[slot].part.motion.at(time, parts_[slot].part.pivot);
  }
  void discontinuity_times(Index slot, std::vector<double>& out) const override {
    const std::vector<double>& times = parts_[slot].part.motion.breaks;
    out.insert(out.end(), times.begin(), times.end());
  }
  void pieces(Index slot, std::vector<GroundPiece>& out) const override {
    out.insert(out.end(), parts_[slot].pieces.begin(), parts_[slot].pieces.end());
  }
  [[nodiscard]] double surface_speed(Index slot) const override { return parts_[slot].part.surface_speed; }
  [[nodiscard]] Gap gap(Index /*slot*/, const double* /*point*/) const override {
    return {std::numeric_limits<double>::infinity(), {0.0, 1.0, 0.0}};
  }
  [[nodiscard]] bool any_within(Index /*slot*/, const double* /*points*/, Index /*stride*/, Index /*count*/,
                                double /*margin*/) const override {
    return false;
  }
  [[nodiscard]] bool any_within_moved(Index /*slot*/, const GroundMotion& /*motion*/,
                                      const double* /*points*/, Index /*stride*/, Index /*count*/,
                                      double /*margin*/) const override {
    return false;
  }
  void fingerprint(Fingerprint& print) const override;

private:
  struct Stored {
    P part;
    std::vector<GroundPiece> pieces;  // from the pivot
  };

  std::vector<Stored> parts_;
};

template <class P>
void PieceShapeKind<P>::fingerprint(Fingerprint& print) const {
  for (const auto& [part, pieces] : parts_) {
    print.add(std::uint64_t{pieces.size()});
    for (const GroundPiece& piece : pieces) {
      print.add(static_cast<std::uint64_t>(piece.form));
      print.add(std::uint64_t{piece.points.size()});
      for (const Vec<2>& point : piece.points) print.add({point.data(), 2});
      print.add(piece.radius);
      print.add(piece.depth);
      print.add(std::uint64_t{piece.tail_is_free} + 2U * std::uint64_t{piece.head_is_free});
    }
    print.add({part.pivot.data(), 2});
    print.add(part.surface_speed);
    print.add(std::uint64_t{part.material.serial});
    // Functions cannot be hashed; that there is a motion, and its breaks, can.
    if (part.motion.empty()) continue;
    print.add("motion");
    print.add(part.motion.breaks);
  }
}

}  // namespace carom::generic
