#include <carom/integrators/prescribed_joints.h>

#include <limits>
#include <optional>

namespace carom {

PrescribedJoints::PrescribedJoints(const Assembly& assembly) : assembly_(&assembly) {
  for (Index k = 0; k < assembly.joint_kinds().size(); ++k) {
    const JointKind& kind = *assembly.joint_kinds()[k];
    for (Index slot = 0; slot < kind.size(); ++slot) {
      if (!kind.prescribes(slot)) continue;
      laws_.push_back(
          {&kind, slot, assembly.joint_id(k, slot), {.time = std::numeric_limits<double>::quiet_NaN()}});
    }
  }
}

void PrescribedJoints::demand_continuous(double from, double to) {
  for (Law& law : laws_) {
    auto at = [&](double time) { return law.kind->prescribed(law.slot, time); };
    if (law.last.time != from) law.last = at(from);
    const LawPoint end = at(to);
    if (!looks_smooth(law.last, end)) {
      const std::optional<LawJump> jump = find_jump(at, law.last, end);
      if (jump) fail_jump(assembly_->system().name(law.id), "position", "", *jump);
    }
    law.last = end;
  }
}

}  // namespace carom
