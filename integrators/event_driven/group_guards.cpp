// Problem: the guards of a group's elements, with derivatives where elements know them.

#include <carom/integrators/event_driven/group_guards.h>

#include <algorithm>

namespace carom {

GroupGuards::GroupGuards(const Assembly& assembly, std::span<const Index> components) {
  for (const Index component : components) add(assembly, component);
}

void GroupGuards::add(const Assembly& assembly, Index component) {
  for (Index kind = 0; kind < assembly.force_kinds().size(); ++kind) {
    const ForceKind& elements = *assembly.force_kinds()[kind];
    const Range acting = assembly.elements(component, kind);
    const Index each = elements.guard_size();
    if (acting.empty() || each == 0) continue;
    const std::size_t count = static_cast<std::size_t>(each) * acting.size();
    runs_.push_back({component, kind, acting, elements_.size(), count});
    for (Index element = acting.begin; element < acting.end; ++element) {
      elements_.insert(elements_.end(), each, assembly.element_id(kind, element));
    }
    has_motion_.insert(has_motion_.end(), count, static_cast<char>(elements.has_guard_motion()));
    if (!elements.has_guard_motion()) {
      all_have_motion_ = false;
      values_.resize(std::max(values_.size(), count));
    }
  }
}

void GroupGuards::read(EvaluationContext at, const double* acceleration, std::vector<GuardMotion>& out) {
  out.resize(elements_.size());
  for (const Run& run : runs_) {
    at.component = run.component;
    const ForceKind& kind = *at.assembly.force_kinds()[run.kind];
    if (kind.has_guard_motion()) {
      kind.guard_motion(at, acceleration, run.elements, out.data() + run.first);
      continue;
    }
    kind.guards(at, run.elements, values_.data());
    for (std::size_t i = 0; i < run.count; ++i) out[run.first + i] = {values_[i], 0.0, 0.0, 0.0};
  }
}

}  // namespace carom
