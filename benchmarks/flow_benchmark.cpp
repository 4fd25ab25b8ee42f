// A free body in space that turns and bounces on a floor without loss: smooth motion by each method of
// make_flow(), started anew after each impact, beside a loop with the classical Runge-Kutta method of order 4
// written by hand for this purpose, without error control. Impacts are found on the flow's interpolation by
// Newton's method on the height. `per_impact` in seconds.
//
// Stiff motion by bdf: square nets of particles with springs and dashpots along sides and diagonals, and
// chains of pinned rods with torsional springs, by their numbers of coordinates and velocities.
// `per_unknown`, seconds of a step and number, must hardly grow for chains, and no faster than with the root
// of the numbers for nets. explicit_runge_kutta beside it, whose steps are many.

#include <carom/carom.h>
#include <carom/integrators/flow/flow.h>

#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numbers>
#include <span>
#include <stdexcept>
#include <vector>

namespace {

constexpr double gravity = 9.81, mass = 2.0, tolerance = 1e-9, longest_step = 0.1;
constexpr std::array<double, 3> inertia{0.1, 0.15, 0.22};
constexpr std::size_t size = 12, height = 2, rise = 5;
using Motion = std::array<double, size>;  // position, velocity, modified Rodrigues parameters, body's spin

// Falls for 0.9 s between impacts.
constexpr Motion at_start{0, 0, 0, 0.5, -0.3, 0.45 * gravity, 0, 0, 0, 1.0, 0.2, -0.5};

void rates(const double* y, double* out) {
  const double* p = y + 6;
  const double* w = y + 9;
  for (std::size_t i = 0; i < 3; ++i) out[i] = y[3 + i];
  out[3] = out[4] = 0.0;
  out[5] = -gravity;
  const double square = p[0] * p[0] + p[1] * p[1] + p[2] * p[2];
  const double along = p[0] * w[0] + p[1] * w[1] + p[2] * w[2];
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    out[6 + i] = 0.25 * ((1.0 - square) * w[i] + 2.0 * (p[j] * w[k] - p[k] * w[j]) + 2.0 * along * p[i]);
    out[9 + i] = (inertia[j] - inertia[k]) * w[j] * w[k] / inertia[i];
  }
}

class Body final : public carom::FlowProblem {
public:
  Body() { tolerances_.fill(tolerance); }
  [[nodiscard]] std::size_t size() const override { return ::size; }
  void rates(double, const double* y, double* out) override { ::rates(y, out); }
  [[nodiscard]] std::span<const double> absolute_tolerances() const override { return tolerances_; }

private:
  Motion tolerances_{};
};

double energy(const Motion& y) {
  double sum = mass * gravity * y[height];
  for (std::size_t i = 0; i < 3; ++i) {
    sum += 0.5 * (mass * y[3 + i] * y[3 + i] + inertia[i] * y[9 + i] * y[9 + i]);
  }
  return sum;
}

void reflect(Motion& y) {
  y[rise] = std::abs(y[rise]);
  const double square = y[6] * y[6] + y[7] * y[7] + y[8] * y[8];
  if (square > 1.0) {  // the same attitude, away from the singularity
    for (std::size_t i = 6; i < 9; ++i) y[i] /= -square;
  }
}

// Time of height 0 within a step that ends below the floor.
template <class Sample>
double find_impact(double begin, double end, Motion& y, Sample&& sample) {
  double time = end;
  for (int i = 0; i < 20; ++i) {
    const double next = std::clamp(time - y[height] / y[rise], begin, end);
    const bool found = std::abs(next - time) < 1e-13;
    time = next;
    if (found) break;
    sample(time, y);
  }
  return time;
}

