// Problem: say which body of a mechanism turns too far for the step.

#include <carom/integrators/time_stepping/far_turn.h>

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

}  // namespace carom
