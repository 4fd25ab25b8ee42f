#pragma once

/// \file
/// A system made ready to run: bodies and elements ordered so that every component is a range of every array.

#include <carom/core/arranged_elements.h>
#include <carom/core/arranged_joints.h>
#include <carom/core/block_table.h>
#include <carom/core/component.h>
#include <carom/core/export.h>
#include <carom/core/force_kind.h>
#include <carom/core/layout.h>
#include <carom/core/registry.h>
#include <carom/core/state.h>
#include <carom/core/system.h>
#include <carom/core/workers.h>

#include <algorithm>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace carom {

/// A system made ready to run. Constant after construction.
class CAROM_API Assembly {
public:
  /// Orders, checks and counts. Throws ModelError for a system without bodies.
  explicit Assembly(System system);

  /// The model.
  [[nodiscard]] const System& system() const { return system_; }
  /// Places of bodies.
  [[nodiscard]] const std::shared_ptr<const Layout>& layout() const { return layout_; }
  /// Components, in the order of assembly.
  [[nodiscard]] const std::vector<Component>& components() const { return components_; }
  /// The component of a body.
  [[nodiscard]] Index component_of(Index body) const;
  /// Ranges of components, in their order, whose bodies may be evaluated in one loop: uncoupled bodies of one
  /// kind, on which fields alone act, that follow one another; each other component by itself.
  [[nodiscard]] const std::vector<Range>& batches() const { return batches_; }
  /// Bodies of consecutive components.
  [[nodiscard]] Range bodies_of(Range components) const {
    return {components_[components.begin].bodies.begin, components_[components.end - 1].bodies.end};
  }
  /// Lengths that weight changes of the velocity coordinates (BodyKind::length_scale). Made at each
  /// call.
  [[nodiscard]] std::vector<double> length_scales() const;

  /// Kinds of bodies in the order of assembly, with the data of a run. The description is in system().
  [[nodiscard]] const std::vector<std::unique_ptr<BodyKind>>& body_kinds() const { return body_kinds_; }
  /// Blocks of all components, and the elements that act on them.
  [[nodiscard]] const BlockTable& blocks() const { return blocks_; }

  /// Kinds of force elements, arranged.
  [[nodiscard]] const std::vector<std::unique_ptr<ForceKind>>& force_kinds() const {
    return elements_.kinds();
  }
  /// Elements of a kind that act in a component.
  [[nodiscard]] Range elements(Index component, Index kind) const {
    return elements_.elements(component, kind);
  }
  /// Identity of an arranged element.
  [[nodiscard]] ElementId element_id(Index kind, Index slot) const {
    return {system_.force_kinds().entries()[kind].serials[elements_.described_slot(kind, slot)],
            system_.token()};
  }

  /// Kinds of joints, arranged.
  [[nodiscard]] const std::vector<std::unique_ptr<JointKind>>& joint_kinds() const { return joints_.kinds(); }
  /// Joints of a kind in a component.
  [[nodiscard]] Range joints(Index component, Index kind) const { return joints_.joints(component, kind); }
  /// True if a component has joints.
  [[nodiscard]] bool has_joints(Index component) const;
  /// Identity of an arranged joint.
  [[nodiscard]] JointId joint_id(Index kind, Index slot) const {
    return {joints_.serial(kind, slot), system_.token()};
  }
  /// Mechanism of a body (the bodies connected to it by joints), named by its first body; the body itself
  /// without joints.
  [[nodiscard]] Index mechanism(Index body) const { return joints_.mechanism(body); }
  /// True if the body has a joint.
  [[nodiscard]] bool is_jointed(Index body) const { return joints_.is_jointed(body); }

  /// Calls f(kind, slots, q offset, v offset, rotation offset) for consecutive bodies, kind by kind.
  template <class F>
  void for_bodies(Range bodies, F&& f) const {
    const Index* end = kind_ends_.data();
    if (kind_ends_.size() > 1) end = std::upper_bound(end, end + kind_ends_.size(), bodies.begin);
    for (Index body = bodies.begin; body < bodies.end; ++end) {
      const BodySlot first = layout_->bodies()[body];
      const Index count = std::min(*end, bodies.end) - body;
      f(*body_kinds_[first.kind], Range{first.slot, first.slot + count}, first.q, first.v, first.rotation);
      body += count;
    }
  }

  /// Calls f(kind, slots, q, v, rotation) for each run of bodies of one kind in a component; the numbers are
  /// the places of the first body of the run.
  template <class F>
  void for_bodies(Index component, F&& f) const {
    for_bodies(components_[component].bodies, std::forward<F>(f));
  }

  /// The state described by the system, at time 0.
  [[nodiscard]] State initial_state() const;

private:
  // Returns the layout, still to be completed, and the component of each body, by serial number.
  std::shared_ptr<Layout> order_bodies(std::vector<Index>& component_of_body);
  void find_batches();

  System system_;
  std::shared_ptr<const Layout> layout_;
  std::vector<Component> components_;
  std::vector<std::unique_ptr<BodyKind>> body_kinds_;
  std::vector<Index> kind_ends_;  // where bodies that follow one another cease to be of one kind
  std::vector<Range> batches_;
  BlockTable blocks_;
  ArrangedJoints joints_;
  ArrangedElements elements_;
};

