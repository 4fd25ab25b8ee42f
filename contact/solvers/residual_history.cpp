// Problem: the residual of a solver over its work, which is timed without what looking at it costs.

#include <carom/contact/solvers/residual.h>
#include <carom/contact/solvers/residual_history.h>
#include <carom/contact/solvers/solver_chain.h>
#include <carom/core/csv.h>

#include <chrono>

namespace carom {

namespace {

/// A clock that stands still while somebody looks.
class WorkClock {
public:
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(Clock::now() - start_ - looked_).count();
  }
  template <class F>
  void look(F&& at) {
    const auto from = Clock::now();
    at();
    looked_ += Clock::now() - from;
  }

private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
  Clock::duration looked_{};
};

}  // namespace

ResidualHistory residual_history(const ContactProblem& problem, SolverId solver, const SweepBudget& budget) {
  SolverChain chain;
  if (problem.is_factored()) chain.set_budget(budget);
  ResidualHistory history{.solver = to_string(solver)};
  std::vector<double> impulse(static_cast<std::size_t>(problem.rows())), xi(impulse.size());
  WorkClock clock;
  chain.set_watch([&](int sweep, std::span<const double> at) {
    const double seconds = clock.seconds();
    clock.look([&] {
      problem.velocities(at, xi);
      history.sweeps.push_back({sweep, seconds, residual(problem, at, xi).value});
    });
  });
  const ContactReport report = chain.solve_with(solver, problem, impulse);
  history.answer = {report.iterations, clock.seconds(), report.residual};
  history.outcome = report.outcome;
  return history;
}

void write_histories(const std::string& path, std::span<const ResidualHistory> histories) {
  CsvWriter out("residual history", path);
  for (const char* head : {"solver", "kind", "outcome", "iterations", "seconds", "residual"}) {
    out.add(std::string_view(head));
  }
  out.end_line();
  const auto write = [&](const ResidualHistory& history, std::string_view kind, std::string_view outcome,
                         const HistoryPoint& at) {
    out.add(history.solver);
    out.add(kind);
    out.add(outcome);
    out.add(std::string_view(std::to_string(at.iterations)));
    out.add(at.seconds);
    out.add(at.residual);
    out.end_line();
  };
  for (const ResidualHistory& history : histories) {
    for (const HistoryPoint& at : history.sweeps) write(history, "sweep", {}, at);
    write(history, "answer", to_string(history.outcome), history.answer);
  }
  out.flush();
}

}  // namespace carom
