#include "parts.h"

#include "python_element.h"

#include <map>

namespace carom_python {

namespace {

std::map<PyObject*, PartType>& table() {
  static std::map<PyObject*, PartType> parts;
  return parts;
}

}  // namespace

const PartType* part_type(nb::handle type) {
  const auto found = table().find(type.ptr());
  return found != table().end() ? &found->second : nullptr;
}

void register_part(nb::handle type, const PartType& part) { table()[type.ptr()] = part; }

std::string part_types(std::string_view role) {
  std::string types;
  for (const Record* record : records()) {
    if (record->role != role) continue;
    types += (types.empty() ? "" : " | ") + record->module + "." + record->name;
  }
  return types;
}

bool has_role(nb::handle part, carom::Role role) {
  const PartType* const type = part_type(part.type());
  return type != nullptr ? type->role == role : role == carom::Role::force && is_python_element(part);
}

const char* role_name(carom::Role role) {
  switch (role) {
    case carom::Role::body:
      return "body";
    case carom::Role::force:
      return "element";
    case carom::Role::joint:
      return "joint";
    case carom::Role::shape:
      return "shape";
    case carom::Role::obstacle:
      return "obstacle";
  }
  return "";
}

}  // namespace carom_python
