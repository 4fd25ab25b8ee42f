#pragma once

/// \file
/// Storage of shapes on ground in the plane that are made of pieces, which outlines of bodies touch.

#include <carom/contact/detection/prescribed_motion.h>
#include <carom/core/export.h>
#include <carom/core/ground_shape_kind.h>
#include <carom/core/part.h>
#include <carom/core/part_check.h>
#include <carom/core/space.h>

#include <limits>
#include <memory>
#include <string_view>
#include <vector>

namespace carom::generic {

/// Pieces as described, from the pivot on. Throws ModelError for what is no piece: GroundPiece says what is.
[[nodiscard]] CAROM_API std::vector<GroundPiece> moved_by(std::vector<GroundPiece> pieces,
                                                          const Vec<2>& pivot, const PartCheck& check);
/// Demands finite numbers and a motion that can be.
CAROM_API void check_motion(const PartCheck& check, const Vec<2>& pivot, double surface_speed,
                            const planar::PrescribedMotion& motion);
/// Appends the times at which a motion has kinks [s].
CAROM_API void append_breaks(const planar::PrescribedMotion& motion, std::vector<double>& out);
/// Adds the pieces of a shape.
CAROM_API void add_pieces(Fingerprint& print, const std::vector<GroundPiece>& pieces);
/// Adds how a shape moves, and of what it is. Functions cannot be hashed; that there is a motion, and its
/// breaks, can.
CAROM_API void add_motion(Fingerprint& print, const Vec<2>& pivot, double surface_speed, MaterialId material,
                          const planar::PrescribedMotion& motion);

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
    check.filter(part.filter);
    check_motion(check, part.pivot, part.surface_speed, part.motion);
    parts_.push_back({part, moved_by(part.pieces(check), part.pivot, check)});
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
    append_breaks(parts_[slot].part.motion, out);
  }
  void pieces(Index slot, std::vector<GroundPiece>& out) const override {
    out.insert(out.end(), parts_[slot].pieces.begin(), parts_[slot].pieces.end());
  }
  [[nodiscard]] double surface_speed(Index slot) const override { return parts_[slot].part.surface_speed; }
  [[nodiscard]] Gap gap(Index /*slot*/, const double* /*point*/) const override {
    return {std::numeric_limits<double>::infinity(), {0.0, 1.0, 0.0}};
  }
  [[nodiscard]] std::uint64_t points_within(Index /*slot*/, const PointRow& /*row*/,
                                            double /*margin*/) const override {
    return 0;
  }
  [[nodiscard]] std::uint64_t points_within_moved(Index /*slot*/, const GroundMotion& /*motion*/,
                                                  const PointRow& /*row*/, double /*margin*/) const override {
    return 0;
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
    add_pieces(print, pieces);
    add_motion(print, part.pivot, part.surface_speed, part.material, part.motion);
  }
}

}  // namespace carom::generic
