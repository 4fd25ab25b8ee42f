#include <carom/contact/detection/ground_jump.h>

#include <cstddef>

namespace carom {

std::array<double, 3> jump_along_rows(std::span<const GroundJump> jumps, const Constraint& constraint,
                                      const double* q) {
  constexpr int of_planar_body = 3;
  std::array<double, 3> sum{};
  if (constraint.key.b.owner != FeatureKey::Owner::obstacle) return sum;
  for (const GroundJump& jump : jumps) {
    if (jump.serial != constraint.key.b.serial) continue;
    // The place goes with the shape as it would with a body that moves with the shape.
    const std::array<double, of_planar_body> along{jump.velocity[0] - jump.spin * (q[1] - jump.point[1]),
                                                   jump.velocity[1] + jump.spin * (q[0] - jump.point[0]),
                                                   jump.spin};
    for (int row = 0; row < constraint.rows; ++row) {
      const double* const numbers = constraint.row(row);
      for (int i = 0; i < constraint.blocks[0].columns; ++i)
        sum[static_cast<std::size_t>(row)] += numbers[i] * along[static_cast<std::size_t>(i)];
    }
  }
  return sum;
}

}  // namespace carom
