#include "ids.h"

#include "bind.h"
#include "part_names.h"

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

namespace carom_python {

namespace {

template <class Tag>
void bind_id(nb::module_& core, const char* text) {
  using Id = carom::Id<Tag>;
  nb::class_<Id>(core, IdName<Tag>::name, text)
      .def(nb::init<>(), "Of no part.")
      .def_ro("serial", &Id::serial, "Serial number within its system.")
      .def_ro("token", &Id::token, "Token of the system that gave it.")
      .def("valid", &Id::valid, "True if it was given by a system, or is the ground.")
      .def(
          "__eq__",
          [](const Id& self, nb::handle other) {
            return nb::isinstance<Id>(other) && self == nb::cast<const Id&>(other);
          },
          nb::arg("other").none(), nb::sig("def __eq__(self, other: object, /) -> bool"))
      .def("__hash__",
           [](const Id& self) {
             return std::hash<std::uint64_t>()(self.serial * 0x100000001ULL ^ self.token);
           })
      .def("__bool__", &Id::valid)
      .def("__repr__", [](const Id& self) {
        std::string shown = IdName<Tag>::name;
        if (!self.valid()) return shown + "()";
        if constexpr (std::is_same_v<Id, carom::BodyId>) {
          if (self == carom::ground) return std::string("ground");
        }
        const std::string name = find_part_name(IdName<Tag>::name, self.token, self.serial);
        const std::string text =
            name.empty() ? "" : ", " + nb::cast<std::string>(nb::repr(nb::str(name.c_str())));
        return shown + "(" + std::to_string(self.serial) + text + ")";
      });
}

}  // namespace

namespace {

/// Names of materials that parts have before they are added. The token is of no system.
constexpr carom::Index named_token = static_cast<carom::Index>(-2);

std::vector<std::string>& material_names() {
  static std::vector<std::string> names;
  return names;
}

}  // namespace

carom::MaterialId named_material(const std::string& name) {
  std::vector<std::string>& names = material_names();
  const auto found = std::find(names.begin(), names.end(), name);
  const auto place = static_cast<carom::Index>(found - names.begin());
  if (found == names.end()) names.push_back(name);
  return {place, named_token};
}

const std::string* name_of_material(carom::MaterialId id) {
  return id.token == named_token ? &material_names()[id.serial] : nullptr;
}

void bind_ids(nb::module_& core) {
  bind_id<carom::BodyTag>(core, "Identity of a body.");
  bind_id<carom::ElementTag>(core, "Identity of a force element.");
  bind_id<carom::ShapeTag>(core, "Identity of a shape of a body.");
  bind_id<carom::JointTag>(core, "Identity of a joint.");
  bind_id<carom::ObstacleTag>(core, "Identity of a shape on ground.");
  bind_id<carom::MaterialTag>(core, "Identity of a material.");
  core.attr("ground") = nb::cast(carom::ground);
}

}  // namespace carom_python
