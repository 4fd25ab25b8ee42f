#include <carom/integrators/event_driven/event_motions.h>

#include <algorithm>

namespace carom {

EventMotions motions_of(const Constraint& constraint, const StateView& state, const Assembly& assembly) {
  const Layout& layout = *assembly.layout();
  EventMotions motions{};
  for (std::size_t i = 0; i < static_cast<std::size_t>(constraint.bodies); ++i) {
    const Index body = constraint.blocks[i].body;
    const BodySlot slot = layout.bodies()[body];
    motions[i].body = layout.id(body);
    std::copy_n(state.q + slot.q, std::min<Index>(slot.q_size, 3), motions[i].position.begin());
  }
  set_after(constraint, state.v, assembly, motions);
  for (EventMotion& motion : motions) motion.velocity_before = motion.velocity_after;
  return motions;
}

void set_after(const Constraint& constraint, const double* velocities, const Assembly& assembly,
               EventMotions& motions) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(constraint.bodies); ++i) {
    const BodySlot slot = assembly.layout()->bodies()[constraint.blocks[i].body];
    std::copy_n(velocities + slot.v, std::min<Index>(slot.v_size, 3), motions[i].velocity_after.begin());
  }
}

}  // namespace carom
