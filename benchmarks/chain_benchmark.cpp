// Random contact problems of 2 to 12 planar contacts: the chain of solvers and each solver alone, beside
// projected Gauss-Seidel sweeps written by hand. `per_problem` in seconds; `unsolved` counts answers that the
// solver did not give, `sweeps` those of the plain loop.

#include <carom/carom.h>
#include <carom/contact/solvers/pivoting_solvers.h>

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace {

// Contacts of bodies that have 4 freedoms for 3 rows, so that impulses are unique and sweeps converge.
carom::ContactProblem make_problem(int contacts, std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const int rows = 2 * contacts, freedoms = (4 * rows + 2) / 3;
  std::vector<double> h(static_cast<std::size_t>(rows * freedoms));
  for (double& entry : h) entry = uniform(random);
  const auto at = [&](int row, int i) { return h[static_cast<std::size_t>(row * freedoms + i)]; };
  carom::ContactProblem problem;
  problem.reset(rows);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < rows; ++column) {
      double sum = 0.0;
      for (int i = 0; i < freedoms; ++i) sum += at(row, i) * at(column, i);
      problem.w(row, column) = sum;
    }
    problem.vector()[static_cast<std::size_t>(row)] = uniform(random) - (row % 2 == 0 ? 0.5 : 0.0);
    if (row % 2 == 0) continue;
    carom::RowSet& set = problem.sets()[static_cast<std::size_t>(row)];
    set.kind = carom::SetKind::bounded_interval;
    set.bound = row - 1;
    set.coefficient = 0.3;
  }
  problem.group();
  return problem;
}

std::vector<carom::ContactProblem> make_problems(int contacts) {
  constexpr int count = 64;
  std::mt19937_64 random(static_cast<std::uint64_t>(contacts));
  std::vector<carom::ContactProblem> problems;
  for (int i = 0; i < count; ++i) problems.push_back(make_problem(contacts, random));
  return problems;
}

// Projected Gauss-Seidel until the impulses settle to 1e-12 of their size; returns the sweeps.
[[gnu::noinline]] int sweep_by_hand(const carom::ContactProblem& problem, std::vector<double>& impulse) {
  constexpr int most = 2000;
  const auto n = static_cast<std::size_t>(problem.rows());
  const double* const w = problem.matrix().data();
  const double* const b = problem.vector().data();
  std::fill(impulse.begin(), impulse.end(), 0.0);
  for (int sweep = 1; sweep < most; ++sweep) {
    double change = 0.0, size = 0.0;
    for (std::size_t row = 0; row < n; ++row) {
      double xi = b[row];
      for (std::size_t column = 0; column < n; ++column) xi += w[row * n + column] * impulse[column];
      double wanted = impulse[row] - xi / w[row * n + row];
      if (row % 2 == 0) {
        wanted = std::max(wanted, 0.0);
      } else {
        const double limit = problem.sets()[row].coefficient * impulse[row - 1];
        wanted = std::clamp(wanted, -limit, limit);
      }
      change = std::max(change, std::abs(wanted - impulse[row]));
      size = std::max(size, std::abs(wanted));
      impulse[row] = wanted;
    }
    if (change <= 1e-12 * size) return sweep;
  }
  return most;
}

template <class F>
void time_problems(benchmark::State& state, const char* what, F&& solve) {
  const auto problems = make_problems(static_cast<int>(state.range(0)));
  std::vector<double> impulse(static_cast<std::size_t>(problems.front().rows()));
  double told = 0.0;
  for (const auto& problem : problems) told += solve(problem, impulse);
  for (auto _ : state) {
    for (const auto& problem : problems) benchmark::DoNotOptimize(solve(problem, impulse));
  }
  using benchmark::Counter;
  const auto count = static_cast<double>(problems.size());
  state.counters["per_problem"] = Counter(count, Counter::kIsIterationInvariantRate | Counter::kInvert);
  state.counters[what] = told / count;
}

void gauss_seidel_by_hand(benchmark::State& state) {
  time_problems(state, "sweeps", [](const auto& problem, auto& impulse) {
    return static_cast<double>(sweep_by_hand(problem, impulse));
  });
}

void chain(benchmark::State& state) {
  carom::SolverChain solvers;
  time_problems(state, "unsolved", [&](const auto& problem, auto& impulse) {
    return solvers.solve(problem, impulse).usable() ? 0.0 : 1.0;
  });
}

template <class Solver>
void alone(benchmark::State& state) {
  Solver solver;
  time_problems(state, "unsolved", [&](const auto& problem, auto& impulse) {
    return solver.solve(problem, impulse).outcome == carom::Outcome::not_solved ? 1.0 : 0.0;
  });
}

void principal_pivoting(benchmark::State& state) { alone<carom::PrincipalPivotingSolver>(state); }
void lemke(benchmark::State& state) { alone<carom::LemkeSolver>(state); }

void contacts(benchmark::internal::Benchmark* timed) {
  for (const int count : {2, 4, 8, 12}) timed->Arg(count);
}

BENCHMARK(gauss_seidel_by_hand)->Apply(contacts);
BENCHMARK(chain)->Apply(contacts);
BENCHMARK(principal_pivoting)->Apply(contacts);
BENCHMARK(lemke)->Apply(contacts);

}  // namespace
