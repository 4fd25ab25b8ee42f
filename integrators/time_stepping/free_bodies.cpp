// Problem: where loads alone would lead bodies.

#include <carom/core/numerics/pair.h>
#include <carom/integrators/time_stepping/free_bodies.h>

#include <cstddef>

namespace carom {

namespace {

/// v_free = v_j + M^-1 h (F_j + F_{j+1})/2 of some bodies of a kind that follow one another, and no impulses
/// yet. \param loads0 over all velocities, at the start \param loads1 at the end \param first of their
/// velocities
void free_some(const StepInput& in, const double* loads0, const double* loads1, const BodyKind& kind,
               Range slots, Index first, StepTrial& trial) {
  const std::size_t size = static_cast<std::size_t>(slots.size()) * kind.v_size();
  const double half = 0.5 * in.step;
  double *const dv = trial.dv_impulses.data() + first, *const free = trial.free.data() + first;
  const double *const load0 = loads0 + first, *const load1 = loads1 + first;
  const double* const start = in.start.v.data() + first;
  const float* const rounding = in.companion.rounding.data() + first;
  for (std::size_t k = 0; k < size; ++k) dv[k] = half * (load0[k] + load1[k]);
  kind.apply_inverse_mass(slots, dv, free);
  for (std::size_t k = 0; k < size; ++k) {
    free[k] += static_cast<double>(rounding[k]) + start[k];
    dv[k] = 0.0;
  }
}

/// The same of bodies that turn in the plane, which most are, in one loop.
void free_planar(const StepInput& in, const double* loads0, const double* loads1, const BodyMasses& masses,
                 Index count, Index first, StepTrial& trial) {
  const BodyMasses m = masses;  // a copy that no store can change
  const double half = 0.5 * in.step;
  double *dv = trial.dv_impulses.data() + first, *free = trial.free.data() + first;
  const double *load0 = loads0 + first, *load1 = loads1 + first, *start = in.start.v.data() + first;
  const float* rounding = in.companion.rounding.data() + first;
  for (Index i = 0; i < count; ++i) {
    const Pair force = load_pair(load0) + load_pair(load1);
    store_pair(free,
               both(half) * force / both(m.mass[m.stride * i]) + (load_pair(rounding) + load_pair(start)));
    free[2] = half * (load0[2] + load1[2]) / m.inertia[m.stride * i] +
              (static_cast<double>(rounding[2]) + start[2]);
    store_pair(dv, Pair{});
    dv[2] = 0.0;
    dv += 3, free += 3, load0 += 3, load1 += 3, start += 3, rounding += 3;
  }
}

void free_of_kind(const StepInput& in, const double* loads0, const double* loads1, const BodyKind& kind,
                  Range slots, Index first, StepTrial& trial) {
  const BodyMasses masses = kind.masses(slots.begin);
  if (masses.layout == BodyMasses::Layout::planar_bodies)
    return free_planar(in, loads0, loads1, masses, slots.size(), first, trial);
  free_some(in, loads0, loads1, kind, slots, first, trial);
}

}  // namespace

void free_body(const StepInput& in, const double* loads0, const double* loads1, Index body,
               StepTrial& trial) {
  const BodySlot slot = in.assembly.layout()->bodies()[body];
  free_of_kind(in, loads0, loads1, *in.assembly.body_kinds()[slot.kind], {slot.slot, slot.slot + 1}, slot.v,
               trial);
}

void free_alone(const StepInput& in, const double* loads, const MassResponse& response,
                const Constraint::Block& body, StepTrial& trial) {
  const BodyMasses masses = response.alone(body.body);
  if (masses.layout != BodyMasses::Layout::planar_bodies)
    return free_body(in, loads, loads, body.body, trial);
  free_planar(in, loads, loads, masses, 1, body.v, trial);
}

void free_bodies(const StepInput& in, const double* loads, std::span<const Index> bodies, StepTrial& trial) {
  for (std::size_t first = 0, last = 0; first < bodies.size(); first = last) {
    const Index begin = bodies[first];
    while (last < bodies.size() && bodies[last] - begin == last - first) ++last;
    const Range range{begin, begin + static_cast<Index>(last - first)};
    in.assembly.for_bodies(range, [&](const BodyKind& kind, Range slots, Index, Index v, Index) {
      free_of_kind(in, loads, loads, kind, slots, v, trial);
    });
  }
}

}  // namespace carom
