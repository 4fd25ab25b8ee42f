// Mechanisms of rigid rods: one evaluation of accelerations with multipliers, beside Eigen's bare
// factorisation and solve of the same matrix G M^-1 G^T. `per_rod` and `eigen_per_rod` in seconds of CPU.
// Storage of a simulation of a chain: `bytes_per_rod`. And ten rods of 1 m and 1 kg, released level, for 10
// s: `seconds` of CPU, `drift` of the energy [J]; in time stepping `per_step` in seconds of CPU, too. Rods
// released in line in time stepping: `per_rod` and step.

#include <carom/carom.h>
#include <carom/core/assembly.h>
#include <carom/core/dynamics/joint_constraints.h>

#include "benchmarks/allocation_meter.h"

#include <benchmark/benchmark.h>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <optional>
#include <utility>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

/// Uniform rods, pinned to the origin and to each other, hanging at a slant.
System chain(int rods) {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  constexpr double slant = 0.3;
  const Vec<2> along(std::sin(slant), -std::cos(slant));
  BodyId before = ground;
  for (int i = 0; i < rods; ++i) {
    const BodyId body = system.add(RigidBody{
        .mass = rod(1.0, 1.0), .position = (i + 0.5) * along, .angle = std::atan2(along[1], along[0])});
    const End<2> end = i == 0 ? End<2>(ground) : End<2>(before, {0.5, 0.0});
    system.add(Revolute{.from = end, .to = {body, {-0.5, 0.0}}});
    before = body;
  }
  return system;
}

/// A square net of particles joined by rigid rods without mass, hanging from its upper row; every other rod
/// across is left out, so that it can move.
System net(int side) {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  std::vector<BodyId> nodes;
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      const Vec<2> place(column, -row);
      nodes.push_back(system.add(Particle{.mass = 1.0, .position = place, .contact = false}));
      if (row == 0) {
        system.add(Rod{.from = {ground, place + Vec<2>(0.0, 1.0)}, .to = nodes.back()});
      } else {
        system.add(Rod{.from = nodes[nodes.size() - 1 - static_cast<std::size_t>(side)], .to = nodes.back()});
      }
      if (column > 0 && row % 2 == 1) system.add(Rod{.from = nodes[nodes.size() - 2], .to = nodes.back()});
    }
  }
  return system;
}

/// G M^-1 G^T as Eigen stores it.
Eigen::SparseMatrix<double> matrix_of(const Assembly& assembly, const JointConstraints& joints) {
  std::vector<double> response(assembly.layout()->v_size(), 0.0), inverse(response.size(), 1.0);
  joints.apply_inverse_mass(inverse.data());
  std::vector<std::vector<std::size_t>> rows_of(assembly.layout()->v_size());
  for (std::size_t row = 0; row < joints.size(); ++row) {
    const JointRow at = joints.row(row);
    for (int b = 0; b < at.bodies; ++b) rows_of[at.blocks[static_cast<std::size_t>(b)].v].push_back(row);
  }
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t row = 0; row < joints.size(); ++row) {
    const JointRow at = joints.row(row);
    for (int b = 0; b < at.bodies; ++b) {
      const JointRow::Block& block = at.blocks[static_cast<std::size_t>(b)];
      for (Index c = 0; c < static_cast<Index>(block.columns); ++c) {
        response[block.v + c] = inverse[block.v + c] * block.jacobian[c];
      }
    }
    std::vector<std::size_t> others;
    for (int b = 0; b < at.bodies; ++b) {
      const auto& sharing = rows_of[at.blocks[static_cast<std::size_t>(b)].v];
      others.insert(others.end(), sharing.begin(), sharing.end());
    }
    std::sort(others.begin(), others.end());
    others.erase(std::unique(others.begin(), others.end()), others.end());
    for (const std::size_t other : others) {
      entries.emplace_back(static_cast<int>(other), static_cast<int>(row),
                           joints.row(other).times(response.data()));
    }
    for (int b = 0; b < at.bodies; ++b) {
      const JointRow::Block& block = at.blocks[static_cast<std::size_t>(b)];
      std::fill_n(response.begin() + block.v, block.columns, 0.0);
    }
  }
  const auto size = static_cast<Eigen::Index>(joints.size());
  Eigen::SparseMatrix<double> matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// Seconds of CPU that this thread has used.
