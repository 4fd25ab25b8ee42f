// Contact problems and their solvers.

#include "bind.h"
#include "runner.h"

#include <carom/contact/solvers/contact_problem.h>
#include <carom/contact/solvers/contact_report.h>
#include <carom/contact/solvers/problem_file.h>
#include <carom/contact/solvers/residual.h>
#include <carom/contact/solvers/residual_history.h>
#include <carom/contact/solvers/solution_list.h>
#include <carom/contact/solvers/solver_chain.h>

#include <algorithm>
#include <array>

namespace carom_python {

using namespace carom;

template <>
struct Convert<RowSet> : BoundRecord<RowSet> {};
template <>
struct Convert<HistoryPoint> : BoundRecord<HistoryPoint> {};
template <>
struct Convert<ResidualHistory> : BoundRecord<ResidualHistory> {};

namespace {

nb::object numbers_of(std::span<const double> numbers) {
  return make_array(numbers.data(), numbers.size(), 0);
}

std::vector<double> impulse_of(const ContactProblem& problem, nb::handle given, const char* where) {
  auto impulse = read<std::vector<double>>(given, where);
  if (impulse.size() != static_cast<std::size_t>(problem.rows())) {
    throw nb::type_error((std::string(where) + " must be " + std::to_string(problem.rows()) +
                          " numbers, one a row, not " + std::to_string(impulse.size()))
                             .c_str());
  }
  return impulse;
}

ContactProblem make_problem(nb::handle matrix, nb::handle vector, nb::handle sets) {
  const auto w = read<std::vector<std::vector<double>>>(matrix, "ContactProblem: argument 'matrix'");
  const auto b = read<std::vector<double>>(vector, "ContactProblem: argument 'vector'");
  const auto of_rows = read<std::vector<RowSet>>(sets, "ContactProblem: argument 'sets'");
  const std::size_t rows = b.size();
  const auto wrong = [&](const std::string& what) {
    throw nb::type_error(
        ("ContactProblem: " + what + "; the vector has " + std::to_string(rows) + " numbers").c_str());
  };
  if (w.size() != rows || std::ranges::any_of(w, [&](const auto& row) { return row.size() != rows; })) {
    wrong("argument 'matrix' must be square, with a row for each number of the vector");
  }
  if (of_rows.size() != rows)
    wrong("argument 'sets' must have one set a row, not " + std::to_string(of_rows.size()));
  ContactProblem problem;
  problem.reset(static_cast<int>(rows));
  for (std::size_t i = 0; i < rows; ++i)
    std::ranges::copy(w[i], problem.matrix().begin() + static_cast<std::ptrdiff_t>(i * rows));
  std::ranges::copy(b, problem.vector().begin());
  std::ranges::copy(of_rows, problem.sets().begin());
  problem.group();
  return problem;
}

void bind_problem(nb::module_& core) {
  bind_record<RowSet>(core, "RowSet", {"RowSet"}, true, [](auto& fields) {
    fields("kind", &RowSet::kind)("lower", &RowSet::lower)("upper", &RowSet::upper)("bound", &RowSet::bound)(
        "coefficient", &RowSet::coefficient);
  });
  nb::class_<ContactProblem>(core, "ContactProblem", doc("ContactProblem"))
      .def(
          "__init__",
          [](ContactProblem* self, nb::handle matrix, nb::handle vector, nb::handle sets) {
            new (self) ContactProblem(make_problem(matrix, vector, sets));
          },
          nb::arg("matrix"), nb::arg("vector"), nb::arg("sets"),
          nb::sig("def __init__(self, matrix: numpy.typing.ArrayLike, vector: numpy.typing.ArrayLike, sets: "
                  "collections.abc.Sequence[RowSet]) -> None"))
      .def("rows", &ContactProblem::rows, doc("ContactProblem.rows"))
      .def(
          "matrix",
          [](const ContactProblem& self) {
            const ContactProblem dense = self.is_factored() ? self.dense() : self;
            const auto rows = static_cast<std::size_t>(dense.rows());
            return make_array(dense.matrix().data(), rows, rows);
          },
          nb::sig("def matrix(self) -> numpy.typing.NDArray[numpy.float64]"),
          "W [1/kg, ...]: a copy, dense also where the problem has factors.")
      .def(
          "vector", [](const ContactProblem& self) { return numbers_of(self.vector()); },
          nb::sig("def vector(self) -> numpy.typing.NDArray[numpy.float64]"), doc("ContactProblem.vector"))
      .def(
          "sets",
          [](const ContactProblem& self) {
            nb::list list;
            for (const RowSet& set : self.sets()) list.append(nb::cast(set));
            return list;
          },
          nb::sig("def sets(self) -> list[RowSet]"), doc("ContactProblem.sets"))
      .def(
          "velocities",
          [](const ContactProblem& self, nb::handle impulse) {
            const std::vector<double> given = impulse_of(self, impulse, "velocities(): impulse");
            std::vector<double> xi(given.size());
            self.velocities(given, xi);
            return numbers_of(xi);
          },
          nb::arg("impulse"),
          nb::sig(
              "def velocities(self, impulse: numpy.typing.ArrayLike) -> numpy.typing.NDArray[numpy.float64]"),
          doc("ContactProblem.velocities"))
      .def(
          "save", [](const ContactProblem& self, nb::handle path) { self.save(path_of(path)); },
          nb::arg("path"), nb::sig("def save(self, path: str | os.PathLike[str]) -> None"),
          doc("ContactProblem.save"))
      .def_static(
          "load", [](nb::handle path) { return ContactProblem::load(path_of(path)); }, nb::arg("path"),
          nb::sig("def load(path: str | os.PathLike[str]) -> ContactProblem"), doc("ContactProblem.load"));
  core.def(
      "residual",
      [](const ContactProblem& problem, nb::handle impulse) {
        const std::vector<double> given = impulse_of(problem, impulse, "residual(): impulse");
        std::vector<double> xi(given.size());
        problem.velocities(given, xi);
        return residual(problem, given, xi).value;
      },
      nb::arg("problem"), nb::arg("impulse"),
      nb::sig("def residual(problem: ContactProblem, impulse: numpy.typing.ArrayLike) -> float"),
      doc("residual"));
}

nb::tuple answer(const ContactReport& report, const std::vector<double>& impulse) {
  return nb::make_tuple(numbers_of(impulse), nb::cast(report));
}

void bind_solvers(nb::module_& core) {
  bind_record<ContactReport>(core, "ContactReport", {"ContactReport"}, false, [](auto& fields) {
    using P = ContactReport;
    fields("outcome", &P::outcome)("degenerate", &P::degenerate)("residual", &P::residual)(
        "worst_group", &P::worst_group)("iterations", &P::iterations)("tried", &P::tried)(
        "solver", &P::solver)("reason", &P::reason);
  }).def("usable", &ContactReport::usable, doc("ContactReport.usable"));
  nb::class_<SolverChain>(core, "SolverChain", doc("SolverChain"))
      .def(nb::init<>())
      .def(
          "solve",
          [](SolverChain& self, const ContactProblem& problem) {
            std::vector<double> impulse(static_cast<std::size_t>(problem.rows()));
            return answer(self.solve(problem, impulse), impulse);
          },
          nb::arg("problem"),
          nb::sig("def solve(self, problem: ContactProblem) -> tuple[numpy.typing.NDArray[numpy.float64], "
                  "ContactReport]"),
          "Impulses [N s] and the report: the best attempt unless usable().")
      .def(
          "solve_with",
          [](SolverChain& self, nb::handle solver, const ContactProblem& problem) {
            const auto which = read<SolverId>(solver, "solve_with(): solver");
            std::vector<double> impulse(static_cast<std::size_t>(problem.rows()));
            return answer(self.solve_with(which, problem, impulse), impulse);
          },
          nb::arg("solver"), nb::arg("problem"),
          nb::sig("def solve_with(self, solver: SolverId | str, problem: ContactProblem) -> "
                  "tuple[numpy.typing.NDArray[numpy.float64], ContactReport]"),
          doc("SolverChain.solve_with"))
      .def("set_budget", &SolverChain::set_budget, nb::arg("budget"), doc("SolverChain.set_budget"))
      .def(
          "modes",
          [](const SolverChain& self) {
            nb::list list;
            for (const ContactMode mode : self.modes()) list.append(nb::cast(mode));
            return list;
          },
          nb::sig("def modes(self) -> list[ContactMode]"), doc("SolverChain.modes"))
      .def(
          "statistics", [](const SolverChain& self) { return self.statistics(); },
          doc("SolverChain.statistics"));
  core.def(
      "list_solutions",
      [](const ContactProblem& problem) {
        SolutionList list;
        const Outcome outcome = list.enumerate(problem);
        nb::list impulses;
        for (std::size_t i = 0; i < list.size(); ++i) impulses.append(numbers_of(list.impulse(i)));
        return nb::make_tuple(outcome, impulses, list.unbounded());
      },
      nb::arg("problem"),
      nb::sig("def list_solutions(problem: ContactProblem) -> tuple[Outcome, "
              "list[numpy.typing.NDArray[numpy.float64]], bool]"),
      "All solutions of a planar problem of up to three contacts: outcome, impulses of each, and whether "
      "impulses can be increased without bound.");
}

void bind_histories(nb::module_& core) {
  bind_record<HistoryPoint>(core, "HistoryPoint", {"HistoryPoint"}, false, [](auto& fields) {
    fields("iterations", &HistoryPoint::iterations)("seconds", &HistoryPoint::seconds)(
        "residual", &HistoryPoint::residual);
  });
  bind_record<ResidualHistory>(core, "ResidualHistory", {"ResidualHistory"}, false, [](auto& fields) {
    using P = ResidualHistory;
    fields("solver", &P::solver)("outcome", &P::outcome)("sweeps", &P::sweeps)("answer", &P::answer);
  });
  core.def(
      "residual_history",
      [](const ContactProblem& problem, nb::handle solver, const SweepBudget& budget) {
        return residual_history(problem, read<SolverId>(solver, "residual_history(): solver"), budget);
      },
      nb::arg("problem"), nb::arg("solver"), nb::arg("budget") = SweepBudget{},
      nb::sig("def residual_history(problem: ContactProblem, solver: SolverId | str, budget: SweepBudget = "
              "...) -> ResidualHistory"),
      doc("residual_history"));
  core.def(
      "write_histories",
      [](nb::handle path, nb::handle histories) {
        const auto list = read<std::vector<ResidualHistory>>(histories, "write_histories(): histories");
        write_histories(path_of(path), list);
      },
      nb::arg("path"), nb::arg("histories"),
      nb::sig("def write_histories(path: str | os.PathLike[str], histories: "
              "collections.abc.Sequence[ResidualHistory]) -> None"),
      doc("write_histories"));
}

}  // namespace

void bind_problems(nb::module_& core) {
  bind_problem(core);
  bind_solvers(core);
  bind_histories(core);
}

}  // namespace carom_python