/// Fills the position group of `out` for one component.
CAROM_API void evaluate_positions(const Assembly& assembly, Index component, const StateView& state,
                                  Evaluation& out);
/// Fills it for all.
CAROM_API void evaluate_positions(const Assembly& assembly, const StateView& state, Evaluation& out);

/// A computation for a block, done while its data are in the cache; called with its place in the component.
using BlockTask = FunctionRef<void(const Block&, Index)>;

/// Additional computations for each block of a component.
struct BlockTasks {
  BlockTask first = {};  ///< before its loads are evaluated
  BlockTask last = {};   ///< after all of them are evaluated
};

/// Zeroes the given arrays over one component and adds the loads of all its elements. The position group of
/// `evaluation` must be up to date. Arrays may coincide.
CAROM_API void evaluate_loads(const Assembly& assembly, Index component, const StateView& state,
                              const Evaluation& evaluation, const Loads& loads,
                              const Workers& workers = Workers(), const BlockTasks& tasks = {});

/// Loads on the inner blocks only: zeroes the given arrays over the touched blocks and adds the loads of the
/// loading ones. Only the loads on the inner blocks are then complete, with the same rounding as by
/// evaluate_loads().
CAROM_API void evaluate_loads_within(const Assembly& assembly, Index component, const Surroundings& blocks,
                                     const StateView& state, const Evaluation& evaluation,
                                     const Loads& loads);

/// evaluate_loads(), and adds the potential energies of the elements to `stored`.
CAROM_API void evaluate_loads_and_potentials(const Assembly& assembly, Index component,
                                             const StateView& state, const Evaluation& evaluation,
                                             const Loads& loads, StoredEnergies& stored,
                                             const Workers& workers = Workers(),
                                             const BlockTasks& tasks = {});

/// evaluate_loads(), then evaluate_loads_and_potentials() at the state that `second_tasks.first` computes,
/// block by block as soon as the first evaluation no longer needs the block: for large components, whose data
/// are then read from memory once instead of twice. The rounding of sums differs from that of the two
/// functions.
CAROM_API void evaluate_loads_twice(const Assembly& assembly, Index component, const StateView& state,
                                    const Evaluation& evaluation, const Loads& first,
                                    const BlockTasks& first_tasks, const Loads& second,
                                    const BlockTasks& second_tasks, StoredEnergies& stored,
                                    const Workers& workers = Workers());

/// Zeroes the given arrays over one component and adds the mean loads of all its elements over a step
/// (ForceKind::evaluate_mean).
CAROM_API void evaluate_mean_loads(const Assembly& assembly, Index component, const StepContext& step,
                                   const Loads& loads, const Workers& workers = Workers(),
                                   const BlockTasks& tasks = {});

/// True if mean loads or inner losses of elements of a component depend on the state in the middle of the
/// step.
[[nodiscard]] CAROM_API bool uses_middle(const Assembly& assembly, Index component);

/// Advances the internal variables of one component to the end of a step (ForceKind::advance_internal).
/// Returns the first element for which that failed, an invalid identity if there is none.
[[nodiscard]] CAROM_API ElementId advance_internals(const Assembly& assembly, Index component,
                                                    const StepContext& step, double* z);

/// Energy lost inside the elements of one component over a step [J].
[[nodiscard]] CAROM_API double internal_loss(const Assembly& assembly, Index component,
                                             const StepContext& step);

/// Position group and the sum of all loads (Evaluation::force) of one component.
CAROM_API void evaluate(const Assembly& assembly, Index component, const StateView& state, Evaluation& out);

/// True if any of some components has joints.
[[nodiscard]] CAROM_API bool has_joints(const Assembly& assembly, std::span<const Index> components);
/// True if any component has joints.
[[nodiscard]] CAROM_API bool has_joints(const Assembly& assembly);
/// Kinetic energy of some bodies [J]. \param velocities over all
[[nodiscard]] CAROM_API double kinetic_energy(const Assembly& assembly, Range bodies,
                                              const double* velocities);
/// Adds the potential energies of one component. The position group of `evaluation` must be up to date.
CAROM_API void add_potentials(const Assembly& assembly, Index component, const StateView& state,
                              const Evaluation& evaluation, StoredEnergies& out);

/// Adds the potential energies of fields on some bodies of a batch.
CAROM_API void add_field_potentials(const Assembly& assembly, Range bodies, const StateView& state,
                                    const Evaluation& evaluation, StoredEnergies& out);

/// Adds the stored energies of one component. The position group of `evaluation` must be up to date.
CAROM_API void add_stored_energies(const Assembly& assembly, Index component, const StateView& state,
                                   const Evaluation& evaluation, StoredEnergies& out);

/// Stored energies of all components. \param evaluation a workspace, whose position group is brought up to
/// date
[[nodiscard]] CAROM_API StoredEnergies stored_energies(const Assembly& assembly, const StateView& state,
                                                       Evaluation& evaluation);

/// Resizes a workspace for an assembly.
[[nodiscard]] CAROM_API Evaluation make_evaluation(const Assembly& assembly);

/// Demands a state of this model: its sizes, and its identities. Throws ModelError.
CAROM_API void check_sizes(const Assembly& assembly, const State& state);
/// Demands a state of this layout with finite numbers. Throws ModelError naming the body and the value.
CAROM_API void check_state(const Assembly& assembly, const State& state);

}  // namespace carom
