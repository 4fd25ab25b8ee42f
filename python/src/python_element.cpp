#include "python_element.h"

#include "bind.h"

#include <map>

namespace carom_python {

using namespace carom;

namespace {

/// View of the state that an element is lent for one call; it shows nothing afterwards.
template <int D>
struct View {
  const ElementView<D>* at = nullptr;
  const ElementView<D>& get() const {
    if (at == nullptr) throw ModelError("view of a force element: it may be used during the call only");
    return *at;
  }
};
template <int D>
struct LoadsOut {
  ElementLoads<D>* out = nullptr;
  ElementLoads<D>& get() const {
    if (out == nullptr) throw ModelError("loads of a force element: they may be given during the call only");
    return *out;
  }
};

std::vector<double> breaks_of(nb::handle part) {
  if (!nb::hasattr(part, "breaks")) return {};
  return read<std::vector<double>>(part.attr("breaks"), "breaks");
}

}  // namespace

template <int D>
void PythonElement<D>::loads(const ElementView<D>& at, ElementLoads<D>& out) const {
  const nb::gil_scoped_acquire lock;
  View<D> view{&at};
  LoadsOut<D> given{&out};
  nb::object seen = nb::cast(&view, nb::rv_policy::copy), loads_out = nb::cast(&given, nb::rv_policy::copy);
  const auto close = [&] {
    nb::inst_ptr<View<D>>(seen)->at = nullptr;
    nb::inst_ptr<LoadsOut<D>>(loads_out)->out = nullptr;
  };
  try {
    call_python([&] { return object.get().attr("loads")(seen, loads_out); });
  } catch (...) {
    close();
    throw;
  }
  close();
}

template <int D>
double PythonElement<D>::potential(const ElementView<D>& at) const {
  const nb::gil_scoped_acquire lock;
  View<D> view{&at};
  nb::object seen = nb::cast(&view, nb::rv_policy::copy);
  try {
    const nb::object given = call_python([&] { return object.get().attr("potential")(seen); });
    const double value = read<double>(given, "result of potential()");
    nb::inst_ptr<View<D>>(seen)->at = nullptr;
    return value;
  } catch (...) {
    nb::inst_ptr<View<D>>(seen)->at = nullptr;
    throw;
  }
}

template <int D>
void PythonElement<D>::fingerprint(Fingerprint& print) const {
  const nb::gil_scoped_acquire lock;
  if (!nb::hasattr(object.get(), "fingerprint")) return;
  print.add(read<std::vector<double>>(object.get().attr("fingerprint")(), "result of fingerprint()"));
}

template struct PythonElement<2>;
template struct PythonElement<3>;

namespace {

/// Base class of elements in Python.
template <int D>
struct ForceElementBase {};

template <int D>
nb::object add_element(System& system, nb::handle part, std::string name) {
  PythonElement<D> element;
  element.object = Shared(nb::borrow(part));
  element.ends = read<std::vector<BodyId>>(part.attr("bodies")(), "result of bodies()");
  element.breaks = breaks_of(part);
  return nb::cast(system.add(element, std::move(name)));
}

template <int D>
void bind_element(nb::module_& module) {
  using V = View<D>;
  using L = LoadsOut<D>;
  auto view = nb::class_<V>(module, "ElementView", doc("ElementView"));
  view.def_prop_ro(
          "time", [](const V& self) { return self.get().time(); }, "Time [s].")
      .def(
          "position",
          [](const V& self, nb::handle end) {
            return Convert<Vec<D>>::cast(self.get().position(read<End<D>>(end, "position(): end")));
          },
          nb::arg("end"),
          nb::sig("def position(self, end: carom._core.BodyId | tuple[carom._core.BodyId, "
                  "numpy.typing.ArrayLike]) -> numpy.typing.NDArray[numpy.float64]"),
          doc("ElementView.position"))
      .def(
          "velocity",
          [](const V& self, nb::handle end) {
            return Convert<Vec<D>>::cast(self.get().velocity(read<End<D>>(end, "velocity(): end")));
          },
          nb::arg("end"),
          nb::sig("def velocity(self, end: carom._core.BodyId | tuple[carom._core.BodyId, "
                  "numpy.typing.ArrayLike]) -> numpy.typing.NDArray[numpy.float64]"),
          doc("ElementView.velocity"));
  if constexpr (D == 2) {
    view.def(
            "angle",
            [](const V& self, nb::handle body) {
              return self.get().angle(read<BodyId>(body, "angle(): body"));
            },
            nb::arg("body"), nb::sig("def angle(self, body: carom._core.BodyId) -> float"),
            doc("ElementView.angle"))
        .def(
            "spin",
            [](const V& self, nb::handle body) {
              return self.get().spin(read<BodyId>(body, "spin(): body"));
            },
            nb::arg("body"), nb::sig("def spin(self, body: carom._core.BodyId) -> float"),
            doc("ElementView.spin"));
  }
  auto loads = nb::class_<L>(module, "ElementLoads", doc("ElementLoads"));
  const auto force = [&](const char* name, void (ElementLoads<D>::*add)(const End<D>&, const Vec<D>&)) {
    const std::string signature = "def " + std::string(name) +
                                  "(self, end: carom._core.BodyId | tuple[carom._core.BodyId, "
                                  "numpy.typing.ArrayLike], force: numpy.typing.ArrayLike) -> None";
    loads.def(
        name,
        [add](const L& self, nb::handle end, nb::handle value) {
          (self.get().*add)(read<End<D>>(end, "end of an element"),
                            read<Vec<D>>(value, "force of an element"));
        },
        nb::arg("end"), nb::arg("force"), nb::sig(signature.c_str()),
        doc(std::string("ElementLoads.") + name));
  };
  force("conservative", &ElementLoads<D>::conservative);
  force("dissipative", &ElementLoads<D>::dissipative);
  force("external", &ElementLoads<D>::external);
  if constexpr (D == 2) {
    const auto torque = [&](const char* name, void (ElementLoads<D>::*add)(BodyId, double)) {
      const std::string signature =
          "def " + std::string(name) + "(self, body: carom._core.BodyId, torque: float) -> None";
      loads.def(
          name,
          [add](const L& self, nb::handle body, nb::handle value) {
            (self.get().*add)(read<BodyId>(body, "body of an element"),
                              read<double>(value, "torque of an element"));
          },
          nb::arg("body"), nb::arg("torque"), nb::sig(signature.c_str()),
          doc(std::string("ElementLoads.") + name));
    };
    torque("conservative_torque", &ElementLoads<D>::conservative_torque);
    torque("dissipative_torque", &ElementLoads<D>::dissipative_torque);
    torque("external_torque", &ElementLoads<D>::external_torque);
  }
  nb::class_<ForceElementBase<D>>(module, "ForceElement",
                                  "Base of force elements in Python. Write bodies(), the bodies that it acts "
                                  "on, and loads(at, out); if it has "
                                  "conservative loads also potential(at) [J]. Optional: breaks, times when "
                                  "its laws jump [s]; fingerprint(), the "
                                  "numbers by which a checkpoint tells it from others.")
      .def(nb::init<>())
      .def(
          "bodies",
          [](const ForceElementBase<D>&) -> nb::object {
            throw nb::type_error("a ForceElement needs bodies(): the list of bodies that it acts on");
          },
          nb::sig("def bodies(self) -> collections.abc.Sequence[carom._core.BodyId]"),
          "The bodies that it acts on.")
      .def(
          "loads",
          [](const ForceElementBase<D>&, nb::handle, nb::handle) {
            throw nb::type_error("a ForceElement needs loads(at, out)");
          },
          nb::arg("at"), nb::arg("out"),
          nb::sig("def loads(self, at: ElementView, out: ElementLoads) -> None"), "Gives its loads to `out`.")
      .def(
          "potential", [](const ForceElementBase<D>&, nb::handle) { return 0.0; }, nb::arg("at"),
          nb::sig("def potential(self, at: ElementView) -> float"),
          "Potential energy of its conservative loads [J].");
}

}  // namespace

bool is_python_element(nb::handle part) {
  return nb::isinstance<ForceElementBase<2>>(part) || nb::isinstance<ForceElementBase<3>>(part);
}

nb::object add_python_element(System& system, nb::handle part, std::string name) {
  if (nb::isinstance<ForceElementBase<2>>(part)) return add_element<2>(system, part, std::move(name));
  if (nb::isinstance<ForceElementBase<3>>(part)) return add_element<3>(system, part, std::move(name));
  return {};
}

void bind_python_elements(nb::module_& planar, nb::module_& spatial) {
  bind_element<2>(planar);
  bind_element<3>(spatial);
}

}  // namespace carom_python
