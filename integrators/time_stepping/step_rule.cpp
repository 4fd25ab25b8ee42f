#include <carom/core/numerics/pair.h>
#include <carom/integrators/time_stepping/step_kernels.h>
#include <carom/integrators/time_stepping/step_rule.h>

namespace carom {

namespace {

/// Work of the impulse of loads a and b at the ends of a step: impulse times mean velocity, exact for the
/// kinetic energy [J].
double work(const double* a, const double* b, const State& start, const State& end, Range v, double step) {
  Pair pairs = both(0.0);
  Index i = v.begin;
  for (; i + 1 < v.end; i += 2) {
    pairs +=
        (load_pair(start.v.data() + i) + load_pair(end.v.data() + i)) * (load_pair(a + i) + load_pair(b + i));
  }
  double sum = pairs[0] + pairs[1];
  if (i < v.end) sum += (start.v[i] + end.v[i]) * (a[i] + b[i]);
  return 0.25 * step * sum;
}

/// The same of loads that are `loads` at both ends: sums that do not wait for each other.
double work(const double* loads, const State& start, const State& end, Range v, double step) {
  Pair first = both(0.0), second = both(0.0);
  const auto pair = [&](Index i) {
    const Pair load = load_pair(loads + i);
    return (load_pair(start.v.data() + i) + load_pair(end.v.data() + i)) * (load + load);
  };
  Index i = v.begin;
  for (; i + 3 < v.end; i += 4) {
    first += pair(i);
    second += pair(i + 2);
  }
  if (i + 1 < v.end) {
    first += pair(i);
    i += 2;
  }
  first += second;
  double sum = first[0] + first[1];
  if (i < v.end) sum += (start.v[i] + end.v[i]) * (loads[i] + loads[i]);
  return 0.25 * step * sum;
}

}  // namespace

void StepRule::move(const StepInput& in, const BodyPlace& bodies, const BodyMasses& masses,
                    const EndLoads& loads, bool with_impulses, StepTrial& trial) const {
  const Index q = bodies.q, v = bodies.v;
  sweep_bodies(masses, bodies.slots.size(), in.step,
               {in.start.q.data() + q, in.start.v.data() + v, in.companion.rounding.data() + v,
                loads.start + v, loads.end + v, with_impulses ? trial.dv_impulses.data() + v : nullptr,
                trial.end.q.data() + q, trial.end.v.data() + v, trial.rounding.data() + v, is_mean()});
}

void StepRule::move(const StepInput& in, Range bodies, const double* load0, const double* load1,
                    bool with_impulses, StepTrial& trial) const {
  in.assembly.for_bodies(bodies, [&](const BodyKind& kind, Range slots, Index q, Index v, Index) {
    move(in, {&kind, slots, q, v}, kind.masses(slots.begin), {load0, load1}, with_impulses, trial);
  });
}

SweepChange StepRule::next_change(const StepInput& in, Range bodies, const StepTrial& trial) const {
  SweepChange change;
  in.assembly.for_bodies(bodies, [&](const BodyKind& kind, Range slots, Index q, Index v, Index) {
    add_next_change(kind.masses(slots.begin), slots.size(), impulse_weight(in.step), in.step,
                    {trial.loads_guess.data() + v, trial.loads_end.total.data() + v, trial.end.q.data() + q,
                     trial.end.v.data() + v},
                    change);
  });
  return change;
}

double StepRule::work(const StepInput& in, const double* start, const double* end, Range v,
                      const StepTrial& trial) const {
  return carom::work(start, end, in.start, trial.end, v, in.step);
}

BlockWorks StepRule::works(const StepInput& in, const Block& block, const StepTrial& trial) const {
  const auto of_cause = [&](const std::vector<double>& at_start, const std::vector<double>& at_end) {
    if (at_end.empty()) return 0.0;
    const double* const first = is_mean() ? at_end.data() : at_start.data();
    return carom::work(first, at_end.data(), in.start, trial.end, block.v, in.step);
  };
  BlockWorks sums{};
  sums.total =
      carom::work(start_of_sum(in, trial), trial.loads_guess.data(), in.start, trial.end, block.v, in.step);
  sums.dissipative = of_cause(in.companion.loads.dissipative, trial.loads_end.dissipative);
  sums.external = of_cause(in.companion.loads.external, trial.loads_end.external);
  sums.kinetic = kinetic_energy(in.assembly, block.bodies, trial.end.v.data());
  return sums;
}

void StepRule::works_constant(const StepInput& in, Range bodies, Range v, const StepTrial& trial,
                              BlockWorks& out) const {
  out.total = work_constant(in, v, trial);
  out.kinetic = kinetic_energy(in.assembly, bodies, trial.end.v.data());
  out.dissipative = out.external = 0.0;
}

double StepRule::work_constant(const StepInput& in, Range v, const StepTrial& trial) const {
  return carom::work(in.companion.loads.total.data(), in.start, trial.end, v, in.step);
}

}  // namespace carom
