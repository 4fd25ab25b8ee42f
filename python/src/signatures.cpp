// What inspect.signature() needs of the types of compiled functions.

#include "bind.h"

namespace carom_python {

namespace nb = nanobind;

void bind_signatures(nb::module_& core) {
  // Types of nanobind refuse new attributes. Those of this module are its own (NB_DOMAIN), so nobody else
  // sees it.
  core.def(
      "_set_in_type",
      [](nb::handle type, nb::handle name, nb::handle value) {
        const nb::object held = nb::module_::import_("gc").attr("get_referents")(type.attr("__dict__"));
        nb::object members = held[0];
        members[name] = value;
        PyType_Modified(reinterpret_cast<PyTypeObject*>(type.ptr()));
      },
      nb::arg("type"), nb::arg("name"), nb::arg("value"),
      nb::sig("def _set_in_type(type: type, name: str, value: typing.Any) -> None"),
      "Sets an attribute of a type of compiled functions.");
}

}  // namespace carom_python
