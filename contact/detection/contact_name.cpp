#include <carom/contact/detection/contact_name.h>
#include <carom/core/registry.h>
#include <carom/core/system.h>

#include <vector>

namespace carom {

namespace {

[[noreturn]] void refuse(const char* side, const FeatureKey& key) {
  const char* owner = "an unknown owner";
  switch (key.owner) {
    case FeatureKey::Owner::body:
      owner = "body";
      break;
    case FeatureKey::Owner::shape:
      owner = "shape";
      break;
    case FeatureKey::Owner::obstacle:
      owner = "obstacle";
      break;
    case FeatureKey::Owner::joint:
      owner = "joint";
      break;
  }
  throw ModelError(std::string("contact: ") + side + " is feature " + std::to_string(key.feature) + " of " +
                   owner + " #" + std::to_string(key.serial) +
                   "; allowed: keys of contacts that reports and events of this model tell");
}

std::string joint_name(const System& system, const FeatureKey& key) {
  const JointKind* const kind = system.joint_kinds().kind_ever(key.serial);
  if (kind == nullptr) refuse("a", key);
  std::string name = system.name(JointId{key.serial, system.token()});
  if (key.feature < kind->limits()) return name + " (" + std::string(kind->limit_label(key.feature)) + ")";
  if (key.feature >= kind->limits() + kind->friction_rows()) refuse("a", key);
  return name;
}

std::string shape_name(const System& system, const FeatureKey& key, const char* side) {
  if (system.shape_kinds().kind_ever(key.serial) == nullptr) refuse(side, key);
  if (const auto place = system.shape_kinds().place(key.serial); place.slot != none) {
    std::vector<RoundedPoint> points;
    system.shape_kinds().entries()[place.entry].kind->rounded_points(place.slot, points);
    // Behind the points comes the outline as a whole; neighbours may add two corners to each side, before
    // that (DrawnOutline).
    const std::size_t most = points.size() > 2 ? 3 * points.size() : points.size();
    if (key.feature > most) refuse(side, key);
  }
  const ShapeId shape{key.serial, system.token()};
  return system.name(shape) + " (feature " + std::to_string(key.feature) + ") of " +
         system.name(system.body_of(shape));
}

/// Name of a feature of a body.
std::string body_side(const System& system, const FeatureKey& key, const char* side) {
  if (key.owner == FeatureKey::Owner::shape) return shape_name(system, key, side);
  if (key.owner != FeatureKey::Owner::body || system.body_kinds().kind_ever(key.serial) == nullptr) {
    refuse(side, key);
  }
  return system.name(BodyId{key.serial, system.token()});
}

}  // namespace

std::string contact_name(const System& system, const ConstraintKey& key) {
  if (key == ConstraintKey{}) return "no contact";
  if (key.a.owner == FeatureKey::Owner::joint) return joint_name(system, key.a);
  if (key.b.owner == FeatureKey::Owner::shape) {
    return body_side(system, key.a, "a") + " on " + shape_name(system, key.b, "b");
  }
  if (key.b.owner != FeatureKey::Owner::obstacle ||
      system.ground_shape_kinds().kind_ever(key.b.serial) == nullptr) {
    refuse("b", key.b);
  }
  return body_side(system, key.a, "a") + " on " + system.name(ObstacleId{key.b.serial, system.token()});
}

}  // namespace carom
