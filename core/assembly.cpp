#include <carom/core/assembly.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace carom {

namespace {

/// Sets of bodies that are joined, by serial number.
class Unions {
public:
  explicit Unions(Index size) : parent_(size) { std::iota(parent_.begin(), parent_.end(), Index{0}); }

  Index find(Index i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  /// The smaller number becomes the representative, so that the order of joins does not matter.
  void join(Index a, Index b) {
    a = find(a);
    b = find(b);
    if (a != b) parent_[std::max(a, b)] = std::min(a, b);
  }

private:
  std::vector<Index> parent_;
};

}  // namespace

Assembly::Assembly(System system) : system_(std::move(system)) {
  if (system_.bodies().empty()) throw ModelError("system: number of bodies is 0; allowed: at least one body");
  const std::vector<Index> island_of_body = order_bodies();
  cut_islands();
  order_elements(island_of_body);
  place_internals();
  unfinished_layout_.reset();
}

std::vector<Index> Assembly::order_bodies() {
  const auto& registry = system_.body_kinds();
  Unions unions(registry.next_serial());
  std::vector<BodyId> ends;
  for (const auto& entry : system_.force_kinds().entries()) {
    for (Index element = 0; element < entry.serials.size(); ++element) {
      ends.clear();
      entry.kind->ends(element, ends);
      std::erase(ends, ground);
      for (std::size_t i = 1; i < ends.size(); ++i) unions.join(ends[0].serial, ends[i].serial);
    }
  }

  // Islands by their first body, then kinds, then order of insertion.
  struct Key {
    Index island, kind, serial, slot;
    auto operator<=>(const Key&) const = default;
  };
  std::vector<Key> keys;
  for (Index kind = 0; kind < registry.entries().size(); ++kind) {
    const auto& serials = registry.entries()[kind].serials;
    for (Index slot = 0; slot < serials.size(); ++slot) {
      keys.push_back({unions.find(serials[slot]), kind, serials[slot], slot});
    }
  }
  std::sort(keys.begin(), keys.end());

  const auto kinds = static_cast<Index>(registry.entries().size());
  std::vector<std::vector<Index>> order(kinds);
  std::vector<BodySlot> slots;
  slots.reserve(keys.size());
  std::vector<Index> island_of_body(registry.next_serial(), none);
  Index q = 0, v = 0, rotation = 0, root = none;
  for (const Key& key : keys) {
    const BodyKind& kind = *registry.entries()[key.kind].kind;
    const auto body = static_cast<Index>(slots.size());
    if (key.island != root) {
      root = key.island;
      islands_.push_back({{body, body}, {q, q}, {v, v}, {}, {}});
      for (Index k = 0; k < kinds; ++k) {
        const auto first = static_cast<Index>(order[k].size());
        body_slots_.push_back({first, first});
      }
    }
    BodySlot slot{key.serial,    q,    v,        kind.q_size(),
                  kind.v_size(), none, key.kind, static_cast<Index>(order[key.kind].size())};
    if (kind.has_orientation()) {
      slot.rotation = rotation;
      rotation += kind.dimension() == 2 ? 2U : 9U;
    }
    slots.push_back(slot);
    q += slot.q_size;
    v += slot.v_size;
    order[key.kind].push_back(key.slot);
    Island& island = islands_.back();
    island.bodies.end = body + 1;
    island.q.end = q;
    island.v.end = v;
    ++body_slots_[(islands_.size() - 1) * kinds + key.kind].end;
    island_of_body[key.serial] = static_cast<Index>(islands_.size() - 1);
  }
  for (Index k = 0; k < kinds; ++k) body_kinds_.push_back(registry.entries()[k].kind->arranged(order[k]));

  layout_ = unfinished_layout_ = std::make_shared<Layout>(system_.dimension(), system_.token(), slots);
  return island_of_body;
}

std::vector<double> Assembly::masses() const {
  std::vector<double> masses;
  masses.reserve(layout_->bodies().size());
  for (const BodySlot& slot : layout_->bodies()) masses.push_back(body_kinds_[slot.kind]->mass(slot.slot));
  return masses;
}

std::vector<double> Assembly::length_scales() const {
  std::vector<double> lengths;
  lengths.reserve(layout_->v_size());
  for (const BodySlot& slot : layout_->bodies()) {
    for (Index i = 0; i < slot.v_size; ++i) {
      lengths.push_back(body_kinds_[slot.kind]->length_scale(slot.slot, i));
    }
  }
  return lengths;
}

void Assembly::cut_islands() {
  for (Island& island : islands_) {
    const Index size = island.bodies.size();
    const Index count = std::clamp<Index>(size / block_size, 1, most_blocks);
    island.blocks.begin = static_cast<Index>(blocks_.size());
    const auto first = [&](Index i) {
      return island.bodies.begin + static_cast<Index>(std::uint64_t{size} * i / count);
    };
    const auto velocity = [&](Index body) {
      return body < island.bodies.end ? layout_->bodies()[body].v : island.v.end;
    };
    for (Index i = 0; i < count; ++i) {
      blocks_.push_back({{first(i), first(i + 1)}, {velocity(first(i)), velocity(first(i + 1))}});
    }
    island.blocks.end = static_cast<Index>(blocks_.size());
  }
}

/// The block, counted from the first of the island, in which all ends lie; the number of blocks if there is
/// none.
Index Assembly::part_of(Index island, const std::vector<BodyId>& ends) const {
  const Range blocks = islands_[island].blocks;
  if (blocks.size() == 1 || ends.empty()) return 0;
  Index part = none;
  for (const BodyId end : ends) {
    const Index body = layout_->index(end);
    Index of_end = 0;
    while (body >= blocks_[blocks.begin + of_end].bodies.end) ++of_end;
    if (part != none && part != of_end) return blocks.size();
    part = of_end;
  }
  return part;
}

void Assembly::order_elements(const std::vector<Index>& island_of_body) {
  const auto& entries = system_.force_kinds().entries();
  const auto kinds = static_cast<Index>(entries.size());
  element_slots_.assign(islands_.size() * kinds, {});
  bridges_.assign(islands_.size() * kinds, {});
  block_elements_.assign(blocks_.size() * kinds, {});
  std::vector<BodyId> ends;
  for (Index k = 0; k < kinds; ++k) {
    const ForceKind& kind = *entries[k].kind;
    struct Key {
      Index island, part, slot;  // part: a block of the island, or behind them all a bridge
      auto operator<=>(const Key&) const = default;
    };
    std::vector<Key> keys;
    keys.reserve(kind.size());
    for (Index slot = 0; slot < kind.size(); ++slot) {
      ends.clear();
      kind.ends(slot, ends);
      std::erase(ends, ground);
      const Index island = ends.empty() ? 0 : island_of_body[ends[0].serial];
      keys.push_back({island, part_of(island, ends), slot});
    }
    std::sort(keys.begin(), keys.end());
    std::vector<Index> order;
    order.reserve(keys.size());
    for (const Key& key : keys) {
      const Range blocks = islands_[key.island].blocks;
      Range& part = key.part < blocks.size() ? block_elements_[(blocks.begin + key.part) * kinds + k]
                                             : bridges_[key.island * kinds + k];
      for (Range* const range : {&element_slots_[key.island * kinds + k], &part}) {
        if (range->empty()) range->begin = range->end = static_cast<Index>(order.size());
        ++range->end;
      }
      order.push_back(key.slot);
    }
    if (kind.is_field()) {
      const Range all{0, kind.size()};
      for (Index island = 0; island < islands_.size(); ++island) {
        element_slots_[island * kinds + k] = all;
        bridges_[island * kinds + k] = kind.works_in_parts() ? Range{} : all;
      }
      for (Index block = 0; block < blocks_.size(); ++block) {
        block_elements_[block * kinds + k] = kind.works_in_parts() ? all : Range{};
      }
    }
    force_kinds_.push_back(kind.arranged(order, *layout_));
    if (std::is_sorted(order.begin(), order.end())) order = {};
    element_order_.push_back(std::move(order));
  }
}

void Assembly::place_internals() {
  Index z = 0;
  std::vector<InternalSlot> internals;
  std::vector<std::vector<Index>> first(force_kinds_.size());
  for (Index island = 0; island < islands_.size(); ++island) {
    islands_[island].z.begin = z;
    for (Index kind = 0; kind < force_kinds_.size(); ++kind) {
      const Index size = force_kinds_[kind]->internal_size();
      if (size == 0) continue;
      const Range range = elements(island, kind);
      for (Index element = range.begin; element < range.end; ++element, z += size) {
        internals.push_back({element_id(kind, element).serial, z, size});
        first[kind].push_back(z);
      }
    }
    islands_[island].z.end = z;
  }
  if (internals.empty()) return;
  for (Index kind = 0; kind < force_kinds_.size(); ++kind) {
    if (!first[kind].empty()) force_kinds_[kind]->place_internal(first[kind]);
  }
  unfinished_layout_->place_internals(std::move(internals));
}

State Assembly::initial_state() const {
  State state(layout_);
  for (const BodySlot& slot : layout_->bodies()) {
    const auto place = system_.body_kinds().place(slot.serial);
    system_.body_kinds().entries()[place.entry].kind->initial(place.slot, state.q.data() + slot.q,
                                                              state.v.data() + slot.v);
  }
  Index z = 0;
  for (Index island = 0; island < islands_.size(); ++island) {
    for (Index kind = 0; kind < force_kinds_.size(); ++kind) {
      const Index size = force_kinds_[kind]->internal_size();
      if (size == 0) continue;
      const Range range = elements(island, kind);
      for (Index element = range.begin; element < range.end; ++element, z += size) {
        force_kinds_[kind]->initial_internal(element, state.z.data() + z);
      }
    }
  }
  return state;
}

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
void for_loads(const Assembly& assembly, Index island, const Loads& loads, const Workers& workers, F&& f) {
  const Island& all = assembly.islands()[island];
  const auto kinds = static_cast<Index>(assembly.force_kinds().size());
  workers.for_each(all.blocks.size(), [&](Index part) {
    const Index index = all.blocks.begin + part;
    const Block& block = assembly.blocks()[index];
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
                    const Evaluation& evaluation, const Loads& loads, const Workers& workers) {
  for_loads(assembly, island, loads, workers,
            [&](const ForceKind& kind, Range elements, Range bodies, Index) {
              kind.evaluate({assembly, state, evaluation, island, bodies}, elements, loads);
            });
}

void evaluate_loads_and_potentials(const Assembly& assembly, Index island, const StateView& state,
                                   const Evaluation& evaluation, const Loads& loads, StoredEnergies& stored,
                                   const Workers& workers) {
  std::array<StoredEnergies, Assembly::most_blocks + 1> parts{};
  for_loads(assembly, island, loads, workers,
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
  for_loads(assembly, island, loads, workers,
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

void add_potentials(const Assembly& assembly, Index island, const StateView& state,
                    const Evaluation& evaluation, StoredEnergies& out) {
  const EvaluationContext at{assembly, state, evaluation, island};
  for_kinds(assembly, island, [&](const ForceKind& kind, Range elements, Index) {
    out[kind.stored_as()] += kind.potential(at, elements);
  });
}

void check_state(const Assembly& assembly, const State& state) {
  const Layout& layout = *assembly.layout();
  const PartCheck check("state", assembly.system());
  check.finite(state.time, "time", "s");
  if (state.q.size() != layout.q_size() || state.v.size() != layout.v_size() ||
      state.z.size() != layout.z_size()) {
    const auto sizes = [](auto q, auto v, auto z) {
      return std::to_string(q) + " + " + std::to_string(v) + " + " + std::to_string(z);
    };
    check.refuse("number of coordinates, velocities and internal variables",
                 sizes(state.q.size(), state.v.size(), state.z.size()),
                 sizes(layout.q_size(), layout.v_size(), layout.z_size()));
  }
  for (const InternalSlot& slot : layout.internals()) {
    const PartCheck element_check(
        "state of " + assembly.system().name(ElementId{slot.serial, assembly.system().token()}),
        assembly.system());
    element_check.finite({state.z.data() + slot.first, slot.size}, "internal variable", "");
  }
  for (Index body = 0; body < layout.bodies().size(); ++body) {
    const BodySlot& slot = layout.bodies()[body];
    const auto all_finite = [](const double* numbers, Index count) {
      return std::all_of(numbers, numbers + count, [](double x) { return std::isfinite(x); });
    };
    if (all_finite(state.q.data() + slot.q, slot.q_size) && all_finite(state.v.data() + slot.v, slot.v_size))
      continue;
    const PartCheck body_check("state of " + assembly.system().name(layout.id(body)), assembly.system());
    body_check.finite({state.q.data() + slot.q, slot.q_size}, "coordinate", "");
    body_check.finite({state.v.data() + slot.v, slot.v_size}, "velocity", "");
  }
}

}  // namespace carom
