#pragma once

// An assembly at its described state, and places of its features.

#include <carom/core/assembly.h>

#include <utility>

namespace carom_test {

struct PlacedModel {
  explicit PlacedModel(carom::System system)
      : assembly(std::move(system)),
        state(assembly.initial_state()),
        evaluation(carom::make_evaluation(assembly)) {
    update();
  }
  /// After a change of the state.
  void update() {
    for (carom::Index component = 0; component < assembly.components().size(); ++component) {
      evaluate_positions(assembly, component, state.view(), evaluation);
    }
  }

  carom::Assembly assembly;
  carom::State state;
  carom::Evaluation evaluation;
};

}  // namespace carom_test
