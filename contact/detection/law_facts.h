#pragma once

/// \file
/// Facts of some laws of contact that spare questions where no law has them.

#include <carom/core/surface.h>

namespace carom {

/// Facts of a set of laws: each is true where some law has it.
struct LawFacts {
  bool static_friction = false;     ///< it takes more to slip than to slide
  bool other_impact_law = false;    ///< a law of impact that is not Newton's
  bool rolling_resistance = false;  ///< rolling resistance

  /// Takes in the facts of other laws.
  void add(const LawFacts& other) {
    static_friction = static_friction || other.static_friction;
    other_impact_law = other_impact_law || other.other_impact_law;
    rolling_resistance = rolling_resistance || other.rolling_resistance;
  }
  /// Takes in a law.
  void add(const Surface& law) {
    static_friction = static_friction || law.has_static_friction();
    other_impact_law = other_impact_law || law.has_other_impact_law();
    rolling_resistance = rolling_resistance || law.resists_rolling();
  }
};

}  // namespace carom
