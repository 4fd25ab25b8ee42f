// Problem: the row of a moment against rolling.

#include <carom/contact/detection/rolling_resistance.h>

namespace carom {

Constraint rolling_resistance(const Constraint& contact, const GroundMotion* motion) {
  constexpr int of_planar_body = 3;
  Constraint row = contact;
  row.type = ConstraintType::rolling;
  row.rows = 1;
  row.friction = contact.law.rolling_resistance;
  row.law.tangential_restitution = contact.law.rolling_restitution;
  row.allowed_approach = 0.0;
  row.surface_velocity = row.surface_velocity_after = row.drift = {};
  if (motion != nullptr) {
    row.surface_velocity[0] = row.surface_velocity_after[0] = motion->spin;
    row.drift[0] = -motion->angular_acceleration;
  }
  row.jacobian = {};
  double* number = row.jacobian.data();
  double sign = 1.0;
  for (int b = 0; b < row.bodies; ++b, sign = -1.0) {
    const int columns = row.blocks[static_cast<std::size_t>(b)].columns;
    if (columns == of_planar_body) number[columns - 1] = sign;
    number += columns;
  }
  return row;
}

const GroundMotion* ground_motion_of(const Detector& detector, const Constraint& contact,
                                     const GroundPlaces& places) {
  if (contact.key.b.owner != FeatureKey::Owner::obstacle) return nullptr;
  const GroundShapes& shapes = detector.pieces().shapes();
  const Index shape = shapes.find(contact.key.b.serial);
  return shape == none || !shapes.moves(shape) ? nullptr : shapes.motion(shape, places);
}

}  // namespace carom
