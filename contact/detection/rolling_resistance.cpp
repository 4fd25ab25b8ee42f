// Problem: the row of a moment against rolling.

#include <carom/contact/detection/rolling_resistance.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom {

namespace {

/// The longest lever of a contact, or the offset of its normal force where that is longer, up to a power of
/// two: spins and moments are not rounded by it. [m]
double arm_of(const Constraint& contact) {
  constexpr int of_planar_body = 3;
  double longest = contact.law.rolling_resistance;
  int column = 0;
  for (int b = 0; b < contact.bodies; ++b) {
    const int columns = contact.blocks[static_cast<std::size_t>(b)].columns;
    column += columns;
    if (columns < of_planar_body) continue;
    longest = std::max(longest, std::hypot(contact.row(0)[column - 1], contact.row(1)[column - 1]));
  }
  return std::exp2(std::ilogb(longest));
}

}  // namespace

void write_rolling_resistance(const Constraint& contact, const GroundMotion* motion, Constraint& row) {
  constexpr int of_planar_body = 3;
  const double arm = arm_of(contact);
  static_cast<ConstraintHead&>(row) = contact;
  row.normals = 0;
  row.attached = 1;
  row.start_rows(1);
  row.of_joint.length = arm;
  // The law along the spin: the same coefficient at rest and at any speed.
  row.friction = row.law.friction = row.law.rolling_resistance / arm;
  row.law.static_friction = std::numeric_limits<double>::quiet_NaN();
  row.law.stribeck_speed = 0.0;
  row.law.tangential_restitution = row.law.rolling_restitution;
  row.allowed_approach = 0.0;
  row.surface_velocity = row.surface_velocity_after = row.drift = {};
  if (motion != nullptr) {
    row.surface_velocity[0] = row.surface_velocity_after[0] = arm * motion->spin;
    row.drift[0] = -arm * motion->angular_acceleration;
  }
  double* number = row.row(0);
  std::fill_n(number, row.columns(), 0.0);
  double sign = arm;
  for (int b = 0; b < row.bodies; ++b, sign = -arm) {
    const int columns = row.blocks[static_cast<std::size_t>(b)].columns;
    if (columns == of_planar_body) number[columns - 1] = sign;
    number += columns;
  }
}

const GroundMotion* ground_motion_of(const Detector& detector, const Constraint& contact,
                                     const GroundPlaces& places) {
  if (contact.key.b.owner != FeatureKey::Owner::obstacle) return nullptr;
  const GroundShapes& shapes = detector.shapes();
  const Index shape = shapes.find(contact.key.b.serial);
  return shape == none || !shapes.moves(shape) ? nullptr : shapes.motion(shape, places);
}

}  // namespace carom
