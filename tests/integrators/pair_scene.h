#pragma once

#include "examples/scenes/incline.h"

#include <carom/carom.h>

namespace carom_test {

/// The pair of the paper close above the plane: springs, impacts, friction within half a second.
inline carom::System pair_scene() {
  scenes::Incline incline;
  incline.height = 2.0;
  incline.angle = 0.3;
  carom::System system;
  scenes::add_plane(system, incline);
  scenes::add_pair(system, incline);
  return system;
}

}  // namespace carom_test
