#pragma once

/// \file
/// The bodies that detection looks at: all of a model, or those of some components.

#include <carom/core/assembly.h>
#include <carom/core/ids.h>

#include <cstdint>
#include <span>

namespace carom {

/// Some bodies of a model, those of some components; or all. A view.
struct ChosenBodies {
  std::span<const Range> components = {};        ///< ascending
  std::span<const std::uint8_t> is_chosen = {};  ///< by body; empty: all are chosen

  /// True of a body that is chosen.
  [[nodiscard]] bool has(Index body) const { return is_chosen.empty() || is_chosen[body] != 0; }
  /// Calls f(components) for ranges of components, ascending, whose bodies are chosen.
  template <class F>
  void for_components(const Assembly& assembly, F&& f) const {
    if (is_chosen.empty()) return f(Range{0, static_cast<Index>(assembly.components().size())});
    for (const Range some : components) f(some);
  }
};

/// Fills the position group of `out` for the bodies that are chosen.
inline void evaluate_positions(const Assembly& assembly, const ChosenBodies& bodies, const StateView& state,
                               Evaluation& out) {
  bodies.for_components(assembly, [&](Range components) {
    for (Index component = components.begin; component < components.end; ++component)
      evaluate_positions(assembly, component, state, out);
  });
}

}  // namespace carom
