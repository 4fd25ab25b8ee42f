// Problem: which components need no iteration, and which of them are taken together.

#include <carom/integrators/time_stepping/step_batches.h>

#include <algorithm>

namespace carom {

namespace {

/// True if loads at the start of a step are those at its end, and conservative.
bool stays_as_it_is(const ForceKind& kind) {
  return kind.is_constant() && !kind.depends_on_time() && !kind.books_external() && !kind.books_dissipative();
}

}  // namespace

StepBatches::StepBatches(const Assembly& assembly, const TimeStepping& options, bool load_rotations) {
  classify(assembly, options, load_rotations);
  find_batches(assembly);
}

void StepBatches::classify(const Assembly& assembly, const TimeStepping& options, bool load_rotations) {
  coupling_.assign(assembly.components().size(), CouplingClass::iterated);
  const bool mean = options.force_rule == ForceRule::energy_momentum;
  if (options.iteration == Iteration::linearly_implicit || mean || load_rotations) return;
  for (Index component = 0; component < assembly.components().size(); ++component) {
    if (assembly.has_joints(component) || !assembly.components()[component].z.empty()) continue;
    coupling_[component] = CouplingClass::constant_loads;
    for (Index kind = 0; kind < assembly.force_kinds().size(); ++kind) {
      if (assembly.elements(component, kind).empty() || stays_as_it_is(*assembly.force_kinds()[kind]))
        continue;
      coupling_[component] = CouplingClass::streamable;
    }
  }
}

/// Parts of a batch need fields that can be evaluated in parts.
void StepBatches::find_batches(const Assembly& assembly) {
  any_iterated_ = std::any_of(coupling_.begin(), coupling_.end(), [](CouplingClass coupling) {
    return coupling != CouplingClass::constant_loads;
  });
  const auto& kinds = assembly.force_kinds();
  const bool in_parts = std::all_of(kinds.begin(), kinds.end(), [](const auto& kind) {
    return !kind->is_field() || kind->works_in_parts();
  });
  for (const Range batch : assembly.batches()) {
    if (in_parts && coupling_[batch.begin] == CouplingClass::constant_loads) {
      batches_.push_back(batch);
      continue;
    }
    for (Index component = batch.begin; component < batch.end; ++component) {
      batches_.push_back({component, component + 1});
    }
  }
}

bool StepBatches::has_constant_loads(const StepIsland& island) const {
  return std::all_of(island.batches.begin(), island.batches.end(),
                     [this](Range batch) { return coupling(batch.begin) == CouplingClass::constant_loads; });
}

}  // namespace carom
