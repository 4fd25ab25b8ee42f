#include <carom/core/dynamics/prescribed_joints.h>
#include <carom/core/listed.h>

#include <limits>
#include <string>

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
  constexpr PrescribedLaw::Names names{};  // of a coordinate
  for (Law& law : laws_) {
    auto at = [&](double time) { return law.kind->prescribed(law.slot, time); };
    if (law.last.time != from) law.last = at(from);
    auto name = [&] { return assembly_->system().name(law.id); };
    const LawPoint end = at(to);
    PrescribedLaw(at, name, names).demand_continuous(law.last, end);
    law.last = end;
  }
}

std::string driven_by(const Assembly& assembly, std::span<const Index> components) {
  std::vector<std::string> names;
  for (const Index component : components) {
    for (Index k = 0; k < assembly.joint_kinds().size(); ++k) {
      if (!assembly.joint_kinds()[k]->depends_on_time()) continue;
      const Range range = assembly.joints(component, k);
      for (Index joint = range.begin; joint < range.end; ++joint) {
        names.push_back(assembly.system().name(assembly.joint_id(k, joint)));
      }
    }
  }
  return names.empty() ? std::string() : "; bodies are driven by " + listed(names);
}

}  // namespace carom
