#include "benchmarks/plain_discs.h"

#include "benchmarks/discs.h"

#include <algorithm>
#include <array>

namespace benchmarks {

PlainDiscs::PlainDiscs(int count, double radius, double height) {
  for (int i = 0; i < count; ++i) {
    const carom::Vec<2> at = disc_position(i, radius, height);
    const double m = disc_density * radius * radius;
    mass.push_back(m);
    inertia.push_back(0.5 * m * radius * radius);
    q.insert(q.end(), {at[0], at[1], 0.0});
    v.insert(v.end(), {disc_speed, 0.0, disc_spin});
    load.insert(load.end(), {0.0, -disc_gravity * m, 0.0});
  }
  carried.resize(v.size());
}

void plain_step(PlainDiscs& discs, double step) {
  const double half = 0.5 * step;
  double kinetic = 0.0, potential = 0.0, work = 0.0;
  double* const q = discs.q.data();
  double* const v = discs.v.data();
  float* const carried = discs.carried.data();
  const double* const load = discs.load.data();
  for (std::size_t i = 0; i < discs.size(); ++i) {
    const std::array<double, 3> masses{discs.mass[i], discs.mass[i], discs.inertia[i]};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t j = 3 * i + k;
      const double v0 = v[j], change = step / masses[k] * load[j] + carried[j];
      const double v1 = v0 + change;
      carried[j] = static_cast<float>(change - (v1 - v0));
      q[j] += half * (v0 + v1);
      v[j] = v1;
      kinetic += 0.5 * masses[k] * v1 * v1;
      work += half * load[j] * (v0 + v1);
    }
    potential -= load[3 * i] * q[3 * i] + load[3 * i + 1] * q[3 * i + 1];
  }
  discs.kinetic = kinetic;
  discs.potential = potential;
  discs.work = work;
}

void plain_step_with_gaps(PlainDiscs& discs, double radius, double step) {
  plain_step(discs, step);
  double lowest = discs.q[1] - radius;
  for (std::size_t i = 0; i < discs.size(); ++i) lowest = std::min(lowest, discs.q[3 * i + 1] - radius);
  discs.lowest = lowest;
}

}  // namespace benchmarks
