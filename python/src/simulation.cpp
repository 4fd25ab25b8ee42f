// Simulation: runs a model.

#include "bind.h"
#include "functions.h"
#include "runner.h"

#include <carom/core/log.h>
#include <carom/integrators/contact_forces.h>

#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <cmath>
#include <limits>

namespace carom_python {

using namespace carom;

namespace {

/// A function of the user that a simulation calls.
struct Callback {
  CallbackId id;
  std::size_t number = 0;
};

// Keeps a function, and lets `begin` hand it to the simulation by its number.
template <class Begin>
Callback keep(Runner& self, nb::handle function, const Begin& begin) {
  const std::size_t number = self.keep(function);
  try {
    return {begin(number), number};
  } catch (...) {
    self.drop(number);
    throw;
  }
}

Callback observe(Runner& self, nb::handle observer) {
  if (PyCallable_Check(observer.ptr()) == 0)
    refuse("observe(): observer", "a function of a Simulation", observer);
  return keep(self, observer, [&](std::size_t number) {
    return self.get().observe([&self, number](const Simulation&) {
      const nb::gil_scoped_acquire lock;
      self.kept(number)(nb::find(self));
    });
  });
}

Callback every(Runner& self, double interval, nb::handle action) {
  if (PyCallable_Check(action.ptr()) == 0) refuse("every(): action", "a function of a Simulation", action);
  return keep(self, action, [&](std::size_t number) {
    return self.get().every(interval, [&self, number](Simulation&) {
      const nb::gil_scoped_acquire lock;
      self.kept(number)(nb::find(self));
    });
  });
}

void set_log(Runner& self, nb::handle sink, nb::handle level) {
  const std::optional<std::size_t> before = self.log_sink;
  if (sink.is_none()) {
    self.get().log() = Log();
    if (before) self.drop(*before);
    self.log_sink.reset();
    return;
  }
  if (PyCallable_Check(sink.ptr()) == 0) refuse("set_log(): sink", "a function of a level and a text", sink);
  const auto least = read<LogLevel>(level, "set_log(): level");
  const std::size_t number = self.keep(sink);
  self.log_sink = number;
  self.get().log() = Log(
      [&self, number](LogLevel of, std::string_view text) {
        const nb::gil_scoped_acquire lock;
        self.kept(number)(nb::cast(of), nb::str(text.data(), text.size()));
      },
      least);
  if (before) self.drop(*before);
}

// Numbers of all bodies, in the order in which they were added; `bodies` says which.
enum class Gathered { positions, velocities, angles, spins };

nb::object gather(Runner& self, Gathered what) {
  const State& state = self.get().state();
  const auto& slots = self.slots();
  const bool of_angle = what == Gathered::angles || what == Gathered::spins;
  const bool of_q = what == Gathered::positions || what == Gathered::angles;
  const std::size_t width = state.layout()->dimension() == 3 ? 3 : 2, columns = of_angle ? 1 : width;
  const double* const from = of_q ? state.q.data() : state.v.data();
  double* to = nullptr;
  nb::object array = new_array(slots.size(), of_angle ? 0 : columns, to);
  for (const auto& [body, slot] : slots) {
    const double* const own = from + (of_q ? slot.q : slot.v);
    if (!of_angle) {
      for (std::size_t i = 0; i < columns; ++i) to[i] = own[i];
    } else {
      to[0] = slot.rotation != none && width == 2 ? own[2] : std::numeric_limits<double>::quiet_NaN();
    }
    to += columns;
  }
  return array;
}

nb::object mode_object(const Simulation& simulation) {
  if (const auto* stepping = std::get_if<TimeStepping>(&simulation.mode())) return nb::cast(*stepping);
  return nb::cast(std::get<EventDriven>(simulation.mode()));
}

nb::list events_from(Runner& self, std::size_t first) {
  nb::list list;
  const std::vector<EventRecord>& events = self.get().events();
  for (std::size_t i = first; i < events.size(); ++i) list.append(nb::cast(events[i]));
  return list;
}

using Class = nb::class_<Runner>;
constexpr const char* no_system =
    "Simulation: arguments 'system' and 'mode' are missing; allowed: a System, and how to run it, for "
    "example "
    "Simulation(system, TimeStepping(step=1e-3)) or Simulation(system, EventDriven())";
constexpr const char* no_mode =
    "Simulation: argument 'mode' is missing; allowed: TimeStepping(step=...) takes steps of that length [s], "
    "EventDriven() integrates from event to event; for example Simulation(system, TimeStepping(step=1e-3))";
constexpr const char* array = "numpy.typing.NDArray[numpy.float64]";

constexpr const char* progress_text =
    "\n\nprogress: True shows how far the run is, by tqdm where that is installed, in a notebook too; or a "
    "function that gets the time reached [s], ten times a second and at the end. It changes no bit of the "
    "run. "
    "Ctrl-C ends the run with KeyboardInterrupt at a good state, from which it can go on.";

void run_until(Runner& self, nb::handle time, nb::handle progress) {
  const auto until = read<double>(time, "run_until(): time");
  if (progress.is_none() || progress.ptr() == Py_False) return self.run_until(until, {});
  if (progress.ptr() != Py_True && PyCallable_Check(progress.ptr()) == 0) {
    refuse("run_until(): progress", "True, False, None or a function of the time", progress);
  }
  const nb::object shown =
      nb::module_::import_("carom.progress").attr("begin")(progress, self.get().time(), until);
  try {
    self.run_until(until, [&](double reached) { shown.attr("update")(reached); });
  } catch (...) {
    shown.attr("close")();
    throw;
  }
  shown.attr("close")();
}

void bind_runs(Class& type) {
  type.def(
          "__init__",
          [](Runner* self, nb::handle system, nb::handle mode) {
            if (system.is_none() && mode.is_none()) throw nb::type_error(no_system);
            Model* model = nullptr;
            if (!nb::try_cast(system, model) || model == nullptr) {
              refuse("Simulation: argument 'system'", "a System", system);
            }
            model->get();
            if (mode.is_none()) throw nb::type_error(no_mode);
            new (self) Runner(*model, mode_of(mode));
          },
          // Without: to say which there are.
          nb::arg("system") = nb::none(), nb::arg("mode") = nb::none(),
          nb::sig("def __init__(self, system: System, mode: TimeStepping | EventDriven) -> None"),
          doc("Simulation.Simulation"))
      .def(
          "step",
          [](Runner& self) {
            self.run([](Simulation& simulation) { simulation.step(); });
            return self.get().report();
          },
          (std::string(doc("Simulation.step")) + " Returns the report of the step: a copy.").c_str())
      .def("run_until", &run_until, nb::arg("time"), nb::kw_only(), nb::arg("progress") = nb::none(),
           nb::sig("def run_until(self, time: float, *, progress: bool | "
                   "collections.abc.Callable[[float], typing.Any] | None = None) -> None"),
           (std::string(doc("Simulation.run_until")) + progress_text).c_str())
      .def("observe", &observe, nb::arg("observer"),
           nb::sig("def observe(self, observer: collections.abc.Callable[[Simulation], typing.Any]) -> "
                   "CallbackId"),
           doc("Simulation.observe"))
      .def("every", &every, nb::arg("interval"), nb::arg("action"),
           nb::sig("def every(self, interval: float, action: collections.abc.Callable[[Simulation], "
                   "typing.Any]) -> CallbackId"),
           doc("Simulation.every"))
      .def(
          "remove_callback",
          [](Runner& self, const Callback& callback) {
            self.get().remove_callback(callback.id);
            self.drop(callback.number);
          },
          nb::arg("callback"), doc("Simulation.remove_callback"))
      .def(
          "stop_when",
          [](Runner& self, nb::handle stop) {
            self.stop_when(read<StopFunction>(stop, "stop_when(): stop"));
          },
          nb::arg("stop").none(),
          nb::sig("def stop_when(self, stop: collections.abc.Callable[[], bool] | None) -> None"),
          doc("Simulation.stop_when"))
      .def(
          "edit", [](Runner& self, nb::handle change) { self.edit(change); }, nb::arg("change"),
          nb::sig("def edit(self, change: collections.abc.Callable[[System], typing.Any]) -> None"),
          doc("Simulation.edit"))
      .def(
          "set_state", [](Runner& self, const State& state) { self.get().set_state(state); },
          nb::arg("state"), doc("Simulation.set_state"))
      .def(
          "switch_to", [](Runner& self, nb::handle mode) { self.switch_to(mode_of(mode)); }, nb::arg("mode"),
          nb::sig("def switch_to(self, mode: TimeStepping | EventDriven) -> None"),
          doc("Simulation.switch_to"))
      .def(
          "save", [](Runner& self, nb::handle path) { self.get().save(path_of(path)); }, nb::arg("path"),
          nb::sig("def save(self, path: str | os.PathLike[str]) -> None"), doc("Simulation.save"))
      .def(
          "load", [](Runner& self, nb::handle path) { self.get().load(path_of(path)); }, nb::arg("path"),
          nb::sig("def load(self, path: str | os.PathLike[str]) -> None"), doc("Simulation.load"))
      .def(
          "checkpoint",
          [](Runner& self) {
            const std::string made = self.get().checkpoint();
            return nb::bytes(made.data(), made.size());
          },
          doc("Simulation.checkpoint"))
      .def(
          "restore",
          [](Runner& self, const nb::bytes& checkpoint) {
            self.get().restore({checkpoint.c_str(), checkpoint.size()});
          },
          nb::arg("checkpoint"), doc("Simulation.restore"))
      .def("copy", &Runner::copy, nb::rv_policy::take_ownership, doc("Simulation.copy"))
      .def("__copy__", &Runner::copy, nb::rv_policy::take_ownership)
      .def(
          "__deepcopy__", [](Runner& self, nb::handle /*memo*/) { return self.copy(); }, nb::arg("memo"),
          nb::rv_policy::take_ownership)
      .def("set_log", &set_log, nb::arg("sink").none(), nb::arg("level") = "info",
           nb::sig("def set_log(self, sink: collections.abc.Callable[[LogLevel, str], typing.Any] | None, "
                   "level: LogLevel | str = 'info') -> None"),
           "Hands lines of the log, of at least this level, to a function of the level and the text. None: a "
           "quiet log.")
      .def(
          "show_progress", [](Runner& self, bool on) { self.get().show_progress(on); }, nb::arg("on"),
          doc("Simulation.show_progress"));
}

nb::object event_list(Runner& self, std::size_t first) {
  return nb::module_::import_("carom.event_list").attr("EventList")(events_from(self, first), nb::find(self));
}

// Changes the state of one body.
void set_motion(Runner& self, BodyId body, std::optional<nb::object> vector, std::optional<double> turn,
                bool of_velocity) {
  State state = self.get().state();
  VectorMap to = of_velocity ? state.velocity(body) : state.position(body);
  if (vector) {
    load_numbers(*vector, to.data(), static_cast<std::size_t>(to.size()),
                 of_velocity ? "set_velocity(): velocity" : "set_position(): position",
                 to.size() == 2 ? "two numbers (x, y)" : "three numbers");
  }
  if (turn) (of_velocity ? state.spin(body) : state.angle(body)) = *turn;
  self.get().set_state(state);
}

std::string shown(Runner& self) {
  const Simulation& simulation = self.get();
  const bool stepping = std::holds_alternative<TimeStepping>(simulation.mode());
  return "<Simulation" + summary_of(self.journal()) + "; " + (stepping ? "TimeStepping" : "EventDriven") +
         " at " + nb::cast<std::string>(nb::str("{:g}").format(simulation.time())) + " s>";
}

void bind_changes(Class& type) {
  type.def(
          "set_velocity",
          [](Runner& self, BodyId body, nb::object velocity, std::optional<double> spin) {
            set_motion(self, body, std::move(velocity), spin, true);
          },
          nb::arg("body"), nb::arg("velocity"), nb::arg("spin") = nb::none(),
          nb::sig(
              "def set_velocity(self, body: BodyId, velocity: numpy.typing.ArrayLike, spin: float | None = "
              "None) -> None"),
          "Sets the velocity of a body [m/s], and its spin if it is given [rad/s]: set_state() with that "
          "change, so joints are satisfied after it, and the ledger books an intervention.")
      .def(
          "set_position",
          [](Runner& self, BodyId body, nb::object position, std::optional<double> angle) {
            set_motion(self, body, std::move(position), angle, false);
          },
          nb::arg("body"), nb::arg("position"), nb::arg("angle") = nb::none(),
          nb::sig(
              "def set_position(self, body: BodyId, position: numpy.typing.ArrayLike, angle: float | None "
              "= None) -> None"),
          "Sets the position of a body [m], and its angle if it is given [rad]: set_state() with that "
          "change.")
      .def("__repr__", &shown);
}

void bind_results(Class& type) {
  type.def("system", &Runner::system, nb::sig("def system(self) -> System"),
           "The model: a copy, changed with edit() only; the same object until the next edit.")
      .def(
          "state", [](Runner& self) { return State(self.get().state()); },
          nb::sig("def state(self) -> State"), "The state: a copy, taken now.")
      .def(
          "time", [](Runner& self) { return self.get().time(); }, "Time [s].")
      .def(
          "mode", [](Runner& self) { return mode_object(self.get()); },
          nb::sig("def mode(self) -> TimeStepping | EventDriven"), "The mode and its options: a copy.")
      .def(
          "energy", [](Runner& self) { return self.get().energy(); }, "The energy ledger: a copy, taken now.")
      .def(
          "report", [](Runner& self) { return self.get().report(); },
          "Report of the last step: a copy, taken now.")
      .def(
          "statistics", [](Runner& self) { return self.get().statistics(); },
          "Counts since the start: a copy, taken now.")
      .def(
          "contact_statistics", [](Runner& self) { return self.get().contact_statistics(); },
          doc("Simulation.contact_statistics"))
      .def("events", &event_list, nb::arg("first") = 0,
           nb::sig("def events(self, first: int = 0) -> carom.event_list.EventList"),
           "Events of the event-driven mode, in order of time, from the one numbered `first` on: copies. "
           "Notebooks show the list as a table.")
      .def(
          "event_count", [](Runner& self) { return self.get().events().size(); },
          "Number of events that are kept.")
      .def(
          "clear_events", [](Runner& self) { self.get().clear_events(); }, doc("Simulation.clear_events"))
      .def(
          "write_events", [](Runner& self, nb::handle path) { self.get().write_events(path_of(path)); },
          nb::arg("path"), nb::sig("def write_events(self, path: str | os.PathLike[str]) -> None"),
          doc("Simulation.write_events"))
      .def(
          "mobility", [](Runner& self) { return self.get().mobility(); }, doc("Simulation.mobility"))
      .def(
          "reaction", [](Runner& self, JointId joint) { return self.get().reaction(joint); },
          nb::arg("joint"), doc("Simulation.reaction"))
      .def(
          "contact_forces", [](Runner& self) { return self.get().contact_forces(); },
          doc("Simulation.contact_forces"))
      .def(
          "name", [](Runner& self, const ConstraintKey& key) { return self.get().name(key); }, nb::arg("key"),
          doc("Simulation.name"))
      .def(
          "name", [](Runner& self, const EventRecord& event) { return self.get().name(event); },
          nb::arg("event"), doc("Simulation.name"))
      .def(
          "name", [](Runner& self, const ContactRecord& contact) { return self.get().name(contact.key); },
          nb::arg("contact"), doc("Simulation.name"))
      .def(
          "position",
          [](Runner& self, BodyId body) {
            const auto at = self.get().state().position(body);
            return make_array(at.data(), static_cast<std::size_t>(at.size()), 0);
          },
          nb::arg("body"), nb::sig("def position(self, body: BodyId) -> numpy.typing.NDArray[numpy.float64]"),
          "Position of a body [m]: a copy, without one of the whole state.")
      .def(
          "velocity",
          [](Runner& self, BodyId body) {
            const auto at = self.get().state().velocity(body);
            return make_array(at.data(), static_cast<std::size_t>(at.size()), 0);
          },
          nb::arg("body"), nb::sig("def velocity(self, body: BodyId) -> numpy.typing.NDArray[numpy.float64]"),
          "Velocity of a body [m/s]: a copy, without one of the whole state.")
      .def(
          "angle", [](Runner& self, BodyId body) { return self.get().state().angle(body); }, nb::arg("body"),
          doc("State.angle"))
      .def(
          "spin", [](Runner& self, BodyId body) { return self.get().state().spin(body); }, nb::arg("body"),
          doc("State.spin"))
      .def(
          "coordinate", [](Runner& self, JointId joint) { return self.get().state().coordinate(joint); },
          nb::arg("joint"), doc("State.coordinate"))
      .def(
          "rate", [](Runner& self, JointId joint) { return self.get().state().rate(joint); },
          nb::arg("joint"), doc("State.rate"));
}

void bind_arrays(Class& type) {
  const auto add = [&](const char* name, Gathered what, const char* text) {
    const std::string signature = "def " + std::string(name) + "(self) -> " + array;
    type.def(
        name, [what](Runner& self) { return gather(self, what); }, nb::sig(signature.c_str()), text);
  };
  add("positions", Gathered::positions,
      "Positions of all bodies, a row each, in the order in which they were added [m]: a copy.");
  add("velocities", Gathered::velocities, "Velocities of all bodies, likewise [m/s].");
  add("angles", Gathered::angles, "Angles of all bodies, likewise; NaN of particles [rad].");
  add("spins", Gathered::spins, "Spins of all bodies, likewise; NaN of particles [rad/s].");
  type.def(
      "bodies",
      [](Runner& self) {
        nb::list list;
        for (const auto& place : self.slots()) list.append(nb::cast(place.first));
        return list;
      },
      nb::sig("def bodies(self) -> list[BodyId]"), "The bodies of positions() and its like, in their order.");
}

int traverse(PyObject* self, visitproc visit, void* arg) {
  Py_VISIT(Py_TYPE(self));
  if (!nb::inst_ready(self)) return 0;
  for (const auto& kept : nb::inst_ptr<Runner>(self)->all_kept()) Py_VISIT(kept.second.ptr());
  return 0;
}
int clear(PyObject* self) {
  nb::inst_ptr<Runner>(self)->clear();
  return 0;
}
PyType_Slot slots[] = {{Py_tp_traverse, reinterpret_cast<void*>(&traverse)},
                       {Py_tp_clear, reinterpret_cast<void*>(&clear)},
                       {0, nullptr}};

}  // namespace

void bind_simulation(nb::module_& core) {
  nb::class_<Callback>(core, "CallbackId", doc("CallbackId")).def(nb::init<>());
  Class type(core, "Simulation", nb::type_slots(slots), doc("Simulation"));
  bind_runs(type);
  bind_results(type);
  bind_changes(type);
  bind_arrays(type);
}

}  // namespace carom_python
