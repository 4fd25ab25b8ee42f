#include <carom/contact/detection/ground_piece_shapes.h>
#include <carom/core/described_sets.h>

#include <cstdint>

namespace carom::generic {

std::vector<GroundPiece> moved_by(std::vector<GroundPiece> pieces, const Vec<2>& pivot,
                                  const PartCheck& check) {
  check_pieces(check, pieces);
  for (GroundPiece& piece : pieces) {
    for (Vec<2>& point : piece.points) point -= pivot;
  }
  return pieces;
}

void check_motion(const PartCheck& check, const Vec<2>& pivot, double surface_speed,
                  const planar::PrescribedMotion& motion) {
  check.finite({pivot.data(), 2}, "pivot", "m");
  check.finite(surface_speed, "surface_speed", "m/s");
  motion.check(check);
}

void add_pieces(Fingerprint& print, const std::vector<GroundPiece>& pieces) {
  print.add(std::uint64_t{pieces.size()});
  for (const GroundPiece& piece : pieces) {
    print.add(static_cast<std::uint64_t>(piece.form));
    print.add(std::uint64_t{piece.points.size()});
    for (const Vec<2>& point : piece.points) print.add({point.data(), 2});
    print.add(piece.radius);
    print.add(piece.depth);
    print.add(std::uint64_t{piece.tail_is_free} + 2U * std::uint64_t{piece.head_is_free});
  }
}

void append_breaks(const planar::PrescribedMotion& motion, std::vector<double>& out) {
  out.insert(out.end(), motion.breaks.begin(), motion.breaks.end());
}

void add_motion(Fingerprint& print, const Vec<2>& pivot, double surface_speed, MaterialId material,
                const planar::PrescribedMotion& motion) {
  print.add({pivot.data(), 2});
  print.add(surface_speed);
  print.add(std::uint64_t{material.serial});
  if (motion.empty()) return;
  print.add("motion");
  print.add(motion.breaks);
}

}  // namespace carom::generic
