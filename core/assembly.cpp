#include <carom/core/assembly.h>

#include <algorithm>
#include <cmath>
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
  const std::vector<Index> component_of_body = order_bodies();
  cut_components();
  order_joints(component_of_body);
  order_elements(component_of_body);
  close_blocks();
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

  for (const auto& entry : system_.joint_kinds().entries()) {
    for (Index joint = 0; joint < entry.serials.size(); ++joint) {
      ends.clear();
      entry.kind->ends(joint, ends);
      std::erase(ends, ground);
      for (std::size_t i = 1; i < ends.size(); ++i) unions.join(ends[0].serial, ends[i].serial);
    }
  }

  // Components by their first body, then kinds, then order of insertion.
  struct Key {
    Index component, kind, serial, slot;
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
  std::vector<Index> component_of_body(registry.next_serial(), none);
  Index q = 0, v = 0, rotation = 0, root = none;
  for (const Key& key : keys) {
    const BodyKind& kind = *registry.entries()[key.kind].kind;
    const auto body = static_cast<Index>(slots.size());
    if (key.component != root) {
      root = key.component;
      components_.push_back({{body, body}, {q, q}, {v, v}, {}, {}, {}});
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
    Component& component = components_.back();
    component.bodies.end = body + 1;
    component.q.end = q;
    component.v.end = v;
    ++body_slots_[(components_.size() - 1) * kinds + key.kind].end;
    component_of_body[key.serial] = static_cast<Index>(components_.size() - 1);
  }
  for (Index k = 0; k < kinds; ++k) body_kinds_.push_back(registry.entries()[k].kind->arranged(order[k]));

  layout_ = unfinished_layout_ = std::make_shared<Layout>(system_.dimension(), system_.token(), slots);
  return component_of_body;
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

void Assembly::order_joints(const std::vector<Index>& component_of_body) {
  joints_ = std::make_shared<JointTable>();
  const auto& entries = system_.joint_kinds().entries();
  const auto kinds = static_cast<Index>(entries.size());
  joint_slots_.assign(components_.size() * kinds, {});
  joint_serials_.resize(kinds);
  if (system_.joints().empty() && kinds == 0) return;
  const auto bodies = static_cast<Index>(layout_->bodies().size());
  Unions unions(bodies);
  bound_.assign(bodies, 0);
  joints_->places.assign(system_.joint_kinds().next_serial(), {});
  unfinished_layout_->place_joints(joints_);
  std::vector<BodyId> ends;
  for (Index k = 0; k < kinds; ++k) {
    const JointKind& kind = *entries[k].kind;
    struct Key {
      Index component, slot;
      auto operator<=>(const Key&) const = default;
    };
    std::vector<Key> keys;
    keys.reserve(kind.size());
    for (Index slot = 0; slot < kind.size(); ++slot) {
      ends.clear();
      kind.ends(slot, ends);
      std::erase(ends, ground);
      keys.push_back({component_of_body[ends[0].serial], slot});
      const Index first = layout_->index(ends[0]);
      for (const BodyId end : ends) {
        unions.join(first, layout_->index(end));
        bound_[layout_->index(end)] = 1;
      }
    }
    std::sort(keys.begin(), keys.end());
    std::vector<Index> order;
    order.reserve(keys.size());
    for (const Key& key : keys) {
      const auto place = static_cast<Index>(order.size());
      Range& range = joint_slots_[key.component * kinds + k];
      if (range.empty()) range.begin = range.end = place;
      ++range.end;
      order.push_back(key.slot);
      const Index serial = entries[k].serials[key.slot];
      joint_serials_[k].push_back(serial);
      joints_->places[serial] = {k, place};
    }
    joints_->kinds.push_back(kind.arranged(order, *layout_));
  }
  groups_.resize(bodies);
  for (Index body = 0; body < bodies; ++body) groups_[body] = unions.find(body);
}

bool Assembly::has_joints(Index component) const {
  for (Index kind = 0; kind < joints_->kinds.size(); ++kind) {
    if (!joints(component, kind).empty()) return true;
  }
  return false;
}

JointId Assembly::joint_id(Index kind, Index slot) const {
  return {joint_serials_[kind][slot], system_.token()};
}

void Assembly::order_elements(const std::vector<Index>& component_of_body) {
  const auto& entries = system_.force_kinds().entries();
  const auto kinds = static_cast<Index>(entries.size());
  element_slots_.assign(components_.size() * kinds, {});
  bridges_.assign(components_.size() * kinds, {});
  block_elements_.assign(blocks_.size() * kinds, {});
  std::vector<BodyId> ends;
  for (Index k = 0; k < kinds; ++k) {
    const ForceKind& kind = *entries[k].kind;
    struct Key {
      Index component, part, slot;  // part: as part_of() has it
      auto operator<=>(const Key&) const = default;
    };
    std::vector<Key> keys;
    keys.reserve(kind.size());
    for (Index slot = 0; slot < kind.size(); ++slot) {
      ends.clear();
      kind.ends(slot, ends);
      std::erase(ends, ground);
      const Index component = ends.empty() ? 0 : component_of_body[ends[0].serial];
      keys.push_back({component, part_of(component, ends), slot});
    }
    std::sort(keys.begin(), keys.end());
    std::vector<Index> order;
    order.reserve(keys.size());
    for (const Key& key : keys) {
      const Range blocks = components_[key.component].blocks;
      Range& part = key.part < blocks.size() ? block_elements_[(blocks.begin + key.part) * kinds + k]
                                             : bridges_[key.component * kinds + k];
      for (Range* const range : {&element_slots_[key.component * kinds + k], &part}) {
        if (range->empty()) range->begin = range->end = static_cast<Index>(order.size());
        ++range->end;
      }
      order.push_back(key.slot);
    }
    if (kind.is_field()) {
      const Range all{0, kind.size()};
      for (Index component = 0; component < components_.size(); ++component) {
        element_slots_[component * kinds + k] = all;
        bridges_[component * kinds + k] = kind.works_in_parts() ? Range{} : all;
      }
      for (Index block = 0; block < blocks_.size(); ++block) {
        block_elements_[block * kinds + k] = kind.works_in_parts() ? all : Range{};
        blocks_[block].loaded_across_runs = blocks_[block].loaded_across_runs || !kind.works_in_parts();
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
  for (Index component = 0; component < components_.size(); ++component) {
    components_[component].z.begin = z;
    for (Index kind = 0; kind < force_kinds_.size(); ++kind) {
      const Index size = force_kinds_[kind]->internal_size();
      if (size == 0) continue;
      const Range range = elements(component, kind);
      for (Index element = range.begin; element < range.end; ++element, z += size) {
        internals.push_back({element_id(kind, element).serial, z, size});
        first[kind].push_back(z);
      }
    }
    components_[component].z.end = z;
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
  for (Index component = 0; component < components_.size(); ++component) {
    for (Index kind = 0; kind < force_kinds_.size(); ++kind) {
      const Index size = force_kinds_[kind]->internal_size();
      if (size == 0) continue;
      const Range range = elements(component, kind);
      for (Index element = range.begin; element < range.end; ++element, z += size) {
        force_kinds_[kind]->initial_internal(element, state.z.data() + z);
      }
    }
  }
  return state;
}

void check_sizes(const Assembly& assembly, const State& state) {
  const Layout& layout = *assembly.layout();
  const PartCheck check("state", assembly.system());
  if (state.q.size() != layout.q_size() || state.v.size() != layout.v_size() ||
      state.z.size() != layout.z_size()) {
    const auto sizes = [](auto q, auto v, auto z) {
      return std::to_string(q) + " + " + std::to_string(v) + " + " + std::to_string(z);
    };
    check.refuse("number of coordinates, velocities and internal variables",
                 sizes(state.q.size(), state.v.size(), state.z.size()),
                 sizes(layout.q_size(), layout.v_size(), layout.z_size()));
  }
  if (state.layout() != nullptr && state.layout()->token() == layout.token()) return;
  check.refuse("model", state.layout() == nullptr ? "none" : "another one", "a state of this model");
}

void check_state(const Assembly& assembly, const State& state) {
  const Layout& layout = *assembly.layout();
  const PartCheck check("state", assembly.system());
  check_sizes(assembly, state);
  check.finite(state.time, "time", "s");
  for (const InternalSlot& slot : layout.internals()) {
    const PartCheck element_check(
        "state of " + assembly.system().name(ElementId{slot.serial, assembly.system().token()}),
        assembly.system());
    element_check.finite({state.z.data() + slot.first, slot.size}, "internal variable", "");
  }
  for (Index body = 0; body < layout.bodies().size(); ++body) {
    const BodySlot& slot = layout.bodies()[body];
    const auto all_finite = [](const double* numbers, Index count) {
      return std::all_of(numbers, numbers + count, is_admissible);
    };
    if (all_finite(state.q.data() + slot.q, slot.q_size) && all_finite(state.v.data() + slot.v, slot.v_size))
      continue;
    const PartCheck body_check("state of " + assembly.system().name(layout.id(body)), assembly.system());
    body_check.finite({state.q.data() + slot.q, slot.q_size}, "coordinate", "");
    body_check.finite({state.v.data() + slot.v, slot.v_size}, "velocity", "");
  }
}

}  // namespace carom