double cpu_seconds() {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void evaluate(benchmark::State& state, const System& system, double parts) {
  const Assembly assembly(system);
  const State start = assembly.initial_state();
  Evaluation evaluation = make_evaluation(assembly);
  JointConstraints joints(assembly, 0);
  std::vector<double> acceleration(start.v.size());
  const auto once = [&] {
    carom::evaluate(assembly, 0, start.view(), evaluation);
    std::copy(evaluation.force.begin(), evaluation.force.end(), acceleration.begin());
    joints.update_and_factor({start.view(), evaluation.rotation.data()});
    joints.apply_inverse_mass(acceleration.data());
    joints.project(JointLevel::acceleration, acceleration.data());
    benchmark::DoNotOptimize(acceleration.data());
  };
  once();
  const Eigen::SparseMatrix<double> matrix = matrix_of(assembly, joints);
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> eigen;
  eigen.analyzePattern(matrix);
  const Eigen::VectorXd right = Eigen::VectorXd::Ones(matrix.rows());
  Eigen::VectorXd answer(matrix.rows());
  // In turn, so that the machine is the same to both; often enough that the clock does not count.
  const int repeats = static_cast<int>(std::ceil(2000.0 / parts));
  double own = 0.0, bare = 0.0;
  for (auto _ : state) {
    const double first = cpu_seconds();
    for (int i = 0; i < repeats; ++i) once();
    const double middle = cpu_seconds();
    for (int i = 0; i < repeats; ++i) {
      eigen.factorize(matrix);
      answer = eigen.solve(right);
      benchmark::DoNotOptimize(answer.data());
    }
    own += middle - first;
    bare += cpu_seconds() - middle;
  }
  const double runs = static_cast<double>(state.iterations()) * repeats;
  state.counters["per_rod"] = own / runs / parts;
  state.counters["eigen_per_rod"] = bare / runs / parts;
}

void chain_evaluation(benchmark::State& state) {
  const auto rods = static_cast<int>(state.range(0));
  evaluate(state, chain(rods), rods);
}
BENCHMARK(chain_evaluation)
    ->Arg(10)
    ->Arg(100)
    ->Arg(1000)
    ->Arg(10000)
    ->Arg(100000)
    ->Unit(benchmark::kMicrosecond);

void net_evaluation(benchmark::State& state) {
  const auto side = static_cast<int>(state.range(0));
  const System system = net(side);
  evaluate(state, system, static_cast<double>(system.joints().size()));
}
BENCHMARK(net_evaluation)->Arg(10)->Arg(30)->Arg(100)->Unit(benchmark::kMicrosecond);

// Bytes that a simulation holds after a few steps, the user's own System apart.
void storage(benchmark::State& state, const Mode& mode) {
  constexpr int rods = 10000;
  const System system = chain(rods);
  for (auto _ : state) {
    const std::int64_t before = benchmarks::live_bytes();
    Simulation simulation(system, mode);
    for (int i = 0; i < 3; ++i) simulation.step();
    state.counters["bytes_per_rod"] = static_cast<double>(benchmarks::live_bytes() - before) / rods;
  }
}
BENCHMARK_CAPTURE(storage, stepped, TimeStepping{.step = 1e-4})->Iterations(1)->Repetitions(1);
BENCHMARK_CAPTURE(storage, event, EventDriven{.interval = 1e-3})->Iterations(1)->Repetitions(1);

/// Rods of 1 m and 1 kg, pinned to the origin and to each other, level.
void add_level_rods(System& system, int rods) {
  BodyId before = ground;
  for (int i = 0; i < rods; ++i) {
    const BodyId body = system.add(RigidBody{.mass = rod(1.0, 1.0), .position = {i + 0.5, 0.0}});
    const End<2> end = i == 0 ? End<2>(ground) : End<2>(before, {0.5, 0.0});
    system.add(Revolute{.from = end, .to = {body, {-0.5, 0.0}}});
    before = body;
  }
}

void ten_rods(benchmark::State& state) {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  add_level_rods(system, 10);
  double drift = 0.0, cpu = 0.0;
  for (auto _ : state) {
    Simulation simulation(system, EventDriven{.relative_tolerance = 1e-10, .absolute_tolerance = 1e-10});
    const double start = cpu_seconds();
    simulation.run_until(10.0);
    cpu += cpu_seconds() - start;
    drift = std::max(drift, std::abs(simulation.energy().total()));
  }
  state.counters["seconds"] = cpu / static_cast<double>(state.iterations());
  state.counters["drift"] = drift;
}
BENCHMARK(ten_rods)->Unit(benchmark::kMillisecond);

/// The same in time stepping, in steps of 1 ms.
void ten_rods_stepped(benchmark::State& state) {
  constexpr double end = 10.0, step = 1e-3;
  System system;
  system.add(Gravity{{0.0, -9.81}});
  add_level_rods(system, 10);
  double drift = 0.0, cpu = 0.0, sweeps = 0.0;
  for (auto _ : state) {
    Simulation simulation(system, TimeStepping{.step = step});
    const double start = cpu_seconds();
    simulation.run_until(end);
    cpu += cpu_seconds() - start;
    drift = std::max(drift, std::abs(simulation.energy().total()));
    const Statistics& made = simulation.statistics();
    sweeps = static_cast<double>(made.sweeps) / static_cast<double>(made.steps);
  }
  state.counters["per_step"] = cpu / static_cast<double>(state.iterations()) * step / end;
  state.counters["drift"] = drift;
  state.counters["sweeps"] = sweeps;
}
BENCHMARK(ten_rods_stepped)->Unit(benchmark::kMillisecond);

/// Rods released level, all in line, in time stepping: 0.1 s in steps of 1 ms. `per_rod` and step, in
/// seconds.
void rods_in_line(benchmark::State& state) {
  const auto rods = static_cast<int>(state.range(0));
  constexpr double end = 0.1, step = 1e-3;
  System system;
  system.add(Gravity{{0.0, -9.81}});
  add_level_rods(system, rods);
  double sweeps = 0.0;
  for (auto _ : state) {
    state.PauseTiming();
    std::optional<Simulation> simulation(std::in_place, system, TimeStepping{.step = step});
    state.ResumeTiming();
    simulation->run_until(end);
    state.PauseTiming();
    const Statistics& made = simulation->statistics();
    sweeps = static_cast<double>(made.sweeps) / static_cast<double>(made.steps);
    simulation.reset();
    state.ResumeTiming();
  }
  using benchmark::Counter;
  state.counters["per_rod"] =
      Counter(rods * end / step, Counter::kIsIterationInvariantRate | Counter::kInvert);
  state.counters["sweeps"] = sweeps;
}
BENCHMARK(rods_in_line)->Arg(10)->Arg(100)->Arg(1000)->Unit(benchmark::kMillisecond);

}  // namespace
