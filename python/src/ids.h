#pragma once

// Identities and ends.

#include "convert.h"

#include <carom/core/constraint.h>
#include <carom/core/end.h>
#include <carom/core/ids.h>

namespace carom_python {

template <class Tag>
struct IdName;
template <>
struct IdName<carom::BodyTag> {
  static constexpr const char* name = "BodyId";
};
template <>
struct IdName<carom::ElementTag> {
  static constexpr const char* name = "ElementId";
};
template <>
struct IdName<carom::ShapeTag> {
  static constexpr const char* name = "ShapeId";
};
template <>
struct IdName<carom::JointTag> {
  static constexpr const char* name = "JointId";
};
template <>
struct IdName<carom::ObstacleTag> {
  static constexpr const char* name = "ObstacleId";
};
template <>
struct IdName<carom::MaterialTag> {
  static constexpr const char* name = "MaterialId";
};

template <class Tag>
struct Convert<carom::Id<Tag>> {
  using Id = carom::Id<Tag>;
  static TypeNames names() {
    const std::string type = std::string("carom._core.") + IdName<Tag>::name;
    return {type, type, IdName<Tag>::name};
  }
  static void load(nb::handle from, Id& to, std::string_view where) {
    to = *static_cast<Id*>(load_instance(from, typeid(Id), where, std::string("a ") + IdName<Tag>::name));
  }
  static nb::object cast(const Id& value) { return nb::cast(value, nb::rv_policy::copy); }
};

/// A material by its name, until the part that has it is added to a system.
[[nodiscard]] carom::MaterialId named_material(const std::string& name);
/// The name of such a material; null of others.
[[nodiscard]] const std::string* name_of_material(carom::MaterialId id);

/// Materials are given by their identity, or by their name.
template <>
struct Convert<carom::MaterialId> {
  static TypeNames names() {
    return {"carom._core.MaterialId | str", "carom._core.MaterialId | str", "MaterialId"};
  }
  static void load(nb::handle from, carom::MaterialId& to, std::string_view where) {
    if (nb::isinstance<nb::str>(from)) {
      to = named_material(nb::cast<std::string>(from));
      return;
    }
    to = *static_cast<carom::MaterialId*>(
        load_instance(from, typeid(carom::MaterialId), where, "a MaterialId, or the name of a material"));
  }
  static nb::object cast(const carom::MaterialId& value) {
    if (const std::string* const name = name_of_material(value)) return nb::str(name->data(), name->size());
    return nb::cast(value, nb::rv_policy::copy);
  }
};

template <int D>
struct Convert<carom::End<D>> {
  static TypeNames names() {
    return {"carom._core.BodyId | tuple[carom._core.BodyId, numpy.typing.ArrayLike]",
            "carom._core.BodyId | tuple[carom._core.BodyId, numpy.typing.NDArray[numpy.float64]]",
            "end" + std::to_string(D)};
  }
  static void load(nb::handle from, carom::End<D>& to, std::string_view where) {
    constexpr const char* expected = "a body, or a body and a point (body, (x, y))";
    carom::End<D> read;
    if (nb::isinstance<carom::BodyId>(from)) {
      Convert<carom::BodyId>::load(from, read.body, where);
    } else {
      std::size_t found = 0;
      for_items(from, where, expected, [&](nb::handle item, std::size_t i) {
        ++found;
        if (i > 1) refuse(where, expected, from);
        if (i == 0) Convert<carom::BodyId>::load(item, read.body, std::string(where) + "[0]");
        if (i == 1) Convert<carom::Vec<D>>::load(item, read.point, std::string(where) + "[1]");
      });
      if (found != 2) refuse(where, expected, from);
      read.has_point = true;
    }
    to = read;
  }
  static nb::object cast(const carom::End<D>& value) {
    // Ground without a point is not ground at the origin.
    if (value.body == carom::ground && !value.has_point) return Convert<carom::BodyId>::cast(value.body);
    return nb::make_tuple(Convert<carom::BodyId>::cast(value.body),
                          Convert<carom::Vec<D>>::cast(value.point));
  }
};

}  // namespace carom_python
