#include <carom/core/assembly.h>
#include <carom/core/numerics/union_find.h>

#include <algorithm>

namespace carom {

namespace {

/// Place of a body in the order of assembly: components by their first body, then kinds, then order of
/// insertion.
struct BodyKey {
  Index component, kind, serial, slot;
  auto operator<=>(const BodyKey&) const = default;
};

/// Joins the bodies of each element or joint.
template <class Kinds>
void join_ends(const Kinds& kinds, UnionFind& bodies) {
  std::vector<BodyId> ends;
  for (const auto& entry : kinds.entries()) {
    for (Index part = 0; part < entry.serials.size(); ++part) {
      ends.clear();
      entry.kind->ends(part, ends);
      std::erase(ends, ground);
      for (std::size_t i = 1; i < ends.size(); ++i) bodies.join(ends[0].serial, ends[i].serial);
    }
  }
}

std::vector<BodyKey> ordered_bodies(const System& system) {
  const auto& registry = system.body_kinds();
  UnionFind connected;
  connected.start(registry.next_serial());
  join_ends(system.force_kinds(), connected);
  join_ends(system.joint_kinds(), connected);
  std::vector<BodyKey> keys;
  for (Index kind = 0; kind < registry.entries().size(); ++kind) {
    const auto& serials = registry.entries()[kind].serials;
    for (Index slot = 0; slot < serials.size(); ++slot) {
      keys.push_back({connected.find(serials[slot]), kind, serials[slot], slot});
    }
  }
  std::sort(keys.begin(), keys.end());
  return keys;
}

/// True if a component has one body only, on which nothing but fields acts.
bool is_uncoupled(const Assembly& assembly, Index component) {
  const Range bodies = assembly.components()[component].bodies;
  if (bodies.size() > 1 || assembly.is_jointed(bodies.begin)) return false;
  for (Index kind = 0; kind < assembly.force_kinds().size(); ++kind) {
    if (!assembly.force_kinds()[kind]->is_field() && !assembly.elements(component, kind).empty())
      return false;
  }
  return true;
}

}  // namespace

Assembly::Assembly(System system) : system_(std::move(system)) {
  if (system_.bodies().empty()) throw ModelError("system: number of bodies is 0; allowed: at least one body");
  std::vector<Index> component_of_body(system_.body_kinds().next_serial(), none);
  const std::shared_ptr<Layout> layout = order_bodies(component_of_body);
  blocks_ =
      BlockTable(components_, layout->bodies(), static_cast<Index>(system_.force_kinds().entries().size()));
  joints_ = ArrangedJoints(system_, *layout, components_, component_of_body);
  elements_ = ArrangedElements(system_, *layout, components_, component_of_body, blocks_);
  std::vector<InternalSlot> internals = elements_.place_internals(system_, components_);
  if (!internals.empty()) layout->place_internals(std::move(internals));
  layout_ = layout;
  find_batches();
}

std::shared_ptr<Layout> Assembly::order_bodies(std::vector<Index>& component_of_body) {
  const std::vector<BodyKey> keys = ordered_bodies(system_);
  const auto& registry = system_.body_kinds();
  const auto kinds = static_cast<Index>(registry.entries().size());
  std::vector<std::vector<Index>> order(kinds);
  std::vector<BodySlot> slots;
  slots.reserve(keys.size());
  Index q = 0, v = 0, rotation = 0, root = none;
  for (const BodyKey& key : keys) {
    const BodyKind& kind = *registry.entries()[key.kind].kind;
    const auto body = static_cast<Index>(slots.size());
    if (key.component != root) {
      root = key.component;
      components_.push_back({{body, body}, {q, q}, {v, v}, {}, {}, {}});
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
    if (body == 0 || slots[body - 1].kind != key.kind) kind_ends_.push_back(body);
    kind_ends_.back() = body + 1;
    component_of_body[key.serial] = static_cast<Index>(components_.size() - 1);
  }
  for (Index k = 0; k < kinds; ++k) body_kinds_.push_back(registry.entries()[k].kind->arranged(order[k]));
  return std::make_shared<Layout>(system_.dimension(), system_.token(), slots);
}

Index Assembly::component_of(Index body) const {
  // Of bodies that nothing couples each is a component.
  if (components_.size() == layout_->bodies().size()) return body;
  const auto at = std::upper_bound(
      components_.begin(), components_.end(), body,
      [](Index wanted, const Component& component) { return wanted < component.bodies.end; });
  return static_cast<Index>(at - components_.begin());
}

void Assembly::find_batches() {
  const BodySlots& bodies = layout_->bodies();
  Index kind = none;  // of the uncoupled bodies at hand
  for (Index component = 0; component < components_.size(); ++component) {
    const Index before = kind;
    kind = is_uncoupled(*this, component) ? bodies[components_[component].bodies.begin].kind : none;
    if (kind == none || kind != before) batches_.push_back({component, component});
    batches_.back().end = component + 1;
  }
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

bool Assembly::has_joints(Index component) const {
  for (Index kind = 0; kind < joint_kinds().size(); ++kind) {
    if (!joints(component, kind).empty()) return true;
  }
  return false;
}

bool has_joints(const Assembly& assembly, std::span<const Index> components) {
  return std::any_of(components.begin(), components.end(),
                     [&](Index component) { return assembly.has_joints(component); });
}

bool has_joints(const Assembly& assembly) {
  for (Index component = 0; component < assembly.components().size(); ++component) {
    if (assembly.has_joints(component)) return true;
  }
  return false;
}

State Assembly::initial_state() const {
  State state(layout_);
  for (const BodySlot& slot : layout_->bodies()) {
    const auto place = system_.body_kinds().place(slot.serial);
    system_.body_kinds().entries()[place.entry].kind->initial(place.slot, state.q.data() + slot.q,
                                                              state.v.data() + slot.v);
  }
  elements_.initial_internals(state.z.data());
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
  const Layout* const given = state.layout().get();
  // One that was read elsewhere is of no system, but of these places.
  if (given != nullptr && (given->token() == layout.token() || given->token() == none)) return;
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
