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

namespace {

void evaluate_rotations(const Assembly& assembly, Range bodies, const StateView& state, Evaluation& out) {
  assembly.for_bodies(bodies, [&](const BodyKind& kind, Range slots, Index q, Index, Index rotation) {
    if (kind.has_orientation()) kind.rotations(slots, state.q + q, out.rotation.data() + rotation);
  });
}

}  // namespace

void evaluate_positions(const Assembly& assembly, Index component, const StateView& state, Evaluation& out) {
  evaluate_rotations(assembly, assembly.components()[component].bodies, state, out);
  if (!out.placed_at.empty()) out.placed_at[component] = state.time;
}

void evaluate_positions(const Assembly& assembly, const StateView& state, Evaluation& out) {
  evaluate_rotations(assembly, {0, static_cast<Index>(assembly.layout()->bodies().size())}, state, out);
}

namespace {

void zero(Range v, const Loads& loads) {
  const auto clear = [&](double* array) { std::fill(array + v.begin, array + v.end, 0.0); };
  clear(loads.conservative);
  if (loads.dissipative != loads.conservative) clear(loads.dissipative);
  if (loads.external != loads.conservative) clear(loads.external);
}

/// Calls f(kind, elements, index of the kind) for the kinds that act in a component.
template <class F>
void for_kinds(const Assembly& assembly, Index component, F&& f) {
  for (Index kind = 0; kind < assembly.force_kinds().size(); ++kind) {
    const Range elements = assembly.elements(component, kind);
    if (!elements.empty()) f(*assembly.force_kinds()[kind], elements, kind);
  }
}

/// A way through the blocks of a component, on which f(kind, elements, bodies, run) adds loads; the run is
/// counted from the first of the component, the bridges come as one more.
template <class F>
struct Pass {
  const Assembly& assembly;
  const Component& all;
  const Loads& loads;
  const BlockTasks& tasks;
  const F& f;

  void open(Index index) const {
    const Block& block = assembly.blocks()[index];
    if (tasks.first) tasks.first(block, index - all.blocks.begin);
    zero(block.v, loads);
  }
  void load(Index index) const {
    const Block& block = assembly.blocks()[index];
    for (Index kind = 0; kind < assembly.force_kinds().size(); ++kind) {
      const Range elements = assembly.blocks().elements_up_to(index, kind);
      if (!elements.empty()) {
        f(*assembly.force_kinds()[kind], elements, block.bodies, block.run - all.runs.begin);
      }
    }
  }
  void bridge() const {
    const auto component = static_cast<Index>(&all - assembly.components().data());
    for (Index kind = 0; kind < assembly.force_kinds().size(); ++kind) {
      const Range elements = assembly.blocks().bridges(component, kind);
      if (!elements.empty()) f(*assembly.force_kinds()[kind], elements, all.bodies, all.runs.size());
    }
  }
  void close(Index index) const {
    if (tasks.last) tasks.last(assembly.blocks()[index], index - all.blocks.begin);
  }
  /// Calls f(index) for the blocks on which bridges act.
  template <class G>
  void for_bridged(const Workers& workers, G&& g) const {
    workers.for_each(all.blocks.size(), [&](Index part) {
      const Index index = all.blocks.begin + part;
      if (assembly.blocks()[index].loaded_across_runs) g(index);
    });
  }
};

template <class F>
Pass(const Assembly&, const Component&, const Loads&, const BlockTasks&, const F&) -> Pass<F>;

/// Run by run, bridges last.
template <class F>
void go(const Pass<F>& pass, const Workers& workers) {
  const BlockTable& blocks = pass.assembly.blocks();
  workers.for_each(pass.all.runs.size(), [&](Index i) {
    const Range run = pass.assembly.blocks().runs()[pass.all.runs.begin + i];
    Index to_close = run.begin;
    for (Index index = run.begin; index < run.end; ++index) {
      pass.open(index);
      pass.load(index);
      for (; to_close <= index && blocks[to_close].last_loading_block <= index; ++to_close) {
        if (!blocks[to_close].loaded_across_runs) pass.close(to_close);
      }
    }
  });
  pass.bridge();
  pass.for_bridged(workers, [&](Index index) { pass.close(index); });
}

/// The same twice, the second following the first as closely as it can: a block of the first is closed when
/// its neighbours have been loaded, so that nobody looks at what the second makes of it. The first takes the
/// bridges before all else, so that it can close every block within its run.
template <class First, class Second>
void go_twice(const Pass<First>& first, const Pass<Second>& second, const Workers& workers) {
  const BlockTable& blocks = first.assembly.blocks();
  first.for_bridged(workers, [&](Index index) { first.open(index); });
  first.bridge();
  workers.for_each(first.all.runs.size(), [&](Index i) {
    const Range run = first.assembly.blocks().runs()[first.all.runs.begin + i];
    Index to_follow = run.begin, to_close = run.begin;
    for (Index index = run.begin; index < run.end; ++index) {
      if (!blocks[index].loaded_across_runs) first.open(index);
      first.load(index);
      for (; to_follow <= index && blocks[to_follow].last_loading_block <= index; ++to_follow) {
        first.close(to_follow);
        second.open(to_follow);
        second.load(to_follow);
        for (; to_close <= to_follow && blocks[to_close].last_loading_block <= to_follow; ++to_close) {
          if (!blocks[to_close].loaded_across_runs) second.close(to_close);
        }
      }
    }
  });
  second.bridge();
  second.for_bridged(workers, [&](Index index) { second.close(index); });
}

}  // namespace

