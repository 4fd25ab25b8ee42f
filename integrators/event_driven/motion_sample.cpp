// Problem: memory of a sample, for the largest component as for all.

#include <carom/integrators/event_driven/motion_sample.h>

#include <limits>

namespace carom {

MotionSample::MotionSample(const Assembly& assembly)
    : state(assembly.layout()), evaluation(make_evaluation(assembly)) {
  acceleration.assign(state.v.size(), 0.0);
  for (const auto& elements : assembly.force_kinds()) {
    if (elements->books_dissipative()) dissipative.assign(state.v.size(), 0.0);
    if (elements->books_external()) external.assign(state.v.size(), 0.0);
  }
  if (!dissipative.empty() || !external.empty()) all_causes_.assign(state.v.size(), 0.0);
}

void MotionSample::note_places(std::size_t components) {
  evaluation.placed_at.assign(components, std::numeric_limits<double>::quiet_NaN());
}

}  // namespace carom
