// Problem: how far bodies turn and go in a step, and how large what they belong to is.

#include <carom/core/numerics/largest_of.h>
#include <carom/integrators/time_stepping/far_turn.h>

#include <algorithm>
#include <cmath>

namespace carom {

FastestTurn fastest_turn(const StepInput& in, Index component) {
  FastestTurn fastest;
  const Layout& layout = *in.assembly.layout();
  const Range bodies = in.assembly.components()[component].bodies;
  for (Index body = bodies.begin; body < bodies.end; ++body) {
    const BodySlot slot = layout.bodies()[body];
    if (slot.rotation == none) continue;
    const double angle = in.step * std::abs(in.start.v[slot.v + 2]);
    if (angle > fastest.angle) fastest = {layout.id(body), angle};
  }
  return fastest;
}

double longest_way(const StepInput& in, Range v, const std::vector<double>& lengths, const State& end) {
  return 0.5 * in.step * largest_of(v, [&](auto at) {
           return at(lengths.data()) * (magnitude(at(in.start.v.data())) + magnitude(at(end.v.data())));
         });
}

double size_of(const Assembly& assembly, Range bodies, const std::vector<double>& lengths, const State& at) {
  double size = 0.0;
  for (Index body = bodies.begin; body < bodies.end; ++body) {
    const BodySlot slot = assembly.layout()->bodies()[body];
    for (Index q = slot.q; q < slot.q + slot.q_size; ++q) size = std::max(size, std::abs(at.q[q]));
    if (slot.rotation != none) size = std::max(size, lengths[slot.v + 2]);
  }
  return size;
}

bool moves_far(const StepInput& in, const State& end) {
  constexpr double far = 1e-3;
  const std::vector<double> lengths = in.assembly.length_scales();
  const Range bodies{0, static_cast<Index>(in.assembly.layout()->bodies().size())};
  const double way = longest_way(in, {0, in.assembly.layout()->v_size()}, lengths, end);
  return way > far * size_of(in.assembly, bodies, lengths, in.start);
}

}  // namespace carom
