// System: the model.

#include "bind.h"
#include "model.h"
#include "parts.h"
#include "python_element.h"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include <algorithm>
#include <array>
#include <utility>

namespace carom_python {

using namespace carom;

carom::System& Model::get() {
  if (closed) throw ModelError("system of an edit: it may be used until the function given to edit() ends");
  return system;
}

std::string find_python_part(const Journal& journal) {
  for (const Entry& entry : journal.entries) {
    if (is_python_element(entry.part)) {
      return entry.name.empty() ? "force element #" + std::to_string(entry.serial)
                                : "force element '" + entry.name + "'";
    }
    const Record* const record = record_of(entry.part.type());
    if (record == nullptr) continue;
    const void* const data = nb::inst_ptr<void>(entry.part);
    for (const Field& field : record->fields) {
      if (field.type->is_python == nullptr || !field.type->is_python(field.of(data))) continue;
      const std::string name =
          entry.name.empty() ? "#" + std::to_string(entry.serial) : "'" + entry.name + "'";
      return record->name + " " + name + ": " + field.name;
    }
  }
  return {};
}

std::string summary_of(const Journal& journal) {
  std::string text;
  if (!journal.title.empty()) text += " " + nb::cast<std::string>(nb::repr(nb::str(journal.title.c_str())));
  text += ":";
  constexpr std::array<std::pair<Role, const char*>, 5> roles{{{Role::body, "bodies"},
                                                               {Role::joint, "joints"},
                                                               {Role::force, "elements"},
                                                               {Role::shape, "shapes"},
                                                               {Role::obstacle, "obstacles"}}};
  for (const auto& [role, several] : roles) {
    const auto count = std::ranges::count(journal.entries, role, &Entry::role);
    if (count == 0) continue;
    text += (text.back() == ':' ? " " : ", ") + std::to_string(count) + " " +
            (count == 1 ? role_name(role) : several);
  }
  return text.back() == ':' ? text + " no parts" : text;
}

namespace {

template <class Id>
void drop(Model& model, Role role, Id id) {
  std::erase_if(model.entries,
                [&](const Entry& entry) { return entry.role == role && entry.serial == id.serial; });
}

Index serial_of(nb::handle id) { return nb::cast<Index>(id.attr("serial")); }

MaterialId material(Model& model, const std::string& name) {
  const MaterialId id = model.get().material(name);
  if (std::ranges::find(model.materials, name) == model.materials.end()) model.materials.push_back(name);
  model.names->add("MaterialId", id.serial, name);
  return id;
}

// A material given by its identity or its name; a new name makes a material.
MaterialId material_of(Model& model, nb::handle from, const char* where) {
  const auto id = read<MaterialId>(from, where);
  const std::string* const name = name_of_material(id);
  return name != nullptr ? material(model, *name) : id;
}

// A material that a law is asked for; a name must be one of the system.
MaterialId known_material(Model& model, nb::handle from, const char* where) {
  const auto id = read<MaterialId>(from, where);
  const std::string* const name = name_of_material(id);
  if (name == nullptr) return id;
  if (std::ranges::find(model.materials, *name) == model.materials.end()) {
    throw ModelError("material '" + *name + "': there is none" + nearest_of(*name, model.materials) +
                     "; allowed: the name of a material of this system");
  }
  return material(model, *name);
}

// Materials that a part has by their names become those of the system.
void find_materials(Model& model, const Record& record, void* part) {
  for (const Field& field : record.fields) {
    if (field.type != &field_type<MaterialId>()) continue;
    auto& id = *static_cast<MaterialId*>(field.of(part));
    if (const std::string* const name = name_of_material(id)) id = material(model, *name);
  }
}

// Adds a part; `surface` of a shape on ground, or null.
nb::object add(Model& model, nb::handle part, const Surface* surface, std::string name) {
  Entry entry;
  if (surface != nullptr) entry.surface = *surface;
  entry.name = name;
  nb::object id;
  if (const PartType* const type = part_type(part.type())) {
    entry.role = type->role;
    entry.part = type->copy(nb::inst_ptr<void>(part));
    find_materials(model, *type->record, nb::inst_ptr<void>(entry.part));
    id = type->add(model.get(), nb::inst_ptr<void>(entry.part), surface, std::move(name));
  } else {
    entry.role = Role::force;
    entry.part = nb::borrow(part);
    id = add_python_element(model.get(), part, std::move(name));
  }
  entry.serial = serial_of(id);
  entry.id = id;
  if (!entry.name.empty()) {
    model.names->add(nb::cast<std::string>(id.type().attr("__name__")), entry.serial, entry.name);
  }
  model.entries.push_back(std::move(entry));
  return id;
}

template <Role role>
void bind_add(nb::class_<Model>& type, const char* id) {
  std::string types = part_types(role_name(role));
  if (role == Role::force) types += " | carom._core.planar.ForceElement | carom._core.spatial.ForceElement";
  const std::string signature = "def add(self, part: " + types + ", name: str | None = None) -> " + id;
  type.def(
      "add",
      [](Model& self, PartOf<role> part, std::optional<std::string> name) {
        return add(self, part.object, nullptr, std::move(name).value_or(""));
      },
      nb::arg("part"), nb::arg("name") = nb::none(), nb::sig(signature.c_str()), doc("System.add"));
}

// Of shapes on ground, and what fits no other overload: add(part), add(part, "name"), add(part, surface),
// add(part, surface, "name").
nb::object add_obstacle(Model& model, nb::handle part, nb::handle surface, nb::handle name) {
  const bool known = part_type(part.type()) != nullptr || is_python_element(part);
  if (!known) refuse("add(): part", "a part of carom.planar or carom.spatial", part);
  std::string label;
  std::optional<Surface> law;
  if (nb::isinstance<nb::str>(surface) && name.is_none()) {
    label = nb::cast<std::string>(surface);
  } else if (!surface.is_none()) {
    Convert<std::optional<Surface>>::load(surface, law, "add(): surface");
  }
  if (!name.is_none()) Convert<std::string>::load(name, label, "add(): name");
  if (law && !has_role(part, Role::obstacle)) {
    throw nb::type_error("add(): surface: only shapes on ground are added with a Surface");
  }
  return add(model, part, law ? &*law : nullptr, std::move(label));
}

void between(Model& model, nb::handle first, nb::handle second, const Surface& surface) {
  const MaterialId a = material_of(model, first, "between(): a");
  const MaterialId b = material_of(model, second, "between(): b");
  model.get().between(a, b, surface);
  const auto name_of = [&](MaterialId id) {
    return id.serial < model.materials.size() ? model.materials[id.serial] : std::string();
  };
  model.laws.push_back({name_of(a), name_of(b), surface});
}

// A part as it was added. What it gives out is a copy: the system keeps what it was given.
void bind_entry(nb::module_& core) {
  nb::class_<Entry>(core, "AddedPart", "A part of a system, as it was added.")
      .def_prop_ro(
          "role", [](const Entry& self) { return role_name(self.role); },
          R"("body", "element", "joint", "shape" or "obstacle".)")
      .def_ro("id", &Entry::id, nb::sig("def id(self) -> typing.Any"), "Its identity.")
      .def_ro("name", &Entry::name, "Its name; empty if it was given none.")
      .def_prop_ro(
          "part",
          [](const Entry& self) {
            const PartType* const type = part_type(self.part.type());
            return type != nullptr ? type->copy(nb::inst_ptr<void>(self.part)) : self.part;
          },
          nb::sig("def part(self) -> typing.Any"),
          "The part: a copy of what was given; a force element in Python itself.")
      .def_prop_ro(
          "surface", [](const Entry& self) { return Convert<std::optional<Surface>>::cast(self.surface); },
          nb::sig("def surface(self) -> Surface | None"), "The contact law that an obstacle was added with.")
      .def("__repr__", [](const Entry& self) {
        const std::string shown = nb::cast<std::string>(nb::repr(self.part));
        return std::string("AddedPart(") + role_name(self.role) + ", " +
               nb::cast<std::string>(nb::repr(nb::str(self.name.c_str()))) + ", " + shown + ")";
      });
}

template <class Id>
void bind_for(nb::class_<Model>& type) {
  type.def(
          "remove",
          [](Model& self, Id id) {
            self.get().remove(id);
            constexpr Role role = std::is_same_v<Id, BodyId>      ? Role::body
                                  : std::is_same_v<Id, ElementId> ? Role::force
                                  : std::is_same_v<Id, JointId>   ? Role::joint
                                  : std::is_same_v<Id, ShapeId>   ? Role::shape
                                                                  : Role::obstacle;
            drop(self, role, id);
          },
          nb::arg("part"), doc("System.remove"))
      .def(
          "name", [](Model& self, Id id) { return self.get().name(id); }, nb::arg("part"), doc("System.name"))
      .def(
          "__contains__", [](Model& self, Id id) { return self.get().contains(id); }, doc("System.contains"));
}

void bind_queries(nb::class_<Model>& type) {
  type.def(
          "body", [](Model& self, const std::string& name) { return self.get().body(name); }, nb::arg("name"),
          doc("System.body"))
      .def(
          "element", [](Model& self, const std::string& name) { return self.get().element(name); },
          nb::arg("name"), doc("System.body"))
      .def(
          "joint", [](Model& self, const std::string& name) { return self.get().joint(name); },
          nb::arg("name"), doc("System.body"))
      .def(
          "shape", [](Model& self, const std::string& name) { return self.get().shape(name); },
          nb::arg("name"), doc("System.body"))
      .def(
          "obstacle", [](Model& self, const std::string& name) { return self.get().obstacle(name); },
          nb::arg("name"), doc("System.body"))
      .def(
          "given_name", [](Model& self, BodyId id) { return self.get().given_name(id); }, nb::arg("body"),
          doc("System.given_name"))
      .def(
          "body_of", [](Model& self, ShapeId id) { return self.get().body_of(id); }, nb::arg("shape"),
          doc("System.body_of"))
      .def(
          "has_orientation", [](Model& self, BodyId id) { return self.get().has_orientation(id); },
          nb::arg("body"), doc("System.has_orientation"))
      .def(
          "bodies", [](Model& self) { return Convert<std::vector<BodyId>>::cast(self.get().bodies()); },
          nb::sig("def bodies(self) -> list[BodyId]"), doc("System.bodies"))
      .def(
          "elements",
          [](Model& self) { return Convert<std::vector<ElementId>>::cast(self.get().elements()); },
          nb::sig("def elements(self) -> list[ElementId]"), doc("System.bodies"))
      .def(
          "joints", [](Model& self) { return Convert<std::vector<JointId>>::cast(self.get().joints()); },
          nb::sig("def joints(self) -> list[JointId]"), doc("System.bodies"))
      .def(
          "shapes", [](Model& self) { return Convert<std::vector<ShapeId>>::cast(self.get().shapes()); },
          nb::sig("def shapes(self) -> list[ShapeId]"), doc("System.bodies"))
      .def(
          "obstacles",
          [](Model& self) { return Convert<std::vector<ObstacleId>>::cast(self.get().obstacles()); },
          nb::sig("def obstacles(self) -> list[ObstacleId]"), doc("System.bodies"))
      .def(
          "dimension", [](Model& self) { return self.get().dimension(); }, doc("System.dimension"))
      .def(
          "fingerprint", [](Model& self) { return self.get().fingerprint(); }, doc("System.fingerprint"))
      .def(
          "check", [](Model& self) { return Convert<std::vector<ModelFinding>>::cast(self.get().check()); },
          nb::sig("def check(self) -> list[ModelFinding]"), doc("System.check"))
      .def(
          "parts",
          [](Model& self) {
            self.get();
            nb::list list;
            for (const Entry& entry : self.entries) list.append(nb::cast(entry));
            return list;
          },
          nb::sig("def parts(self) -> list[AddedPart]"),
          "All parts in the order in which they were added, without those removed.");
}

void bind_laws_of(nb::class_<Model>& type) {
  type.def("material", &material, nb::arg("name"), doc("System.material"))
      .def("between", &between, nb::arg("a"), nb::arg("b"), nb::arg("surface"),
           nb::sig("def between(self, a: MaterialId | str, b: MaterialId | str, surface: Surface) -> None"),
           (std::string(doc("System.between")) + " Materials may be given by their names.").c_str())
      .def(
          "set_default_law",
          [](Model& self, const Surface& surface) {
            self.get().set_default_law(surface);
            self.default_law = surface;
          },
          nb::arg("surface"), doc("System.set_default_law"))
      .def(
          "law",
          [](Model& self, nb::handle a, ObstacleId b) {
            const MaterialId one = known_material(self, a, "law(): a");
            return Convert<std::optional<Surface>>::cast(self.get().law(one, b));
          },
          nb::arg("a"), nb::arg("obstacle"),
          nb::sig("def law(self, a: MaterialId | str, obstacle: ObstacleId) -> Surface | None"),
          doc("System.law"))
      .def(
          "law",
          [](Model& self, nb::handle a, nb::handle b) {
            const MaterialId one = known_material(self, a, "law(): a"),
                             other = known_material(self, b, "law(): b");
            return Convert<std::optional<Surface>>::cast(self.get().law(one, other));
          },
          nb::arg("a"), nb::arg("b"),
          nb::sig("def law(self, a: MaterialId | str, b: MaterialId | str) -> Surface | None"),
          doc("System.law"))
      .def_prop_ro(
          "default_law",
          [](const Model& self) { return Convert<std::optional<Surface>>::cast(self.default_law); },
          nb::sig("def default_law(self) -> Surface | None"),
          "The law of pairs that have no other, if it was set.")
      .def_prop_ro(
          "materials",
          [](const Model& self) { return Convert<std::vector<std::string>>::cast(self.materials); },
          nb::sig("def materials(self) -> list[str]"), "Names of all materials, by their serial numbers.")
      .def(
          "laws",
          [](const Model& self) {
            nb::list list;
            for (const LawEntry& law : self.laws)
              list.append(nb::make_tuple(law.a, law.b, nb::cast(law.surface)));
            return list;
          },
          nb::sig("def laws(self) -> list[tuple[str, str, Surface]]"),
          "Laws between materials, by their names, in the order in which they were set.")
      .def(
          "keep_place", [](Model& self, BodyId body, bool keep) { self.get().keep_place(body, keep); },
          nb::arg("body"), nb::arg("keep") = true, doc("System.keep_place"))
      .def(
          "keeps_place", [](Model& self, BodyId body) { return self.get().keeps_place(body); },
          nb::arg("body"), doc("System.keeps_place"))
      .def(
          "close_joints", [](Model& self, bool however_far) { self.get().close_joints(however_far); },
          nb::arg("however_far") = true, doc("System.close_joints"))
      .def(
          "closes_joints", [](Model& self) { return self.get().closes_joints(); },
          doc("System.closes_joints"))
      .def(
          "allow_contact",
          [](Model& self, BodyId a, BodyId b, std::optional<bool> allowed) {
            self.get().allow_contact(a, b, allowed);
          },
          nb::arg("a"), nb::arg("b"), nb::arg("allowed").none() = true, doc("System.allow_contact"))
      .def(
          "is_contact_allowed",
          [](Model& self, BodyId a, BodyId b) { return self.get().is_contact_allowed(a, b); }, nb::arg("a"),
          nb::arg("b"), doc("System.is_contact_allowed"))
      .def(
          "contact_decisions",
          [](Model& self) {
            nb::list list;
            for (const auto& [a, b, allowed] : self.get().contact_decisions())
              list.append(nb::make_tuple(a.serial, b.serial, allowed));
            return list;
          },
          nb::sig("def contact_decisions(self) -> list[tuple[int, int, bool]]"),
          doc("System.contact_decisions"));
}

}  // namespace

void bind_system(nb::module_& core) {
  bind_entry(core);
  nb::class_<Model> type(core, "System", doc("System"));
  type.def(nb::init<>())
      .def("__copy__",
           [](Model& self) {
             self.get();
             return Model(self);
           })
      .def(
          "__deepcopy__",
          [](Model& self, nb::handle /*memo*/) {
            self.get();
            return Model(self);
          },
          nb::arg("memo"))
      .def("__getstate__",
           [](nb::handle self) { return nb::module_::import_("carom.travel").attr("packed_system")(self); })
      .def("__setstate__",
           [](Model& self, nb::handle packed) {
             const nb::object made = nb::module_::import_("carom.travel").attr("unpacked_system")(packed);
             new (&self) Model(nb::cast<Model&>(made));
           })
      .def_rw(
          "title", &Model::title,
          "What the model is called where it is shown; load_scene() gives the name of the file. No part of "
          "the model.")
      .def("__repr__", [](const Model& self) { return "<System" + summary_of(self) + ">"; });
  bind_add<Role::body>(type, "BodyId");
  bind_add<Role::force>(type, "ElementId");
  bind_add<Role::joint>(type, "JointId");
  bind_add<Role::shape>(type, "ShapeId");
  const std::string obstacle =
      "def add(self, part: " + part_types(role_name(Role::obstacle)) +
      ", surface: Surface | str | None = None, name: str | None = None) -> ObstacleId";
  type.def("add", &add_obstacle, nb::arg("part"), nb::arg("surface") = nb::none(),
           nb::arg("name") = nb::none(), nb::sig(obstacle.c_str()), doc("System.add"));
  bind_for<BodyId>(type);
  bind_for<ElementId>(type);
  bind_for<JointId>(type);
  bind_for<ShapeId>(type);
  bind_for<ObstacleId>(type);
  bind_queries(type);
  bind_laws_of(type);
}

}  // namespace carom_python
