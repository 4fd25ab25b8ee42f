#include <carom/integrators/time_stepping/step_scope.h>

#include <algorithm>

namespace carom {

void StepScope::assign(const Assembly& assembly, std::span<const Range> batches,
                       std::span<const Index> chosen) {
  batches_.clear();
  has_.assign(assembly.layout()->bodies().size(), 0);
  components_ = static_cast<Index>(chosen.size());
  bodies_ = 0;
  auto batch = batches.begin();
  for (const Index component : chosen) {
    const bool goes_on = !batches_.empty() && batches_.back().end == component && component < batch->end;
    while (component >= batch->end) ++batch;
    if (!goes_on) batches_.push_back({component, component});
    batches_.back().end = component + 1;
    const Range bodies = assembly.components()[component].bodies;
    std::fill(has_.begin() + bodies.begin, has_.begin() + bodies.end, std::uint8_t{1});
    bodies_ += bodies.size();
  }
}

}  // namespace carom
