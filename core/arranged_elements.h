#pragma once

/// \file
/// Force elements of a system in the order of assembly: those of a component are a range of their kind.

#include <carom/core/block_table.h>
#include <carom/core/component.h>
#include <carom/core/force_kind.h>
#include <carom/core/layout.h>
#include <carom/core/system.h>

#include <memory>
#include <vector>

namespace carom {

/// Kinds of force elements, arranged.
class ArrangedElements {
public:
  ArrangedElements() = default;
  /// Orders elements by component, then by block. \param component_of_body by serial number
  ArrangedElements(const System& system, const Layout& layout, const std::vector<Component>& components,
                   const std::vector<Index>& component_of_body, BlockTable& blocks);

  /// Kinds, in the order of the system.
  [[nodiscard]] const std::vector<std::unique_ptr<ForceKind>>& kinds() const { return kinds_; }
  /// Elements of a kind that act in a component.
  [[nodiscard]] Range elements(Index component, Index kind) const {
    return slots_[component * kinds_.size() + kind];
  }
  /// Place of an element within its kind in the system.
  [[nodiscard]] Index described_slot(Index kind, Index slot) const {
    return order_[kind].empty() ? slot : order_[kind][slot];
  }
  /// Numbers the internal variables of all elements, component by component, and tells the kinds; sets the
  /// ranges of the components.
  [[nodiscard]] std::vector<InternalSlot> place_internals(const System& system,
                                                          std::vector<Component>& components);
  /// Writes the internal variables at the start.
  void initial_internals(double* z) const;

private:
  // Calls f(kind, element, its number of internal variables, the first of them) in their order.
  template <class F>
  void for_internals(Index component, Index& z, F&& f) const;

  std::vector<std::unique_ptr<ForceKind>> kinds_;
  std::vector<Range> slots_;               // by component, kind
  std::vector<std::vector<Index>> order_;  // by kind: described slots, empty if the order is the same
};

}  // namespace carom
