// Problem: parts come to a model one by one, each checked before anything is changed.

#include <carom/core/stored_parts.h>

namespace carom {

std::string System::describe(std::string_view label, const std::string& name, Index serial) {
  std::string text(label);
  return name.empty() ? text + " #" + std::to_string(serial) : text + " '" + name + "'";
}

void System::take_dimension(int dimension, std::string_view label) const {
  if (dimension == 0 || dimension_ == 0 || dimension == dimension_) return;
  throw ModelError(std::string(label) + ": dimension is " + std::to_string(dimension) +
                   "; allowed: " + std::to_string(dimension_) + ", as the other parts of the system");
}

void System::check_name(Role role, const std::string& name, std::string_view label) const {
  if (name.empty()) return;
  const auto names = stored().serials_by_name.find(role);
  if (names == stored().serials_by_name.end() || !names->second.contains(name)) return;
  throw ModelError(std::string(label) + " '" + name +
                   "': name is taken; allowed: a name no other part of its role has");
}

template <class K>
Index System::add_to(Role role, const PartType<K>& type, const void* part, std::string name) {
  Registry<K>& registry = stored().of<K>();
  const Index serial = registry.next_serial();
  take_dimension(type.dimension, type.label);
  check_name(role, name, type.label);
  registry.add(type, part, PartCheck(describe(type.label, name, serial), *this));
  added(role, type.dimension, serial, std::move(name));
  return serial;
}

// Here, so that programs do not compile them for every part.
template CAROM_API Index System::add_to(Role, const PartType<BodyKind>&, const void*, std::string);
template CAROM_API Index System::add_to(Role, const PartType<ForceKind>&, const void*, std::string);
template CAROM_API Index System::add_to(Role, const PartType<JointKind>&, const void*, std::string);
template CAROM_API Index System::add_to(Role, const PartType<ShapeKind>&, const void*, std::string);
template CAROM_API Index System::add_to(Role, const PartType<GroundShapeKind>&, const void*, std::string);

void System::check_surface(const Surface& surface, std::string_view label, const std::string& name) const {
  PartCheck(describe(label, name, stored().ground_shapes.next_serial()), *this).surface(surface);
}

void System::set_own_law(ObstacleId id, const Surface& surface) {
  stored().surfaces.set_own(id.serial, surface);
}

void System::added(Role role, int dimension, Index serial, std::string name) {
  if (dimension_ == 0) dimension_ = dimension;
  if (name.empty()) return;
  stored().serials_by_name[role].emplace(name, serial);
  stored().names[role].emplace(serial, std::move(name));
}

}  // namespace carom
