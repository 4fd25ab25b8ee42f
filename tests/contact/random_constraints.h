#pragma once

// Constraints with random rows, for islands whose rows need not be those of anything.

#include "tests/random.h"

#include <carom/core/assembly.h>
#include <carom/core/constraint_set.h>

#include <span>

namespace carom_test {

/// A contact of two rows along some bodies, or a limit of one. \param rows 1 or 2
inline carom::SingleConstraint random_constraint(const carom::Assembly& assembly, int rows,
                                                 std::span<const carom::Index> bodies, Random& random) {
  carom::SingleConstraint made;
  made.friction = 0.1;
  made.law = {.friction = 0.1, .normal_restitution = 0.3, .tangential_restitution = 0.3};
  for (const carom::Index body : bodies) {
    const carom::BodySlot& slot = assembly.layout()->bodies()[body];
    made.add_body(body, slot.v, static_cast<int>(slot.v_size));
  }
  made.start_rows(rows);
  for (int row = 0; row < rows; ++row) {
    for (int c = 0; c < made.columns(); ++c) made.row(row)[c] = random.uniform(-1.0, 1.0);
  }
  return made;
}

}  // namespace carom_test
