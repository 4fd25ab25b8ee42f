// Cost of the gap of two convex outlines: two discs, a disc and a polygon, two boxes, two polygons of 16
// vertices.

#include <carom/contact/detection/narrow_phase.h>

#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

namespace {

using namespace carom;

std::vector<Vec<2>> regular(int n, double size, double angle, const Vec<2>& centre) {
  std::vector<Vec<2>> vertices;
  for (int i = 0; i < n; ++i) {
    const double at = angle + 2.0 * std::numbers::pi * i / n;
    vertices.push_back(centre + size * Vec<2>(std::cos(at), std::sin(at)));
  }
  return vertices;
}

// Outlines a around the origin, and outlines b around it at distances at which they nearly touch, touch or
// overlap, and at all angles.
struct Pairs {
  Pairs(int vertices_a, double radius_a, int vertices_b, double radius_b) {
    constexpr int count = 256;
    double angle = 0.3;
    for (int i = 0; i < count; ++i) {
      angle += 2.4;
      a.push_back(regular(vertices_a, vertices_a == 1 ? 0.0 : 1.0, 0.7 * angle, Vec<2>::Zero()));
      const double distance = 1.7 + 0.4 * i / count;
      b.push_back(regular(vertices_b, vertices_b == 1 ? 0.0 : 1.0, -0.4 * angle,
                          distance * Vec<2>(std::cos(angle), std::sin(angle))));
    }
    radii = {radius_a, radius_b};
  }
  std::vector<std::vector<Vec<2>>> a, b;
  std::array<double, 2> radii{};
};

void find_all(benchmark::State& state, const Pairs& pairs) {
  std::array<GapPoint, 2> found;
  for (auto _ : state) {
    int count = 0;
    for (std::size_t i = 0; i < pairs.a.size(); ++i) {
      count += find_gaps({pairs.a[i], pairs.radii[0]}, {pairs.b[i], pairs.radii[1]}, 0.02, found);
      benchmark::DoNotOptimize(found);
    }
    benchmark::DoNotOptimize(count);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(pairs.a.size()));
}

void two_discs(benchmark::State& state) { find_all(state, Pairs(1, 1.0, 1, 0.9)); }
void disc_and_box(benchmark::State& state) { find_all(state, Pairs(1, 1.0, 4, 0.0)); }
void two_capsules(benchmark::State& state) { find_all(state, Pairs(2, 0.3, 2, 0.3)); }
void two_boxes(benchmark::State& state) { find_all(state, Pairs(4, 0.0, 4, 0.0)); }
void two_polygons_of_16(benchmark::State& state) { find_all(state, Pairs(16, 0.0, 16, 0.0)); }

BENCHMARK(two_discs);
BENCHMARK(disc_and_box);
BENCHMARK(two_capsules);
BENCHMARK(two_boxes);
BENCHMARK(two_polygons_of_16);

}  // namespace
