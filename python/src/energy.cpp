// The energy ledger and traces.

#include "bind.h"
#include "types.h"

#include <carom/core/energy_ledger.h>
#include <carom/core/energy_trace.h>
#include <carom/core/trace_comparison.h>

namespace carom_python {

using namespace carom;

namespace {

// Every term by name, in the order of tables; zero or not.
nb::dict terms_of(const EnergyLedger& ledger) {
  nb::dict terms;
  const auto set = [&](std::string_view name, double value) {
    terms[nb::str(name.data(), name.size())] = value;
  };
  for (std::size_t i = 0; i < stored_energy_count; ++i) {
    const auto term = static_cast<StoredEnergy>(i);
    set(to_string(term), ledger.stored(term));
  }
  set("total", ledger.total());
  set("initial", ledger.initial());
  for (std::size_t i = 0; i < energy_flow_count; ++i) {
    const auto term = static_cast<EnergyFlow>(i);
    set(to_string(term), ledger.flow(term));
  }
  set("residual", ledger.residual());
  return terms;
}

void bind_ledger(nb::module_& core) {
  nb::class_<EnergyLedger>(core, "EnergyLedger", doc("EnergyLedger"))
      .def(
          "stored",
          [](const EnergyLedger& self, nb::handle term) {
            return self.stored(read<StoredEnergy>(term, "stored(): term"));
          },
          nb::arg("term"), nb::sig("def stored(self, term: StoredEnergy | str) -> float"),
          "Stored energy of one form now [J].")
      .def(
          "flow",
          [](const EnergyLedger& self, nb::handle term) {
            return self.flow(read<EnergyFlow>(term, "flow(): term"));
          },
          nb::arg("term"), nb::sig("def flow(self, term: EnergyFlow | str) -> float"),
          doc("EnergyLedger.flow"))
      .def("kinetic", &EnergyLedger::kinetic, doc("EnergyLedger.kinetic"))
      .def("potential", &EnergyLedger::potential, doc("EnergyLedger.potential"))
      .def("total", &EnergyLedger::total, doc("EnergyLedger.total"))
      .def("initial", &EnergyLedger::initial, doc("EnergyLedger.initial"))
      .def("lost", &EnergyLedger::lost, doc("EnergyLedger.lost"))
      .def("residual", &EnergyLedger::residual, doc("EnergyLedger.residual"))
      .def("scale", &EnergyLedger::scale, doc("EnergyLedger.scale"))
      .def("terms", &terms_of, nb::sig("def terms(self) -> dict[str, float]"), "Every term by its name [J].")
      .def("__str__", &printed<EnergyLedger>)
      .def("__repr__", &printed<EnergyLedger>);
}

std::string str(std::string_view text) { return std::string(text); }

nb::dict row_dict(const TraceRow& row) {
  nb::dict dict;
  const auto values = values_of(row);
  for (std::size_t i = 0; i < trace_term_count; ++i) dict[str(trace_terms()[i].name).c_str()] = values[i];
  return dict;
}

// A row from values by name; of those that are not given 0.
TraceRow row_from(const nb::dict& given) {
  std::array<double, trace_term_count> values{};
  std::size_t used = 0;
  for (std::size_t i = 0; i < trace_term_count; ++i) {
    const std::string name = str(trace_terms()[i].name);
    if (!given.contains(name.c_str())) continue;
    Convert<double>::load(given[name.c_str()], values[i], "add(): '" + name + "'");
    ++used;
  }
  if (used != given.size())
    throw nb::type_error("add(): row has a name that is no term; EnergyTrace.terms() lists them");
  return row_of(values);
}

void bind_trace(nb::module_& core) {
  nb::class_<EnergyTrace>(core, "EnergyTrace", doc("EnergyTrace"))
      .def(nb::init<>())
      .def(
          "add", [](EnergyTrace& self, const nb::dict& row) { self.add(row_from(row)); }, nb::arg("row"),
          nb::sig("def add(self, row: dict[str, float]) -> None"),
          "Appends a row, given by the names of terms(); those left out are 0.")
      .def(
          "add_event",
          [](EnergyTrace& self, double time, nb::handle text) {
            TraceEvent event;
            event.time = time;
            event.text = read<std::string>(text, "add_event(): text");
            self.add(std::move(event));
          },
          nb::arg("time"), nb::arg("text"), nb::sig("def add_event(self, time: float, text: str) -> None"),
          "Appends an event.")
      .def(
          "values",
          [](const EnergyTrace& self, nb::handle term) {
            const std::vector<double> values = self.values(read<std::string>(term, "values(): term"));
            return make_array(values.data(), values.size(), 0);
          },
          nb::arg("term"), nb::sig("def values(self, term: str) -> numpy.typing.NDArray[numpy.float64]"),
          doc("EnergyTrace.values"))
      .def_static(
          "terms",
          [] {
            nb::list names;
            for (const TraceTerm& term : trace_terms())
              names.append(nb::str(term.name.data(), term.name.size()));
            return names;
          },
          nb::sig("def terms() -> list[str]"), "Names of the numbers of a row, in the order of files.")
      .def(
          "row",
          [](const EnergyTrace& self, std::size_t i) {
            if (i >= self.rows().size()) throw nb::index_error("row of a trace");
            return row_dict(self.rows()[i]);
          },
          nb::arg("i"), nb::sig("def row(self, i: int) -> dict[str, float]"),
          "One row, by the names of its terms.")
      .def(
          "events",
          [](const EnergyTrace& self) {
            nb::list list;
            for (const TraceEvent& event : self.events())
              list.append(nb::make_tuple(event.time, nb::str(event.text.c_str())));
            return list;
          },
          nb::sig("def events(self) -> list[tuple[float, str]]"), "Time [s] and text of every event.")
      .def("__len__", [](const EnergyTrace& self) { return self.rows().size(); })
      .def(
          "save", [](const EnergyTrace& self, nb::handle path) { self.save(path_of(path)); }, nb::arg("path"),
          nb::sig("def save(self, path: str | os.PathLike[str]) -> None"), doc("EnergyTrace.save"))
      .def_static(
          "load", [](nb::handle path) { return EnergyTrace::load(path_of(path)); }, nb::arg("path"),
          nb::sig("def load(path: str | os.PathLike[str]) -> EnergyTrace"), doc("EnergyTrace.load"))
      .def("__repr__", &printed<EnergyTrace>);
}

}  // namespace

void bind_energy(nb::module_& core) {
  bind_ledger(core);
  bind_trace(core);
  bind_record<TraceTolerances>(core, "TraceTolerances", {"TraceTolerances"}, true, [](auto& fields) {
    using P = TraceTolerances;
    fields("relative", &P::relative)("energy", &P::energy)("momentum", &P::momentum)(
        "angular_momentum", &P::angular_momentum)("length", &P::length);
  });
  core.def(
      "compare",
      [](const EnergyTrace& trace, const EnergyTrace& stored, const TraceTolerances& tolerances) {
        const TraceComparison result = compare(trace, stored, tolerances);
        return nb::make_tuple(!result.first.has_value(), nb::str(result.report.c_str()));
      },
      nb::arg("trace"), nb::arg("stored"), nb::arg("tolerances"),
      nb::sig("def compare(trace: EnergyTrace, stored: EnergyTrace, tolerances: TraceTolerances) -> "
              "tuple[bool, str]"),
      "Compares two traces term by term: whether all differences are allowed, and a report for people.");
}

}  // namespace carom_python
