// State: a value with arrays.

#include "bind.h"
#include "ids.h"
#include "record.h"

#include <carom/core/errors.h>
#include <carom/core/layout.h>
#include <carom/core/state.h>

#include <nanobind/ndarray.h>
#include <nanobind/stl/tuple.h>

#include <cstring>
#include <tuple>

namespace carom_python {

using namespace carom;

namespace {

// Views: the memory is the state's own, which never changes its size in Python, and lives as long as they.
nb::object view(nb::handle state, double* data, std::size_t size) {
  const std::array<std::size_t, 1> shape{size};
  static double nothing = 0.0;
  return nb::cast(nb::ndarray<nb::numpy, double>(size > 0 ? data : &nothing, 1, shape.data(), state));
}
nb::object view(nb::handle self, std::vector<double>& numbers) {
  return view(self, numbers.data(), numbers.size());
}

State& state_of(nb::handle self) { return nb::cast<State&>(self); }

void assign(std::vector<double>& numbers, nb::handle value, const char* where) {
  std::vector<double> read;
  Convert<std::vector<double>>::load(value, read, where);
  if (read.size() != numbers.size()) {
    throw nb::type_error((std::string(where) + " must be " + std::to_string(numbers.size()) +
                          " numbers, not " + std::to_string(read.size()))
                             .c_str());
  }
  std::ranges::copy(read, numbers.begin());
}

// Writes two numbers, or in space three.
void put(VectorMap to, nb::handle value, const char* call) {
  load_numbers(value, to.data(), static_cast<std::size_t>(to.size()), std::string(call) + ": value",
               to.size() == 2 ? "two numbers (x, y)" : "three numbers");
}

constexpr const char* array_type = "numpy.typing.NDArray[numpy.float64]";

template <std::vector<double> State::*member>
void bind_array(nb::class_<State>& type, const char* name, const char* text) {
  const std::string getter = "def " + std::string(name) + "(self) -> " + array_type;
  const std::string setter = "def " + std::string(name) + "(self, value: numpy.typing.ArrayLike) -> None";
  const std::string path = "State." + std::string(name);
  type.def_prop_rw(
      name, [](nb::handle self) { return view(self, state_of(self).*member); },
      [path](State& self, nb::handle value) { assign(self.*member, value, path.c_str()); },
      nb::for_getter(nb::sig(getter.c_str())), nb::for_setter(nb::sig(setter.c_str())), text);
}

/// Numbers of places that travel with a state: BodySlot, then InternalSlot.
constexpr std::size_t of_body = 8, of_internal = 3;

nb::tuple packed(const State& state) {
  if (state.layout() == nullptr) throw ModelError("state of no model: it cannot be pickled");
  const Layout& layout = *state.layout();
  std::vector<Index> places;
  places.reserve(of_body * layout.bodies().size() + of_internal * layout.internals().size());
  for (const BodySlot& at : layout.bodies()) {
    places.insert(places.end(), {at.serial, at.q, at.v, at.q_size, at.v_size, at.rotation, at.kind, at.slot});
  }
  for (const InternalSlot& at : layout.internals()) {
    places.insert(places.end(), {at.serial, at.first, at.size});
  }
  const auto bytes = [](const auto& numbers) {
    return nb::bytes(numbers.data(), sizeof(numbers[0]) * numbers.size());
  };
  return nb::make_tuple(layout.dimension(), layout.bodies().size(), bytes(places), state.time, bytes(state.q),
                        bytes(state.v), bytes(state.z));
}

template <class Number>
std::vector<Number> numbers_of(const nb::bytes& bytes) {
  std::vector<Number> numbers(bytes.size() / sizeof(Number));
  if (!numbers.empty()) std::memcpy(numbers.data(), bytes.c_str(), sizeof(Number) * numbers.size());
  return numbers;
}

using Packed = std::tuple<int, std::size_t, nb::bytes, double, nb::bytes, nb::bytes, nb::bytes>;

/// A state of no system of this process: simulations of the same model take it.
void unpack(State& self, const Packed& packed) {
  const auto& [dimension, bodies, bytes, time, q, v, z] = packed;
  const std::vector<Index> places = numbers_of<Index>(bytes);
  const std::size_t of_bodies = of_body * bodies;
  if (places.size() < of_bodies) throw ModelError("state: is damaged: ends too early");
  std::vector<BodySlot> slots;
  for (std::size_t i = 0; i < of_bodies; i += of_body) {
    const Index* const at = places.data() + i;
    slots.push_back({at[0], at[1], at[2], at[3], at[4], at[5], at[6], at[7]});
  }
  std::vector<InternalSlot> internals;
  for (std::size_t i = of_bodies; i + of_internal <= places.size(); i += of_internal) {
    internals.push_back({places[i], places[i + 1], places[i + 2]});
  }
  const auto layout = std::make_shared<Layout>(dimension, none, slots);
  layout->place_internals(std::move(internals));
  State made(layout);
  made.time = time;
  const std::pair<std::vector<double>*, const nb::bytes*> all[] = {
      {&made.q, &q}, {&made.v, &v}, {&made.z, &z}};
  for (const auto& [numbers, read] : all) {
    const std::vector<double> given = numbers_of<double>(*read);
    if (given.size() != numbers->size()) throw ModelError("state: is damaged: its sizes do not fit");
    *numbers = given;
  }
  new (&self) State(std::move(made));
}

}  // namespace

void bind_state(nb::module_& core) {
  nb::class_<State> type(
      core, "State",
      "Time, coordinates q, velocities v and internal variables z of a model: a value, taken "
      "from a simulation or given to it. Its arrays are views of its own memory: they stay valid, "
      "and writing to them changes this state, not the simulation.");
  type.def_rw("time", &State::time, "[s]");
  bind_array<&State::q>(type, "q", "Coordinates, bodies in the order of assembly [m, rad]. A view.");
  bind_array<&State::v>(type, "v", "Velocities [m/s, rad/s]. A view.");
  bind_array<&State::z>(type, "z", "Internal variables of elements. A view.");
  const auto map = [](nb::handle self, VectorMap numbers) {
    return view(self, numbers.data(), static_cast<std::size_t>(numbers.size()));
  };
  type.def(
          "position",
          [map](nb::handle self, BodyId body) { return map(self, state_of(self).position(body)); },
          nb::arg("body"), nb::sig("def position(self, body: BodyId) -> numpy.typing.NDArray[numpy.float64]"),
          "Position of the centre of mass [m]: a view. Raises ModelError for a foreign identity.")
      .def(
          "velocity",
          [map](nb::handle self, BodyId body) { return map(self, state_of(self).velocity(body)); },
          nb::arg("body"), nb::sig("def velocity(self, body: BodyId) -> numpy.typing.NDArray[numpy.float64]"),
          "Velocity of the centre of mass [m/s]: a view.")
      .def(
          "angle", [](const State& self, BodyId body) { return self.angle(body); }, nb::arg("body"),
          doc("State.angle"))
      .def(
          "spin", [](const State& self, BodyId body) { return self.spin(body); }, nb::arg("body"),
          doc("State.spin"))
      .def(
          "set_angle", [](State& self, BodyId body, double value) { self.angle(body) = value; },
          nb::arg("body"), nb::arg("value"), "Sets the angle of a planar rigid body [rad].")
      .def(
          "set_spin", [](State& self, BodyId body, double value) { self.spin(body) = value; },
          nb::arg("body"), nb::arg("value"), "Sets the spin of a planar rigid body [rad/s].")
      .def(
          "set_position",
          [](State& self, BodyId body, nb::handle value) {
            put(self.position(body), value, "set_position()");
          },
          nb::arg("body"), nb::arg("value"),
          nb::sig("def set_position(self, body: BodyId, value: numpy.typing.ArrayLike) -> None"),
          "Sets the position of the centre of mass [m].")
      .def(
          "set_velocity",
          [](State& self, BodyId body, nb::handle value) {
            put(self.velocity(body), value, "set_velocity()");
          },
          nb::arg("body"), nb::arg("value"),
          nb::sig("def set_velocity(self, body: BodyId, value: numpy.typing.ArrayLike) -> None"),
          "Sets the velocity of the centre of mass [m/s].")
      .def("coordinate", &State::coordinate, nb::arg("joint"), doc("State.coordinate"))
      .def("rate", &State::rate, nb::arg("joint"), doc("State.rate"))
      .def(
          "internal",
          [map](nb::handle self, ElementId element) { return map(self, state_of(self).internal(element)); },
          nb::arg("element"),
          nb::sig("def internal(self, element: ElementId) -> numpy.typing.NDArray[numpy.float64]"),
          doc("State.internal"))
      .def("__copy__", [](const State& self) { return State(self); })
      .def(
          "__deepcopy__", [](const State& self, nb::handle /*memo*/) { return State(self); }, nb::arg("memo"))
      .def("__getstate__", &packed, nb::sig("def __getstate__(self) -> tuple[typing.Any, ...]"))
      .def("__setstate__", &unpack)
      .def("__repr__", [](const State& self) {
        return "State(time=" + nb::cast<std::string>(nb::repr(nb::float_(self.time))) + ", " +
               std::to_string(self.q.size()) + " coordinates)";
      });
}

}  // namespace carom_python
