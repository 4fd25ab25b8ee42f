#include <carom/contact/detection/contact_name.h>
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
  if (kind->has_dry_friction()) return name;
  if (key.feature >= kind->limits()) refuse("a", key);
  return name + " (" + std::string(kind->limit_label(key.feature)) + ")";
}

std::string shape_name(const System& system, const FeatureKey& key) {
  if (system.shape_kinds().kind_ever(key.serial) == nullptr) refuse("a", key);
  if (const auto place = system.shape_kinds().place(key.serial); place.slot != none) {
    std::vector<RoundedPoint> points;
    system.shape_kinds().entries()[place.entry].kind->rounded_points(place.slot, points);
    if (key.feature >= points.size()) refuse("a", key);
  }
  const ShapeId shape{key.serial, system.token()};
  return system.name(shape) + " (feature " + std::to_string(key.feature) + ") of " +
         system.name(system.body_of(shape));
}

}  // namespace

std::string contact_name(const System& system, const ConstraintKey& key) {
  if (key == ConstraintKey{}) return "no contact";
  if (key.a.owner == FeatureKey::Owner::joint) return joint_name(system, key.a);
  if (key.b.owner != FeatureKey::Owner::obstacle ||
      system.ground_shape_kinds().kind_ever(key.b.serial) == nullptr) {
    refuse("b", key.b);
  }
  const std::string on_ground = " on " + system.name(ObstacleId{key.b.serial, system.token()});
  if (key.a.owner == FeatureKey::Owner::shape) return shape_name(system, key.a) + on_ground;
  if (key.a.owner != FeatureKey::Owner::body || system.body_kinds().kind_ever(key.a.serial) == nullptr) {
    refuse("a", key.a);
  }
  return system.name(BodyId{key.a.serial, system.token()}) + on_ground;
}

}  // namespace carom
