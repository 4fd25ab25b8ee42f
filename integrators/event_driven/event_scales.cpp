// Problem: tell motion from rounding.

#include <carom/integrators/event_driven/event_scales.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace carom {

// Gaps this small against the coordinates are rounding of sums of a few terms.
double gap_noise_of(double size) {
  constexpr double gap_rounding = 256.0 * std::numeric_limits<double>::epsilon();
  return gap_rounding * std::max(1.0, size);
}

// Velocities this small against those before an impact are zero: answers of contact problems are certified to
// 1e-12. So are those well below the tolerance, which would start phases that end at once.
double speed_noise_of(double velocity, double absolute_tolerance) {
  constexpr double speed_rounding = 1e-12;
  return speed_rounding * velocity + 0.1 * absolute_tolerance;
}

double EventScales::noise_of(const SmoothMotion& motion, const Constraint& contact) const {
  if (contact.type != ConstraintType::rolling) return speed_noise;
  const std::vector<double>& lengths = motion.memory().lengths;
  double length = std::numeric_limits<double>::infinity();
  for (int b = 0; b < contact.bodies; ++b) {
    const Constraint::Block& block = contact.blocks[static_cast<std::size_t>(b)];
    length = std::min(length, lengths[block.v + static_cast<Index>(block.columns) - 1]);
  }
  return speed_noise / length;
}

EventScales event_scales(const SmoothMotion& motion, const MotionSample& at,
                         std::span<const Constraint> contacts) {
  const std::vector<double>& lengths = motion.memory().lengths;
  EventScales scales;
  // Up to one turn an angle counts with an arm of 1 m, which has margin for most bodies; more turns count
  // with the radius of gyration. Of other coordinates the length is 1.
  constexpr double turn = 2.0 * std::numbers::pi;
  double size = 0.0, velocity = 0.0;
  for (const auto& part : motion.model().parts()) {
    const Range q = part.ranges.q, v = part.ranges.v;
    for (Index i = v.begin; i < v.end; ++i) {
      // In the plane, and of particles, coordinates have the order of velocities.
      const double q_i = std::abs(at.state.q[q.begin + i - v.begin]);
      size = std::max(size, std::min(q_i, turn) + std::max(q_i - turn, 0.0) * lengths[i]);
      velocity = std::max(velocity, std::abs(at.state.v[i]) * lengths[i]);
      scales.force = std::max(scales.force, std::abs(at.loads()[i]) / lengths[i]);
    }
  }
  scales.gap_noise = gap_noise_of(size);
  for (const Constraint& contact : contacts) {
    if (contact.type == ConstraintType::rolling) continue;  // a spin, as fast as its contact
    velocity = std::max(velocity, std::abs(contact.surface_velocity[0]));
    velocity = std::max(velocity, std::abs(contact.surface_velocity[1]));
  }
  const double tolerance = motion.model().options->absolute_tolerance;
  scales.speed_noise = speed_noise_of(velocity, tolerance);
  // A step may be wrong by the tolerance.
  scales.guard_noise = std::max(scales.gap_noise, tolerance);
  return scales;
}

}  // namespace carom
