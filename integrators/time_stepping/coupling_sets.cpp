// Problem: which bodies may act on each other in a step, and which surely do not?

#include <carom/integrators/time_stepping/coupling_sets.h>

namespace carom {

CouplingSets::CouplingSets(const Assembly& assembly, const Detector& detector)
    : assembly_(&assembly), detector_(&detector) {
  std::vector<Index> owners;
  for (const BodyOutline& outline : detector.outlines().of_bodies().list()) owners.push_back(outline.body);
  broad_.reset(owners);
}

void CouplingSets::begin() { sets_.start(static_cast<Index>(assembly_->components().size())); }

void CouplingSets::join(std::span<const StepIsland> islands) {
  for (const StepIsland& island : islands) {
    for (std::size_t i = 1; island.joined && i < island.components.size(); ++i)
      sets_.join(island.components[0], island.components[i]);
  }
}

bool CouplingSets::join(std::span<const Box<2>> boxes) {
  const Outlines& outlines = detector_->outlines();
  if (!outlines.bodies_touch()) return false;
  const std::vector<BodyOutline>& list = outlines.of_bodies().list();
  bool any = false;
  for (const BoxPair& near : broad_.update(boxes)) {
    const BodyOutline &a = list[near.first], &b = list[near.second];
    if (!outlines.laws().may_touch(a, b)) continue;
    const Index of_a = assembly_->component_of(a.body), of_b = assembly_->component_of(b.body);
    if (set_of(of_a) == set_of(of_b)) continue;
    sets_.join(of_a, of_b);
    any = true;
  }
  return any;
}

}  // namespace carom
