// Recorders of the library.

#include "bind.h"
#include "runner.h"

#include <carom/integrators/contact_recorder.h>
#include <carom/integrators/csv_recorder.h>
#include <carom/integrators/energy_recorder.h>

namespace carom_python {

using namespace carom;

namespace {

template <class T>
void add_file_functions(nb::class_<T>& type) {
  type.def("flush", &T::flush, "Writes what is still in memory. Raises FileError if it cannot be written.")
      .def(
          "detach", [](T& self, Runner& simulation) { self.detach(simulation.get()); }, nb::arg("simulation"),
          "Ends the recording and writes what is still in memory.")
      .def("rows", &T::rows, "Rows written so far, without the header.");
}

}  // namespace

void bind_recorders(nb::module_& core) {
  nb::class_<CsvRecorder> csv(core, "CsvRecorder", doc("CsvRecorder"));
  csv.def(
      "__init__",
      [](CsvRecorder* self, Runner& simulation, nb::handle path, nb::handle bodies, int every_steps,
         bool energies) {
        CsvRecorder::Options options;
        options.bodies = read<std::vector<BodyId>>(bodies, "CsvRecorder: argument 'bodies'");
        options.every_steps = every_steps;
        options.energies = energies;
        new (self) CsvRecorder(simulation.get(), path_of(path), options);
      },
      nb::arg("simulation"), nb::arg("path"), nb::arg("bodies") = nb::make_tuple(),
      nb::arg("every_steps") = 1, nb::arg("energies") = true,
      nb::sig("def __init__(self, simulation: Simulation, path: str | os.PathLike[str], bodies: "
              "collections.abc.Sequence[BodyId] = (), every_steps: int = 1, energies: bool = True) -> None"));
  add_file_functions(csv);
  nb::class_<ContactRecorder> contacts(core, "ContactRecorder", doc("ContactRecorder"));
  contacts.def(
      "__init__",
      [](ContactRecorder* self, Runner& simulation, nb::handle path) {
        new (self) ContactRecorder(simulation.get(), path_of(path));
      },
      nb::arg("simulation"), nb::arg("path"),
      nb::sig("def __init__(self, simulation: Simulation, path: str | os.PathLike[str]) -> None"));
  add_file_functions(contacts);
  nb::class_<EnergyRecorder>(core, "EnergyRecorder", doc("EnergyRecorder"))
      .def(
          "__init__",
          [](EnergyRecorder* self, Runner& simulation, int every_steps, double interval) {
            new (self) EnergyRecorder(
                simulation.get(), EnergyRecorder::Options{.every_steps = every_steps, .interval = interval});
          },
          nb::arg("simulation"), nb::arg("every_steps") = 0, nb::arg("interval") = 0.0)
      .def(
          "trace", [](const EnergyRecorder& self) { return self.trace(); },
          "The trace recorded so far: a copy.")
      .def(
          "detach", [](EnergyRecorder& self, Runner& simulation) { self.detach(simulation.get()); },
          nb::arg("simulation"), doc("EnergyRecorder.detach"));
  core.def(
      "record_at",
      [](Runner& simulation, nb::handle times) {
        return record_at(simulation.get(), read<std::vector<double>>(times, "record_at(): times"));
      },
      nb::arg("simulation"), nb::arg("times"),
      nb::sig("def record_at(simulation: Simulation, times: collections.abc.Sequence[float]) -> EnergyTrace"),
      doc("record_at"));
}

}  // namespace carom_python
