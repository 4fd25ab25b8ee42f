// Problem: one sweep over many bodies with as little traffic as can be.

#include <carom/core/numerics/pair.h>
#include <carom/core/space.h>
#include <carom/integrators/time_stepping/pair_change.h>
#include <carom/integrators/time_stepping/step_kernels.h>

namespace carom {

namespace {

/// One sweep over two numbers. \param half h / 2, \param inverse h / (2 m)
template <bool Response>
inline void sweep_pair(const SweepArrays& a, Index at, Pair half, Pair inverse) {
  const Pair v0 = load_pair(a.v0 + at);
  Pair change_of_v =
      inverse * (load_pair(a.load0 + at) + load_pair(a.load1 + at)) + load_pair(a.carried + at);
  if constexpr (Response) change_of_v += load_pair(a.response + at);
  const Pair v = v0 + change_of_v;
  store_pair(a.cut + at, change_of_v - (v - v0));
  store_pair(a.q1 + at, load_pair(a.q0 + at) + half * (v0 + v));
  store_pair(a.v1 + at, v);
}

inline void sweep_number(const SweepArrays& a, Index at, double half, double inverse) {
  const double change_of_v =
      inverse * (a.load0[at] + a.load1[at]) + a.carried[at] + (a.response ? a.response[at] : 0.0);
  const double v = a.v0[at] + change_of_v;
  a.cut[at] = static_cast<float>(change_of_v - (v - a.v0[at]));
  a.q1[at] = a.q0[at] + half * (a.v0[at] + v);
  a.v1[at] = v;
}

/// Calls f(place, factor) for pairs of numbers of points that can be taken two by two (all of one mass, or
/// planar), `factor` being `over_mass` divided by the mass. Returns how many numbers were done.
template <int D, class F>
inline Index for_pairs(const BodyMasses& masses, Index count, double over_mass, F&& f) {
  const Index numbers = count * D;
  Index at = 0;
  if (masses.stride == 0) {
    const Pair factor = both(over_mass / masses.mass[0]);
    for (; at + 1 < numbers; at += 2) f(at, factor);
  } else if constexpr (D == 2) {
    const double* const mass = masses.mass;
    for (; at < numbers; at += 2) f(at, both(over_mass / mass[at / 2]));
  }
  return at;
}

template <int D>
void sweep_points(const BodyMasses& masses, Index count, double step, const SweepArrays& arrays) {
  const SweepArrays a = arrays;  // a copy that no store can change: its pointers stay in registers
  const double half = 0.5 * step;
  const Index numbers = count * D;
  Index at = 0;
  if (a.response != nullptr) {
    at = for_pairs<D>(masses, count, half,
                      [&](Index place, Pair inverse) { sweep_pair<true>(a, place, both(half), inverse); });
  } else {
    at = for_pairs<D>(masses, count, half,
                      [&](Index place, Pair inverse) { sweep_pair<false>(a, place, both(half), inverse); });
  }
  for (; at < numbers; ++at) sweep_number(a, at, half, half / masses.mass[masses.stride * (at / D)]);
}

template <int D>
void add_change_of_points(const BodyMasses& masses, Index count, double weight, double step,
                          const LoadArrays& a, SweepChange& change) {
  const Index numbers = count * D;
  PairChange seen;
  const Pair h = both(step);
  Index at = for_pairs<D>(masses, count, weight * step, [&](Index place, Pair factor) {
    seen.take(factor * (load_pair(a.led_to + place) - load_pair(a.made_with + place)),
              larger(magnitude(load_pair(a.q1 + place)), magnitude(h * load_pair(a.v1 + place))));
  });
  seen.add_to(change);
  for (; at < numbers; ++at) {
    const double factor = weight * step / masses.mass[masses.stride * (at / D)];
    change.take(factor * (a.led_to[at] - a.made_with[at]), a.q1[at]);
    change.take(0.0, step * a.v1[at]);
  }
}

/// Bodies of one kind of sweep. \param turn turn(angle by which a body turns at its mean spin)
template <bool Response, class Turn>
void sweep_planar_bodies(const BodyMasses& masses, Index count, double step, const SweepArrays& arrays,
                         Turn&& turn) {
  const SweepArrays a = arrays;  // as above
  const BodyMasses m = masses;
  const double half = 0.5 * step;
  for (Index body = 0, at = 0; body < count; ++body, at += 3) {
    const Pair inverse = both(half) / Pair{m.mass[m.stride * body], m.inertia[m.stride * body]};
    sweep_pair<Response>(a, at, both(half), both(inverse[0]));
    const Index angle = at + 2;
    double change_of_v = inverse[1] * (a.load0[angle] + a.load1[angle]) + a.carried[angle];
    if constexpr (Response) change_of_v += a.response[angle];
    const double v = a.v0[angle] + change_of_v;
    a.cut[angle] = static_cast<float>(change_of_v - (v - a.v0[angle]));
    a.q1[angle] = a.q0[angle] + turn(half * (a.v0[angle] + v));
    a.v1[angle] = v;
  }
}

void sweep_planar_bodies(const BodyMasses& masses, Index count, double step, const SweepArrays& a) {
  const auto at_rate = [](double angle) { return angle; };
  const auto rational = [](double angle) { return Space<2>::rational_turn(angle); };
  if (a.response != nullptr) {
    if (a.rational_turn) return sweep_planar_bodies<true>(masses, count, step, a, rational);
    return sweep_planar_bodies<true>(masses, count, step, a, at_rate);
  }
  if (a.rational_turn) return sweep_planar_bodies<false>(masses, count, step, a, rational);
  sweep_planar_bodies<false>(masses, count, step, a, at_rate);
}

void add_change_of_planar_bodies(const BodyMasses& masses, Index count, double weight, double step,
                                 const LoadArrays& a, SweepChange& change) {
  PairChange seen;
  const Pair h = both(step), of_loads = both(weight * step);
  for (Index body = 0, at = 0; body < count; ++body, at += 3) {
    const double radius = masses.gyration_radius[masses.stride * body];
    const Pair factor =
        of_loads / Pair{masses.mass[masses.stride * body], masses.inertia[masses.stride * body]};
    seen.take(both(factor[0]) * (load_pair(a.led_to + at) - load_pair(a.made_with + at)),
              larger(magnitude(load_pair(a.q1 + at)), magnitude(h * load_pair(a.v1 + at))));
    const Index angle = at + 2;
    seen.take(Pair{factor[1] * radius * (a.led_to[angle] - a.made_with[angle]), 0.0},
              both(radius) * Pair{a.q1[angle], step * a.v1[angle]});
  }
  seen.add_to(change);
}

}  // namespace

void sweep_bodies(const BodyMasses& masses, Index count, double step, const SweepArrays& arrays) {
  switch (masses.layout) {
    case BodyMasses::Layout::planar_points:
      return sweep_points<2>(masses, count, step, arrays);
    case BodyMasses::Layout::spatial_points:
      return sweep_points<3>(masses, count, step, arrays);
    case BodyMasses::Layout::planar_bodies:
      return sweep_planar_bodies(masses, count, step, arrays);
  }
}

void add_next_change(const BodyMasses& masses, Index count, double weight, double step,
                     const LoadArrays& loads, SweepChange& change) {
  switch (masses.layout) {
    case BodyMasses::Layout::planar_points:
      return add_change_of_points<2>(masses, count, weight, step, loads, change);
    case BodyMasses::Layout::spatial_points:
      return add_change_of_points<3>(masses, count, weight, step, loads, change);
    case BodyMasses::Layout::planar_bodies:
      return add_change_of_planar_bodies(masses, count, weight, step, loads, change);
  }
}

}  // namespace carom