class ByFlow {
public:
  explicit ByFlow(carom::FlowMethod method)
      : flow_(carom::make_flow(method, body_, tolerance)),
        keep_step_(method == carom::FlowMethod::explicit_runge_kutta) {
    flow_->start(0.0, at_start, 0.0);
  }
  void to_next_impact() {
    do {
      flow_->advance(longest_step);
    } while (flow_->state()[height] >= 0.0);
    std::copy(flow_->state().begin(), flow_->state().end(), motion_.begin());
    const auto sample = [&](double time, Motion& y) { flow_->sample(time, y); };
    const double time = find_impact(flow_->begin(), flow_->end(), motion_, sample);
    flow_->land(time, motion_);
    reflect(motion_);
    // Steps of a high order are too long for the first order that the others start with.
    flow_->start(time, motion_, keep_step_ ? flow_->next_step() : 0.0);
  }
  [[nodiscard]] const Motion& motion() const { return motion_; }
  [[nodiscard]] double evaluations() const { return static_cast<double>(flow_->counts().evaluations); }

private:
  Body body_;
  std::unique_ptr<carom::Flow> flow_;
  bool keep_step_;
  Motion motion_ = at_start;
};

class ByHand {
public:
  void to_next_impact() {
    Motion before;
    do {
      before = motion_;
      step(before, longest_step, motion_);
    } while (motion_[height] >= 0.0);
    Motion y = motion_;
    const double length =
        find_impact(0.0, longest_step, y, [&](double time, Motion& at) { step(before, time, at); });
    step(before, length, motion_);
    reflect(motion_);
  }
  [[nodiscard]] const Motion& motion() const { return motion_; }
  [[nodiscard]] double evaluations() const { return evaluations_; }

private:
  void step(const Motion& from, double h, Motion& to) {
    std::array<Motion, 4> k;
    Motion y;
    rates(from.data(), k[0].data());
    for (std::size_t i = 0; i < size; ++i) y[i] = from[i] + 0.5 * h * k[0][i];
    rates(y.data(), k[1].data());
    for (std::size_t i = 0; i < size; ++i) y[i] = from[i] + 0.5 * h * k[1][i];
    rates(y.data(), k[2].data());
    for (std::size_t i = 0; i < size; ++i) y[i] = from[i] + h * k[2][i];
    rates(y.data(), k[3].data());
    for (std::size_t i = 0; i < size; ++i) {
      to[i] = from[i] + h / 6.0 * (k[0][i] + 2.0 * (k[1][i] + k[2][i]) + k[3][i]);
    }
    evaluations_ += 4.0;
  }

  Motion motion_ = at_start;
  double evaluations_ = 0.0;
};

template <class Bouncing>
void time_impacts(benchmark::State& state, Bouncing&& body) {
  constexpr int impacts = 200;
  for (auto _ : state) {
    for (int i = 0; i < impacts; ++i) body.to_next_impact();
    auto motion = body.motion();
    benchmark::DoNotOptimize(motion);
  }
  // An impact that is missed or found in the wrong place does not keep the energy.
  const double drift = std::abs(energy(body.motion()) - energy(at_start));
  const double done = impacts * static_cast<double>(state.iterations());
  if (!(drift <= 1e-6 * done)) throw std::logic_error("the bouncing body does not keep its energy");
  using benchmark::Counter;
  state.counters["per_impact"] = Counter(impacts, Counter::kIsIterationInvariantRate | Counter::kInvert);
  state.counters["evaluations"] = body.evaluations() / done;
  state.counters["drift"] = drift / done;
}

void bounce_by_hand(benchmark::State& state) { time_impacts(state, ByHand()); }
void bounce_runge_kutta(benchmark::State& state) {
  time_impacts(state, ByFlow(carom::FlowMethod::explicit_runge_kutta));
}
void bounce_adams(benchmark::State& state) { time_impacts(state, ByFlow(carom::FlowMethod::adams)); }
void bounce_bdf(benchmark::State& state) { time_impacts(state, ByFlow(carom::FlowMethod::bdf)); }

BENCHMARK(bounce_by_hand);
BENCHMARK(bounce_runge_kutta);
BENCHMARK(bounce_adams);
BENCHMARK(bounce_bdf);

namespace planar = carom::planar;