void evaluate_loads(const Assembly& assembly, Index component, const StateView& state,
                    const Evaluation& evaluation, const Loads& loads, const Workers& workers,
                    const BlockTasks& tasks) {
  const auto add = [&](const ForceKind& kind, Range elements, Range bodies, Index) {
    kind.evaluate({assembly, state, evaluation, component, bodies}, elements, loads);
  };
  go(Pass{assembly, assembly.components()[component], loads, tasks, add}, workers);
}

void evaluate_loads_within(const Assembly& assembly, Index component, const Surroundings& blocks,
                           const StateView& state, const Evaluation& evaluation, const Loads& loads) {
  const auto add = [&](const ForceKind& kind, Range elements, Range bodies, Index) {
    kind.evaluate({assembly, state, evaluation, component, bodies}, elements, loads);
  };
  const BlockTasks nothing;
  const Pass pass{assembly, assembly.components()[component], loads, nothing, add};
  for (const Index block : blocks.touched) pass.open(block);
  for (const Index block : blocks.loading) pass.load(block);
}

namespace {

/// Potentials by run, each of which one thread goes through, and, last, of the bridges.
using Parts = std::array<StoredEnergies, BlockTable::most_runs + 1>;

void add_parts(const Parts& parts, Index runs, StoredEnergies& stored) {
  for (Index part = 0; part <= runs; ++part) {
    for (std::size_t i = 0; i < stored_energy_count; ++i) stored.values[i] += parts[part].values[i];
  }
}

}  // namespace

void evaluate_loads_and_potentials(const Assembly& assembly, Index component, const StateView& state,
                                   const Evaluation& evaluation, const Loads& loads, StoredEnergies& stored,
                                   const Workers& workers, const BlockTasks& tasks) {
  const Component& all = assembly.components()[component];
  const auto add_to = [&](const ForceKind& kind, Range elements, Range bodies, StoredEnergies& sum) {
    const EvaluationContext at{assembly, state, evaluation, component, bodies};
    sum[kind.stored_as()] += kind.evaluate_with_potential(at, elements, loads);
  };
  if (all.blocks.size() == 1) {
    const auto add = [&](const ForceKind& kind, Range elements, Range bodies, Index) {
      add_to(kind, elements, bodies, stored);
    };
    go(Pass{assembly, all, loads, tasks, add}, workers);
    return;
  }
  Parts parts{};
  const auto add = [&](const ForceKind& kind, Range elements, Range bodies, Index run) {
    add_to(kind, elements, bodies, parts[run]);
  };
  go(Pass{assembly, all, loads, tasks, add}, workers);
  add_parts(parts, all.runs.size(), stored);
}

void evaluate_loads_twice(const Assembly& assembly, Index component, const StateView& state,
                          const Evaluation& evaluation, const Loads& first, const BlockTasks& first_tasks,
                          const Loads& second, const BlockTasks& second_tasks, StoredEnergies& stored,
                          const Workers& workers) {
  const Component& all = assembly.components()[component];
  Parts parts{};
  const auto add_first = [&](const ForceKind& kind, Range elements, Range bodies, Index) {
    kind.evaluate({assembly, state, evaluation, component, bodies}, elements, first);
  };
  const auto add_second = [&](const ForceKind& kind, Range elements, Range bodies, Index run) {
    const EvaluationContext at{assembly, state, evaluation, component, bodies};
    parts[run][kind.stored_as()] += kind.evaluate_with_potential(at, elements, second);
  };
  go_twice(Pass{assembly, all, first, first_tasks, add_first},
           Pass{assembly, all, second, second_tasks, add_second}, workers);
  add_parts(parts, all.runs.size(), stored);
}

