#pragma once

// A force element for which no iteration of a time step converges.

#include <carom/carom.h>

#include <vector>

namespace carom_test {

/// Pushes down a body that rises and up one that does not: the force jumps, steps have no end.
struct Contrary {
  static constexpr carom::Role role = carom::Role::force;
  static constexpr int dimension = 2;
  carom::BodyId body;
  std::vector<carom::BodyId> bodies() const { return {body}; }
  void loads(const carom::ElementView<2>& at, carom::ElementLoads<2>& out) const {
    out.external(body, carom::Vec<2>(0.0, at.velocity(body)[1] > 0.01 ? -150.0 : 50.0));
  }
};

}  // namespace carom_test
