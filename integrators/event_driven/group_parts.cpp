#include <carom/core/errors.h>
#include <carom/integrators/event_driven/group_parts.h>

namespace carom {

GroupParts::GroupParts(const Assembly& assembly, const Detector& contacts, const EventDriven& options,
                       const GroupComponents& components, GroupMemory& shared)
    : memory(&shared),
      motion(assembly, contacts, components, options, shared.motion),
      failure(motion.model(), clock),
      detector(motion, failure, unbounded, shared.detection),
      impacts(failure, shared.impacts),
      modes(failure, impacts, unbounded, shared.modes, shared.chain),
      closure(motion, failure),
      limits(motion, failure, shared.work),
      flow(shared.flows, motion),
      output(motion.model().unknowns),
      y(motion.size()) {
  if (assembly.layout()->dimension() == 3 && !motion.model().pairs.empty()) {
    // Sliding in two directions has modes that are not written yet; taken as planar it would stick at once.
    const BodyId body = assembly.layout()->id(motion.model().pairs.front().body);
    throw ModelError(
        "event-driven mode: " + assembly.system().name(body) +
        " may touch an obstacle in space; allowed: contact in the plane (time stepping does both)");
  }
}

}  // namespace carom
