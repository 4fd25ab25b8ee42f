#include "benchmarks/plain_net.h"

#include <algorithm>

#if defined(__x86_64__)
#define CAROM_AVX2 [[gnu::target("avx2,fma")]]
#else
#define CAROM_AVX2
#endif

namespace benchmarks {

namespace {

using Spring = PlainNet::Spring;

// Inlined by force, so that each caller compiles it for its own instruction set.
[[gnu::always_inline]] inline void weigh(PlainNet& net) {
  double* const force = net.force.data();
  for (std::size_t i = 0; i < net.size(); ++i) {
    force[2 * i] = 0.0;
    force[2 * i + 1] = -scenes::net_gravity * net.mass[i];
  }
}

[[gnu::always_inline]] inline void pull(PlainNet& net) {
  const double* const q = net.q.data();
  const double* const v = net.v.data();
  double* const force = net.force.data();
  for (const Spring& spring : net.springs) {
    const std::uint32_t a = spring.from, b = spring.to;
    const double dx = q[b] - q[a], dy = q[b + 1] - q[a + 1];
    const double ux = v[b] - v[a], uy = v[b + 1] - v[a + 1];
    const double length = std::sqrt(dx * dx + dy * dy);
    const double inverse = 1.0 / length;
    const double tension = spring.stiffness * (length - spring.free_length) * inverse +
                           spring.damping * (dx * ux + dy * uy) * (inverse * inverse);
    force[a] += tension * dx;
    force[a + 1] += tension * dy;
    force[b] -= tension * dx;
    force[b + 1] -= tension * dy;
  }
}

[[gnu::always_inline]] inline void pull_blocked(PlainNet& net) {
  constexpr std::size_t block = 64;
  const double* const q = net.q.data();
  const double* const v = net.v.data();
  double* const force = net.force.data();
  double dx[block], dy[block], ux[block], uy[block], k[block], c[block], free[block];
  for (std::size_t first = 0; first < net.springs.size(); first += block) {
    const Spring* const spring = net.springs.data() + first;
    const std::size_t count = std::min(block, net.springs.size() - first);
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t a = spring[i].from, b = spring[i].to;
      dx[i] = q[b] - q[a];
      dy[i] = q[b + 1] - q[a + 1];
      ux[i] = v[b] - v[a];
      uy[i] = v[b + 1] - v[a + 1];
      k[i] = spring[i].stiffness;
      c[i] = spring[i].damping;
      free[i] = spring[i].free_length;
    }
    for (std::size_t i = 0; i < count; ++i) {
      const double length = std::sqrt(dx[i] * dx[i] + dy[i] * dy[i]);
      const double inverse = 1.0 / length;
      const double tension =
          k[i] * (length - free[i]) * inverse + c[i] * (dx[i] * ux[i] + dy[i] * uy[i]) * (inverse * inverse);
      dx[i] *= tension;
      dy[i] *= tension;
    }
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t a = spring[i].from, b = spring[i].to;
      force[a] += dx[i];
      force[a + 1] += dy[i];
      force[b] -= dx[i];
      force[b + 1] -= dy[i];
    }
  }
}

[[gnu::always_inline]] inline void move(PlainNet& net, double step) {
  double* const q = net.q.data();
  double* const v = net.v.data();
  const double* const force = net.force.data();
  for (std::size_t i = 0; i < net.size(); ++i) {
    const double factor = step / net.mass[i];
    for (std::size_t j = 2 * i; j < 2 * i + 2; ++j) {
      v[j] += factor * force[j];
      q[j] += step * v[j];
    }
  }
}

// Trapezoidal rule from q0, v0 with the forces force0 and `force`, which is the guess at those of the end.
void move_implicitly(PlainNet& net, double step) {
  const double half = 0.5 * step;
  for (std::size_t i = 0; i < net.size(); ++i) {
    const double factor = half / net.mass[i];
    for (std::size_t j = 2 * i; j < 2 * i + 2; ++j) {
      net.v[j] = net.v0[j] + factor * (net.force0[j] + net.force[j]);
      net.q[j] = net.q0[j] + half * (net.v0[j] + net.v[j]);
    }
  }
}

// Change by the next sweep, h times velocities [m].
double next_change(const PlainNet& net, const std::vector<double>& acted, double step) {
  double largest = 0.0;
  for (std::size_t i = 0; i < net.size(); ++i) {
    for (std::size_t j = 2 * i; j < 2 * i + 2; ++j) {
      largest = std::max(largest, std::abs(net.force[j] - acted[j]) / net.mass[i]);
    }
  }
  return 0.5 * step * step * largest;
}

}  // namespace

PlainNet::PlainNet(const scenes::Net& net) {
  const auto count = static_cast<std::size_t>(particles(net));
  mass.assign(count, net.mass);
  v.assign(2 * count, 0.0);
  force.assign(2 * count, 0.0);
  for (int i = 0; i < particles(net); ++i) {
    const carom::Vec<2> at = start(net, i);
    q.insert(q.end(), {at[0], at[1]});
  }
  springs.reserve(static_cast<std::size_t>(scenes::springs(net)));
  for_springs(net, [&](int from, int to) {
    springs.push_back({net.stiffness, net.damping, free_length(net, from, to),
                       2 * static_cast<std::uint32_t>(from), 2 * static_cast<std::uint32_t>(to)});
  });
}

void plain_forces(PlainNet& net) {
  weigh(net);
  pull(net);
}

void plain_sweep(PlainNet& net, double step) {
  weigh(net);
  pull(net);
  move(net, step);
}

void plain_sweep_blocked(PlainNet& net, double step) {
  weigh(net);
  pull_blocked(net);
  move(net, step);
}

CAROM_AVX2 void plain_sweep_avx2(PlainNet& net, double step) {
  weigh(net);
  pull(net);
  move(net, step);
}

CAROM_AVX2 void plain_sweep_blocked_avx2(PlainNet& net, double step) {
  weigh(net);
  pull_blocked(net);
  move(net, step);
}

int plain_step(PlainNet& net, double step, double tolerance) {
  if (net.known == 0) {
    plain_forces(net);
    net.q0 = net.q;
    net.v0 = net.v;
    net.force0 = net.before = net.earlier = net.force;
  }
  net.q0.swap(net.q);
  net.v0.swap(net.v);
  net.earlier.swap(net.before);
  net.before.swap(net.force0);
  net.force0.swap(net.force);
  net.known = std::min(net.known + 1, 3);
  // Now force0 is at the start of the step, `before` one step and `earlier` two steps ago.
  for (std::size_t i = 0; i < net.force.size(); ++i) {
    net.force[i] = net.known == 3 ? 3.0 * (net.force0[i] - net.before[i]) + net.earlier[i] : net.force0[i];
  }
  constexpr int most = 100;
  for (int sweeps = 1;; ++sweeps) {
    move_implicitly(net, step);
    net.acted.swap(net.force);
    net.force.resize(net.acted.size());
    plain_forces(net);
    if (next_change(net, net.acted, step) <= tolerance || sweeps == most) return sweeps;
  }
}

bool has_avx2() {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0;
#else
  return false;
#endif
}

}  // namespace benchmarks
