#pragma once

/// \file
/// The components that a step advances.

#include <carom/contact/detection/chosen_bodies.h>
#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/core/ids.h>

#include <cstdint>
#include <span>
#include <vector>

namespace carom {

/// Some components of a model, which a step advances as if there were no others: one or several coupling
/// sets, which neither contact nor loads connect to the rest.
class CAROM_API StepScope {
public:
  /// Chooses components. \param batches of all components, as SweepSchedule::batches() \param chosen some
  /// components, ascending
  void assign(const Assembly& assembly, std::span<const Range> batches, std::span<const Index> chosen);

  /// The components, in their order: those of one batch that follow one another together.
  [[nodiscard]] std::span<const Range> batches() const { return batches_; }
  /// True if a body belongs to one of the components.
  [[nodiscard]] bool has(Index body) const { return has_[body] != 0; }
  /// The bodies.
  [[nodiscard]] ChosenBodies chosen() const { return {batches_, has_}; }
  /// Number of components.
  [[nodiscard]] Index components() const { return components_; }
  /// Number of bodies.
  [[nodiscard]] Index bodies() const { return bodies_; }
  /// Calls f(component) for each component, in their order.
  template <class F>
  void for_each(F&& f) const {
    for (const Range batch : batches_) {
      for (Index component = batch.begin; component < batch.end; ++component) f(component);
    }
  }

private:
  std::vector<Range> batches_;
  std::vector<std::uint8_t> has_;  // by body
  Index components_ = 0, bodies_ = 0;
};

/// The bodies of a scope; all, where it is null.
[[nodiscard]] inline ChosenBodies bodies_of(const StepScope* scope) {
  return scope == nullptr ? ChosenBodies{} : scope->chosen();
}

}  // namespace carom
