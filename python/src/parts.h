#pragma once

// Parts of systems: described structs that can be added.

#include "types.h"

#include <carom/core/system.h>

#include <string>

namespace carom_python {

/// Parts of one type, as a system takes them.
struct PartType {
  carom::Role role = carom::Role::body;
  const Record* record = nullptr;
  /// Adds a part; returns its identity. \param surface null: none
  nb::object (*add)(carom::System& system, const void* part, const carom::Surface* surface,
                    std::string name) = nullptr;
  nb::object (*copy)(const void* part) = nullptr;
};

/// That of a Python type; null if none.
[[nodiscard]] const PartType* part_type(nb::handle type);
void register_part(nb::handle type, const PartType& part);
/// Types of one role, as in signatures: "carom._core.planar.Particle | ...". \param role as Record::role
[[nodiscard]] std::string part_types(std::string_view role);

/// An argument that is a part of one role: what overloads of System.add() are told apart by.
template <carom::Role role>
struct PartOf {
  nb::handle object;
};
/// Whether an object is a part of that role, one written in Python too.
[[nodiscard]] bool has_role(nb::handle part, carom::Role role);
[[nodiscard]] const char* role_name(carom::Role role);

/// Binds a part.
template <class P, class Describe>
void bind_part(nb::module_& module, const char* name, const std::vector<std::string>& doc_keys,
               const Describe& describe) {
  const nb::class_<P> type = bind_record<P>(module, name, doc_keys, true, describe);
  PartType part;
  part.role = P::role;
  part.record = record_of(type);
  const_cast<Record*>(part.record)->role = role_name(P::role);
  part.add = [](carom::System& system, const void* what, const carom::Surface* surface, std::string label) {
    const P& given = *static_cast<const P*>(what);
    if constexpr (P::role == carom::Role::obstacle) {
      if (surface != nullptr) return nb::cast(system.add(given, *surface, std::move(label)));
    }
    return nb::cast(system.add(given, std::move(label)));
  };
  part.copy = [](const void* what) { return nb::cast(P(*static_cast<const P*>(what))); };
  register_part(type, part);
}

}  // namespace carom_python

namespace nanobind::detail {

template <carom::Role role>
struct type_caster<carom_python::PartOf<role>> {
  NB_TYPE_CASTER(carom_python::PartOf<role>, const_name("object"))
  bool from_python(handle from, uint8_t /*flags*/, cleanup_list* /*cleanup*/) noexcept {
    value.object = from;
    return carom_python::has_role(from, role);
  }
};

}  // namespace nanobind::detail