/// Turns and falls.
carom::System stiff_net(int side) {
  carom::System system;
  system.add(planar::Gravity{{0.0, -gravity}});
  std::vector<carom::BodyId> bodies;
  for (int i = 0; i < side * side; ++i) {
    const double x = i / side, y = i % side;
    bodies.push_back(
        system.add(planar::Particle{.mass = 1.0, .position = {x, y}, .velocity = {-0.5 * y, 0.5 * x}}));
  }
  const auto tie = [&](int from, int to, double length) {
    system.add(planar::SpringDamper{.from = bodies[static_cast<std::size_t>(from)],
                                    .to = bodies[static_cast<std::size_t>(to)],
                                    .stiffness = 1e7,
                                    .damping = 1e5,
                                    .free_length = length});
  };
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      const int here = i * side + j;
      if (i + 1 < side) tie(here, here + side, 1.0);
      if (j + 1 < side) tie(here, here + 1, 1.0);
      if (i + 1 == side || j + 1 == side) continue;
      tie(here, here + side + 1, std::numbers::sqrt2);
      tie(here + side, here + 1, std::numbers::sqrt2);
    }
  }
  return system;
}

/// Falls from level, one end pinned to the ground.
carom::System stiff_chain(int links) {
  carom::System system;
  system.add(planar::Gravity{{0.0, -gravity}});
  carom::BodyId last = carom::ground;
  for (int i = 0; i < links; ++i) {
    const carom::BodyId link =
        system.add(planar::RigidBody{.mass = planar::rod(1.0, 1.0), .position = {i + 0.5, 0.0}});
    const carom::End<2> before = i == 0 ? carom::End<2>(last) : carom::End<2>(last, {0.5, 0.0});
    system.add(planar::Revolute{.from = before, .to = {link, {-0.5, 0.0}}});
    if (i > 0) {
      system.add(planar::TorsionalSpring{.from = last, .to = link, .stiffness = 1e6, .damping = 1e4});
    }
    last = link;
  }
  return system;
}

void time_steps(benchmark::State& state, const carom::System& system, carom::FlowMethod method, double end) {
  double steps = 0.0, unknowns = 0.0, seconds = 0.0;
  for (auto _ : state) {
    carom::Simulation simulation(
        system, carom::EventDriven{.relative_tolerance = 1e-6, .absolute_tolerance = 1e-8, .method = method});
    const auto start = std::chrono::steady_clock::now();
    simulation.run_until(end);
    const double taken = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    state.SetIterationTime(taken);
    seconds += taken;
    steps += static_cast<double>(simulation.statistics().flow_steps);
    unknowns = static_cast<double>(simulation.state().q.size() + simulation.state().v.size());
    const double energy = simulation.energy().kinetic();
    if (!(energy > 0.0) || !(std::abs(simulation.energy().residual()) <= 1e-2 * energy)) {
      throw std::logic_error("the energy ledger of stiff motion does not close");
    }
  }
  state.counters["unknowns"] = unknowns;
  state.counters["steps"] = steps / static_cast<double>(state.iterations());
  state.counters["per_unknown"] = seconds / (steps * unknowns);
}

void net_bdf(benchmark::State& state) {
  time_steps(state, stiff_net(static_cast<int>(state.range(0))), carom::FlowMethod::bdf, 0.02);
}
void net_runge_kutta(benchmark::State& state) {
  const auto side = static_cast<int>(state.range(0));
  time_steps(state, stiff_net(side), carom::FlowMethod::explicit_runge_kutta, 0.02);
}
void chain_bdf(benchmark::State& state) {
  time_steps(state, stiff_chain(static_cast<int>(state.range(0))), carom::FlowMethod::bdf, 0.02);
}

// 100, 1,000 and 10,000 unknowns.
BENCHMARK(net_bdf)->Arg(5)->Arg(16)->Arg(50)->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK(net_runge_kutta)->Arg(5)->Arg(16)->Arg(50)->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK(chain_bdf)->Arg(17)->Arg(167)->Arg(1667)->UseManualTime()->Unit(benchmark::kMillisecond);

}  // namespace
