#pragma once

/// \file
/// How loads couple the components of a model in a step, and which components are taken in one loop.

#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/integrators/run/time_stepping.h>
#include <carom/integrators/time_stepping/step_islands.h>
#include <carom/integrators/time_stepping/step_scope.h>

#include <cstdint>
#include <span>
#include <vector>

namespace carom {

/// Coupling of a component.
enum class CouplingClass : std::uint8_t {
  iterated,       ///< loads depend on what the step leads to
  streamable,     ///< loads depend on what the step leads to; nothing comes between bodies and their loads
  constant_loads  ///< loads are those at the start: no iteration
};

/// Couplings and batches of a model. They follow from it and its options.
class CAROM_API StepBatches {
public:
  /// \param load_rotations whether loads depend on rotations of bodies
  StepBatches(const Assembly& assembly, const TimeStepping& options, bool load_rotations);

  /// Coupling of a component.
  [[nodiscard]] CouplingClass coupling(Index component) const { return coupling_[component]; }
  /// True if a component is coupled by loads that change.
  [[nodiscard]] bool any_iterated() const { return any_iterated_; }
  /// True if the loads of all components of an island are those at the start of a step.
  [[nodiscard]] bool has_constant_loads(const StepIsland& island) const;
  /// Components that a step takes in one loop, in their order: batches of uncoupled bodies whose loads are
  /// constant; each other component by itself.
  [[nodiscard]] std::span<const Range> all() const { return batches_; }
  /// Those that a step advances. \param scope of the step; null: all
  [[nodiscard]] std::span<const Range> of(const StepScope* scope) const {
    return scope == nullptr ? all() : scope->batches();
  }

private:
  void classify(const Assembly& assembly, const TimeStepping& options, bool load_rotations);
  void find_batches(const Assembly& assembly);

  std::vector<CouplingClass> coupling_;  // by component
  bool any_iterated_ = false;
  std::vector<Range> batches_;
};

}  // namespace carom
