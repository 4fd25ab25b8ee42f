// Problem: where loads alone would lead bodies.

#include <carom/core/numerics/pair.h>
#include <carom/integrators/time_stepping/free_bodies.h>

#include <cstddef>

namespace carom {

namespace {

/// v_free = v_j + M^-1 h (F_j + F_{j+1})/2 of one body, and no impulses yet. \tparam N of its velocities, if
/// known when this is compiled \param loads0 over all velocities, at the start \param loads1 at the end
template <std::size_t N>
void free_body(const StepInput& in, const double* loads0, const double* loads1, const BodySlot& body,
               StepTrial& trial) {
  const std::size_t size = N != 0 ? N : static_cast<std::size_t>(body.v_size);
  const double half = 0.5 * in.step;
  double *const dv = trial.dv_impulses.data() + body.v, *const free = trial.free.data() + body.v;
  const double *const load0 = loads0 + body.v, *const load1 = loads1 + body.v;
  const double* const start = in.start.v.data() + body.v;
  const float* const rounding = in.companion.rounding.data() + body.v;
  for (std::size_t k = 0; k < size; ++k) dv[k] = half * (load0[k] + load1[k]);
  in.assembly.body_kinds()[body.kind]->apply_inverse_mass({body.slot, body.slot + 1}, dv, free);
  for (std::size_t k = 0; k < size; ++k) {
    free[k] += static_cast<double>(rounding[k]) + start[k];
    dv[k] = 0.0;
  }
}

/// Likewise of some bodies that turn in the plane and whose velocities follow one another, under loads that
/// last. \param v first of their velocities
void free_planar_bodies(const StepInput& in, const double* loads, const BodyMasses& masses, Index count,
                        Index v, StepTrial& trial) {
  const BodyMasses m = masses;  // a copy that no store can change
  const double half = 0.5 * in.step;
  double *dv = trial.dv_impulses.data() + v, *free = trial.free.data() + v;
  const double *load = loads + v, *start = in.start.v.data() + v;
  const float* rounding = in.companion.rounding.data() + v;
  for (Index i = 0; i < count; ++i, dv += 3, free += 3, load += 3, start += 3, rounding += 3) {
    const Pair force = load_pair(load), before = load_pair(rounding) + load_pair(start);
    store_pair(free, both(half) * (force + force) / both(m.mass[m.stride * i]) + before);
    free[2] =
        half * (load[2] + load[2]) / m.inertia[m.stride * i] + (static_cast<double>(rounding[2]) + start[2]);
    store_pair(dv, Pair{});
    dv[2] = 0.0;
  }
}

}  // namespace

void free_body(const StepInput& in, const double* loads0, const double* loads1, Index body,
               StepTrial& trial) {
  constexpr Index of_planar_body = 3;
  const BodySlot slot = in.assembly.layout()->bodies()[body];
  if (slot.v_size == of_planar_body) return free_body<of_planar_body>(in, loads0, loads1, slot, trial);
  free_body<0>(in, loads0, loads1, slot, trial);
}

void free_alone(const StepInput& in, const double* loads, const MassResponse& response,
                const Constraint::Block& body, StepTrial& trial) {
  const BodyMasses masses = response.alone(body.body);
  if (masses.layout != BodyMasses::Layout::planar_bodies)
    return free_body(in, loads, loads, body.body, trial);
  free_planar_bodies(in, loads, masses, 1, body.v, trial);
}

void free_bodies(const StepInput& in, const double* loads, std::span<const Index> bodies, StepTrial& trial) {
  const double half = 0.5 * in.step;
  double *const dv = trial.dv_impulses.data(), *const free = trial.free.data();
  const double* const start = in.start.v.data();
  const float* const rounding = in.companion.rounding.data();
  for (std::size_t first = 0, last = 0; first < bodies.size(); first = last) {
    const Index begin = bodies[first];
    while (last < bodies.size() && bodies[last] - begin == last - first) ++last;
    if (last - first == 1) {
      free_body(in, loads, loads, begin, trial);
      continue;
    }
    const Range range{begin, begin + static_cast<Index>(last - first)};
    in.assembly.for_bodies(range, [&](const BodyKind& kind, Range slots, Index, Index v, Index) {
      const BodyMasses masses = kind.masses(slots.begin);
      if (masses.layout == BodyMasses::Layout::planar_bodies)
        return free_planar_bodies(in, loads, masses, slots.size(), v, trial);
      const std::size_t end = v + static_cast<std::size_t>(slots.size()) * kind.v_size();
      for (std::size_t k = v; k < end; ++k) dv[k] = half * (loads[k] + loads[k]);
      kind.apply_inverse_mass(slots, dv + v, free + v);
      for (std::size_t k = v; k < end; ++k) {
        free[k] += static_cast<double>(rounding[k]) + start[k];
        dv[k] = 0.0;
      }
    });
  }
}

}  // namespace carom
