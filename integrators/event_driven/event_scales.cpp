// Problem: tell motion from rounding.

#include <carom/integrators/event_driven/event_scales.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace carom {

double unit_length(const EventDriven& options) {
  constexpr double gap_tolerances = 1e9;
  return gap_tolerances * options.gap_tolerance;
}

// Gaps this small against the coordinates are rounding of sums of a few terms.
double gap_noise_of(double size, const EventDriven& options) {
  constexpr double gap_rounding = 256.0 * std::numeric_limits<double>::epsilon();
  return gap_rounding * std::max(unit_length(options), size);
}

// Velocities this small against those before an impact are zero: answers of contact problems are certified to
// 1e-12. So are those well below the tolerance, which would start phases that end at once.
double speed_noise_of(double velocity, double absolute_tolerance) {
  constexpr double speed_rounding = 1e-12;
  return speed_rounding * velocity + 0.1 * absolute_tolerance;
}

double EventScales::noise_of(const SmoothMotion& motion, const Constraint& contact) const {
  if (!contact.attached) return speed_noise;
  const std::vector<double>& lengths = motion.memory().closure.lengths;
  double length = std::numeric_limits<double>::infinity();
  for (int b = 0; b < contact.bodies; ++b) {
    const Constraint::Block& block = contact.blocks[static_cast<std::size_t>(b)];
    length = std::min(length, lengths[block.v + static_cast<Index>(block.columns) - 1]);
  }
  return speed_noise * (contact.of_joint.length / length);
}

namespace {

// Forces this small against those around them are zero. Answers of contact problems are certified to 1e-12,
// and far from the origin places are rounded, and with them the levers of contacts, which forces follow from.
double force_rounding_of(double place, double lever) {
  constexpr double by_answers = 1e-11, by_places = 16.0 * std::numeric_limits<double>::epsilon();
  return std::max(by_answers, by_places * place / lever);
}

/// Sizes of the bodies of a group [m].
struct BodySizes {
  double gap = 0.0;                                        // other numbers that gaps are made of
  double place = 0.0;                                      // coordinates of places
  double lever = std::numeric_limits<double>::infinity();  // least radius of gyration
};

/// Takes in the bodies of a component.
void add_sizes(const Component& component, const SmoothMotion& motion, const State& state, BodySizes& sizes) {
  // Up to one turn an angle counts with an arm of the unit of length, which has margin for most bodies; more
  // turns count with the radius of gyration.
  constexpr double turn = 2.0 * std::numbers::pi;
  const double unit = unit_length(*motion.model().options);
  for (Index body = component.bodies.begin; body < component.bodies.end; ++body) {
    const BodySlot slot = motion.model().assembly->layout()->bodies()[body];
    const Index places = slot.rotation == none ? slot.v_size : 2;
    for (Index k = 0; k < places; ++k) sizes.place = std::max(sizes.place, std::abs(state.q[slot.q + k]));
    if (slot.rotation == none) continue;
    const double angle = std::abs(state.q[slot.q + 2]), length = motion.memory().closure.lengths[slot.v + 2];
    const double turned =
        std::min(angle, turn) * std::max(unit, length) + std::max(angle - turn, 0.0) * length;
    sizes.gap = std::max({sizes.gap, turned, size_of_body(length)});
    sizes.lever = std::min(sizes.lever, length);
  }
}

}  // namespace

EventScales event_scales(const SmoothMotion& motion, const MotionSample& at,
                         std::span<const Constraint> contacts) {
  const std::vector<double>& lengths = motion.memory().closure.lengths;
  const EventDriven& options = *motion.model().options;
  EventScales scales;
  BodySizes sizes;
  double velocity = 0.0;
  for (const auto& part : motion.model().parts()) {
    const Range v = part.ranges.v;
    add_sizes(part.ranges, motion, at.state, sizes);
    for (Index i = v.begin; i < v.end; ++i) {
      velocity = std::max(velocity, std::abs(at.state.v[i]) * lengths[i]);
      scales.force = std::max(scales.force, std::abs(at.loads()[i]) / lengths[i]);
    }
  }
  scales.force_rounding = force_rounding_of(sizes.place, sizes.lever);
  scales.gap_noise = gap_noise_of(std::max(sizes.gap, sizes.place), options);
  for (const Constraint& contact : contacts) {
    if (contact.attached) continue;  // a spin, as fast as its contact
    velocity = std::max(velocity, std::abs(contact.surface_velocity[0]));
    velocity = std::max(velocity, std::abs(contact.surface_velocity[1]));
  }
  const double tolerance = options.absolute_tolerance;
  scales.speed = velocity;
  scales.speed_noise = speed_noise_of(velocity, tolerance);
  // A step may be wrong by the tolerance.
  scales.guard_noise = std::max(scales.gap_noise, tolerance);
  return scales;
}

}  // namespace carom
