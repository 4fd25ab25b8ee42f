// Checks of traces (as carom::testing), and the tables of fields that scene files are made of.

#include "bind.h"
#include "runner.h"

#include <carom/core/energy_ledger.h>
#include <carom/core/energy_trace.h>
#include <carom/testing/conservative_loads.h>
#include <carom/testing/refinement.h>
#include <carom/testing/stored_trace.h>
#include <carom/testing/trace_checks.h>

#include <array>

namespace carom_python {

using namespace carom;

template <>
struct Convert<EnergyTrace> : BoundRecord<EnergyTrace> {};
template <>
struct Convert<TraceTolerances> : BoundRecord<TraceTolerances> {};

namespace {

nb::tuple verdict(const energy_test::Verdict& found) {
  return nb::make_tuple(found.holds, nb::str(found.text.c_str()));
}

energy_test::Coordinates coordinates(nb::handle from, const char* where) {
  const auto numbers = read<std::vector<double>>(from, where);
  if (numbers.size() < 2 || numbers.size() > 3) refuse(where, "two or three numbers", from);
  return {numbers[0], numbers[1], numbers.size() > 2 ? numbers[2] : 0.0};
}

void bind_trace_checks(nb::module_& checks) {
  using namespace energy_test;
  checks.def(
      "ledger_closes",
      [](const EnergyTrace& trace, double relative) { return verdict(check_ledger_closes(trace, relative)); },
      nb::arg("trace"), nb::arg("relative"),
      nb::sig("def ledger_closes(trace: carom._core.EnergyTrace, relative: float) -> tuple[bool, str]"),
      doc("check_ledger_closes"));
  checks.def(
      "ledger_closes",
      [](const EnergyLedger& ledger, double relative) {
        return verdict(check_ledger_closes(ledger, relative));
      },
      nb::arg("ledger"), nb::arg("relative"),
      nb::sig("def ledger_closes(ledger: carom._core.EnergyLedger, relative: float) -> tuple[bool, str]"),
      doc("check_ledger_closes"));
  checks.def(
      "energy_never_rises",
      [](const EnergyTrace& trace, double tolerance) {
        return verdict(check_energy_never_rises(trace, tolerance));
      },
      nb::arg("trace"), nb::arg("tolerance"),
      nb::sig("def energy_never_rises(trace: carom._core.EnergyTrace, tolerance: float) -> tuple[bool, str]"),
      doc("check_energy_never_rises"));
  checks.def(
      "momentum_in",
      [](const EnergyTrace& trace, nb::handle direction, double relative) {
        return verdict(
            check_momentum_in(trace, coordinates(direction, "momentum_in(): direction"), relative));
      },
      nb::arg("trace"), nb::arg("direction"), nb::arg("relative"),
      nb::sig("def momentum_in(trace: carom._core.EnergyTrace, direction: collections.abc.Sequence[float], "
              "relative: float) -> tuple[bool, str]"),
      doc("check_momentum_in"));
  checks.def(
      "angular_momentum_about",
      [](const EnergyTrace& trace, nb::handle point, double relative) {
        return verdict(check_angular_momentum_about(
            trace, coordinates(point, "angular_momentum_about(): point"), relative));
      },
      nb::arg("trace"), nb::arg("point"), nb::arg("relative"),
      nb::sig("def angular_momentum_about(trace: carom._core.EnergyTrace, point: "
              "collections.abc.Sequence[float], relative: float) -> tuple[bool, str]"),
      doc("check_angular_momentum_about"));
  checks.def(
      "constraints_within",
      [](const EnergyTrace& trace, double metres) {
        return verdict(check_constraints_within(trace, metres));
      },
      nb::arg("trace"), nb::arg("metres"),
      nb::sig("def constraints_within(trace: carom._core.EnergyTrace, metres: float) -> tuple[bool, str]"),
      doc("check_constraints_within"));
}

std::vector<energy_test::RefinedTrace> refined(nb::handle given) {
  std::vector<energy_test::RefinedTrace> traces;
  for_items(given, "order_at_least(): traces", "pairs of a step and a trace",
            [&](nb::handle item, std::size_t i) {
              const std::string where = "order_at_least(): traces[" + std::to_string(i) + "]";
              if (!nb::isinstance<nb::tuple>(item) || nb::len(item) != 2)
                refuse(where, "a step and a trace", item);
              energy_test::RefinedTrace trace;
              trace.step = read<double>(item[0], where + "[0]");
              trace.trace = read<EnergyTrace>(item[1], where + "[1]");
              traces.push_back(std::move(trace));
            });
  return traces;
}

void bind_other_checks(nb::module_& checks) {
  using namespace energy_test;
  checks.def(
      "against_stored",
      [](const EnergyTrace& trace, nb::handle path, const TraceTolerances& tolerances, const char* test) {
        return verdict(check_against_stored(trace, path_of(path), tolerances, test));
      },
      nb::arg("trace"), nb::arg("path"), nb::arg("tolerances"), nb::arg("test"),
      nb::sig("def against_stored(trace: carom._core.EnergyTrace, path: str | os.PathLike[str], tolerances: "
              "carom._core.TraceTolerances, test: str) -> tuple[bool, str]"),
      doc("check_against_stored"));
  checks.def(
      "rewrite_stored",
      [](const EnergyTrace& trace, nb::handle path) { return verdict(rewrite_stored(trace, path_of(path))); },
      nb::arg("trace"), nb::arg("path"),
      nb::sig("def rewrite_stored(trace: carom._core.EnergyTrace, path: str | os.PathLike[str]) -> "
              "tuple[bool, str]"),
      doc("rewrite_stored"));
  checks.def("rewrite_requested", &rewrite_requested, doc("rewrite_requested"));
  checks.def(
      "conservative_loads",
      [](Model& system, double tolerance) {
        return verdict(check_conservative_loads(system.get(), tolerance));
      },
      nb::arg("system"), nb::arg("tolerance"),
      nb::sig("def conservative_loads(system: carom._core.System, tolerance: float) -> tuple[bool, str]"),
      doc("check_conservative_loads"));
  checks.def(
      "order_at_least",
      [](nb::handle traces, double order, const EnergyTrace& reference) {
        return verdict(check_order_at_least(refined(traces), order, reference));
      },
      nb::arg("traces"), nb::arg("order"), nb::arg("reference"),
      nb::sig("def order_at_least(traces: collections.abc.Sequence[tuple[float, carom._core.EnergyTrace]], "
              "order: float, reference: carom._core.EnergyTrace) -> tuple[bool, str]"),
      doc("check_order_at_least"));
}

// The list of fields as data.
nb::list described() {
  nb::list list;
  for (const Record* record : records()) {
    nb::list fields;
    for (const Field& field : record->fields) {
      nb::dict item;
      item["name"] = field.name;
      item["python"] = field.python();
      item["json"] = field.type->names.json;
      item["type"] = field.type->names.gives;
      item["required"] = field.required;
      item["default"] = field.required ? nb::none() : nb::borrow(field.default_value);
      item["unit"] = field.unit;
      item["doc"] = field.doc;
      fields.append(item);
    }
    nb::dict item;
    item["name"] = record->name;
    item["module"] = record->module;
    item["role"] = record->role;
    item["doc"] = record->doc;
    item["structs"] = Convert<std::vector<std::string>>::cast(record->structs);
    item["type"] = nb::borrow(record->type);
    item["writable"] = record->writable;
    item["fields"] = fields;
    list.append(item);
  }
  return list;
}

}  // namespace

void bind_checks(nb::module_& core) {
  nb::module_ checks = core.def_submodule(
      "checks", "Checks of traces: each gives whether it holds, and an explanation if not.");
  bind_trace_checks(checks);
  bind_other_checks(checks);
  core.def("described", &described, nb::sig("def described() -> list[dict[str, typing.Any]]"),
           "All described types with their fields: names, units, texts, defaults, forms in scene files.");
}

}  // namespace carom_python
