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
    if (!list_) {
      list_ = std::make_unique<List>();
      list_->assembly = &assembly;
    }
    list_->runs.push_back({component, kind, acting, list_->elements.size(), count});
    for (Index element = acting.begin; element < acting.end; ++element) {
      list_->elements.insert(list_->elements.end(), each, assembly.element_id(kind, element));
    }
    list_->has_motion.insert(list_->has_motion.end(), count, static_cast<char>(elements.has_guard_motion()));
    if (!elements.has_guard_motion()) {
      list_->all_have_motion = false;
      list_->values.resize(std::max(list_->values.size(), count));
    }
  }
}

void GroupGuards::read(const StateView& state, const Evaluation& evaluation, const double* acceleration,
                       std::vector<GuardMotion>& out) {
  out.resize(count());
  if (!list_) return;
  const Assembly& assembly = *list_->assembly;
  for (const Run& run : list_->runs) {
    const EvaluationContext at{assembly, state, evaluation, run.component};
    const ForceKind& kind = *assembly.force_kinds()[run.kind];
    if (kind.has_guard_motion()) {
      kind.guard_motion(at, acceleration, run.elements, out.data() + run.first);
      continue;
    }
    kind.guards(at, run.elements, list_->values.data());
    for (std::size_t i = 0; i < run.count; ++i) out[run.first + i] = {list_->values[i], 0.0, 0.0, 0.0};
  }
}

}  // namespace carom