void evaluate_mean_loads(const Assembly& assembly, Index component, const StepContext& step,
                         const Loads& loads, const Workers& workers, const BlockTasks& tasks) {
  const auto add = [&](const ForceKind& kind, Range elements, Range bodies, Index) {
    const auto within = [bodies](const EvaluationContext& at) {
      return EvaluationContext{at.assembly, at.state, at.evaluation, at.component, bodies};
    };
    const EvaluationContext start = within(step.start), end = within(step.end), middle = within(step.middle);
    kind.evaluate_mean({start, end, middle, step.step}, elements, loads);
  };
  go(Pass{assembly, assembly.components()[component], loads, tasks, add}, workers);
}

bool uses_middle(const Assembly& assembly, Index component) {
  bool uses = false;
  for_kinds(assembly, component,
            [&](const ForceKind& kind, Range, Index) { uses = uses || kind.uses_middle(); });
  return uses;
}

ElementId advance_internals(const Assembly& assembly, Index component, const StepContext& step, double* z) {
  ElementId failed;
  for_kinds(assembly, component, [&](const ForceKind& kind, Range elements, Index index) {
    if (failed.valid() || kind.internal_size() == 0) return;
    const Index stopped = kind.advance_internal(step, elements, z);
    if (stopped != elements.end) failed = assembly.element_id(index, stopped);
  });
  return failed;
}

double internal_loss(const Assembly& assembly, Index component, const StepContext& step) {
  double loss = 0.0;
  for_kinds(assembly, component, [&](const ForceKind& kind, Range elements, Index) {
    if (kind.internal_size() > 0) loss += kind.internal_loss(step, elements);
  });
  return loss;
}

void evaluate(const Assembly& assembly, Index component, const StateView& state, Evaluation& out) {
  evaluate_positions(assembly, component, state, out);
  double* const force = out.force.data();
  evaluate_loads(assembly, component, state, out, {force, force, force});
}

double kinetic_energy(const Assembly& assembly, Range bodies, const double* velocities) {
  double sum = 0.0;
  assembly.for_bodies(bodies, [&](const BodyKind& kind, Range slots, Index, Index v, Index) {
    sum += kind.kinetic_energy(slots, velocities + v);
  });
  return sum;
}

void add_stored_energies(const Assembly& assembly, Index component, const StateView& state,
                         const Evaluation& evaluation, StoredEnergies& out) {
  assembly.for_bodies(component, [&](const BodyKind& kind, Range slots, Index, Index v, Index) {
    out[StoredEnergy::kinetic] += kind.kinetic_energy(slots, state.v + v);
  });
  add_potentials(assembly, component, state, evaluation, out);
}

StoredEnergies stored_energies(const Assembly& assembly, const StateView& state, Evaluation& evaluation) {
  StoredEnergies stored;
  for (Index component = 0; component < assembly.components().size(); ++component) {
    evaluate_positions(assembly, component, state, evaluation);
    add_stored_energies(assembly, component, state, evaluation, stored);
  }
  return stored;
}

void add_field_potentials(const Assembly& assembly, Range bodies, const StateView& state,
                          const Evaluation& evaluation, StoredEnergies& out) {
  const Index component = assembly.component_of(bodies.begin);
  const EvaluationContext at{assembly, state, evaluation, component, bodies};
  for_kinds(assembly, component, [&](const ForceKind& kind, Range elements, Index) {
    if (kind.is_field()) out[kind.stored_as()] += kind.potential(at, elements);
  });
}

void add_potentials(const Assembly& assembly, Index component, const StateView& state,
                    const Evaluation& evaluation, StoredEnergies& out) {
  const EvaluationContext at{assembly, state, evaluation, component};
  for_kinds(assembly, component, [&](const ForceKind& kind, Range elements, Index) {
    out[kind.stored_as()] += kind.potential(at, elements);
  });
}

}  // namespace carom
