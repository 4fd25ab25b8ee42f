#include <carom/core/assembly.h>

#include <algorithm>
#include <array>

namespace carom {

Evaluation make_evaluation(const Assembly& assembly) {
  Evaluation evaluation;
  evaluation.rotation.assign(assembly.layout()->rotation_size(), 0.0);
  evaluation.force.assign(assembly.layout()->v_size(), 0.0);
  return evaluation;
}

void evaluate_positions(const Assembly& assembly, Index island, const StateView& state, Evaluation& out) {
  assembly.for_bodies(island, [&](const BodyKind& kind, Range slots, Index q, Index, Index rotation) {
    if (kind.has_orientation()) kind.rotations(slots, state.q + q, out.rotation.data() + rotation);
  });
}

namespace {

void zero(Range v, const Loads& loads) {
  const auto clear = [&](double* array) { std::fill(array + v.begin, array + v.end, 0.0); };
  clear(loads.conservative);
  if (loads.dissipative != loads.conservative) clear(loads.dissipative);
  if (loads.external != loads.conservative) clear(loads.external);
}

/// Calls f(kind, elements, index of the kind) for the kinds that act in an island.
template <class F>
void for_kinds(const Assembly& assembly, Index island, F&& f) {
  for (Index kind = 0; kind < assembly.force_kinds().size(); ++kind) {
    const Range elements = assembly.elements(island, kind);
    if (!elements.empty()) f(*assembly.force_kinds()[kind], elements, kind);
  }
}

/// Zeroes the loads of an island and calls f(kind, elements, bodies, part): for the elements within each
/// block, which write there alone, then for those between blocks, part by part.
template <class F>
void for_loads(const Assembly& assembly, Index island, const Loads& loads, const Workers& workers,
               BlockTask first, F&& f) {
  const Island& all = assembly.islands()[island];
  const auto kinds = static_cast<Index>(assembly.force_kinds().size());
  workers.for_each(all.blocks.size(), [&](Index part) {
    const Index index = all.blocks.begin + part;
    const Block& block = assembly.blocks()[index];
    if (first) first(block);
    zero(block.v, loads);
    for (Index kind = 0; kind < kinds; ++kind) {
      const Range elements = assembly.elements_within(index, kind);
      if (!elements.empty()) f(*assembly.force_kinds()[kind], elements, block.bodies, part);
    }
  });
  for (Index kind = 0; kind < kinds; ++kind) {
    const Range elements = assembly.bridges(island, kind);
    if (!elements.empty()) f(*assembly.force_kinds()[kind], elements, all.bodies, all.blocks.size());
  }
}

}  // namespace

void evaluate_loads(const Assembly& assembly, Index island, const StateView& state,
                    const Evaluation& evaluation, const Loads& loads, const Workers& workers,
                    BlockTask first) {
  for_loads(assembly, island, loads, workers, first,
            [&](const ForceKind& kind, Range elements, Range bodies, Index) {
              kind.evaluate({assembly, state, evaluation, island, bodies}, elements, loads);
            });
}

void evaluate_loads_and_potentials(const Assembly& assembly, Index island, const StateView& state,
                                   const Evaluation& evaluation, const Loads& loads, StoredEnergies& stored,
                                   const Workers& workers, BlockTask first) {
  if (assembly.islands()[island].blocks.size() == 1) {
    for_loads(assembly, island, loads, workers, first,
              [&](const ForceKind& kind, Range elements, Range bodies, Index) {
                const EvaluationContext at{assembly, state, evaluation, island, bodies};
                stored[kind.stored_as()] += kind.evaluate_with_potential(at, elements, loads);
              });
    return;
  }
  std::array<StoredEnergies, Assembly::most_blocks + 1> parts{};
  for_loads(assembly, island, loads, workers, first,
            [&](const ForceKind& kind, Range elements, Range bodies, Index part) {
              const EvaluationContext at{assembly, state, evaluation, island, bodies};
              parts[part][kind.stored_as()] += kind.evaluate_with_potential(at, elements, loads);
            });
  for (Index part = 0; part <= assembly.islands()[island].blocks.size(); ++part) {
    for (std::size_t i = 0; i < stored_energy_count; ++i) stored.values[i] += parts[part].values[i];
  }
}

void evaluate_mean_loads(const Assembly& assembly, Index island, const StepContext& step, const Loads& loads,
                         const Workers& workers) {
  for_loads(assembly, island, loads, workers, {},
            [&](const ForceKind& kind, Range elements, Range bodies, Index) {
              const auto within = [bodies](const EvaluationContext& at) {
                return EvaluationContext{at.assembly, at.state, at.evaluation, at.island, bodies};
              };
              const EvaluationContext start = within(step.start), end = within(step.end),
                                      middle = within(step.middle);
              kind.evaluate_mean({start, end, middle, step.step}, elements, loads);
            });
}

bool uses_middle(const Assembly& assembly, Index island) {
  bool uses = false;
  for_kinds(assembly, island,
            [&](const ForceKind& kind, Range, Index) { uses = uses || kind.uses_middle(); });
  return uses;
}

ElementId advance_internals(const Assembly& assembly, Index island, const StepContext& step, double* z) {
  ElementId failed;
  for_kinds(assembly, island, [&](const ForceKind& kind, Range elements, Index index) {
    if (failed.valid() || kind.internal_size() == 0) return;
    const Index stopped = kind.advance_internal(step, elements, z);
    if (stopped != elements.end) failed = assembly.element_id(index, stopped);
  });
  return failed;
}

double internal_loss(const Assembly& assembly, Index island, const StepContext& step) {
  double loss = 0.0;
  for_kinds(assembly, island, [&](const ForceKind& kind, Range elements, Index) {
    if (kind.internal_size() > 0) loss += kind.internal_loss(step, elements);
  });
  return loss;
}

void add_kinetic_energy(const Assembly& assembly, Index island, const StateView& state, StoredEnergies& out) {
  assembly.for_bodies(island, [&](const BodyKind& kind, Range slots, Index, Index v, Index) {
    out[StoredEnergy::kinetic] += kind.kinetic_energy(slots, state.v + v);
  });
}

void evaluate(const Assembly& assembly, Index island, const StateView& state, Evaluation& out) {
  evaluate_positions(assembly, island, state, out);
  double* const force = out.force.data();
  evaluate_loads(assembly, island, state, out, {force, force, force});
}

void add_stored_energies(const Assembly& assembly, Index island, const StateView& state,
                         const Evaluation& evaluation, StoredEnergies& out) {
  add_kinetic_energy(assembly, island, state, out);
  add_potentials(assembly, island, state, evaluation, out);
}

StoredEnergies stored_energies(const Assembly& assembly, const StateView& state, Evaluation& evaluation) {
  StoredEnergies stored;
  for (Index island = 0; island < assembly.islands().size(); ++island) {
    evaluate_positions(assembly, island, state, evaluation);
    add_stored_energies(assembly, island, state, evaluation, stored);
  }
  return stored;
}

void add_potentials(const Assembly& assembly, Index island, const StateView& state,
                    const Evaluation& evaluation, StoredEnergies& out) {
  const EvaluationContext at{assembly, state, evaluation, island};
  for_kinds(assembly, island, [&](const ForceKind& kind, Range elements, Index) {
    out[kind.stored_as()] += kind.potential(at, elements);
  });
}

}  // namespace carom
