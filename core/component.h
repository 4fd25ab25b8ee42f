#pragma once

/// \file
/// Bodies that are connected, as ranges of every array.

#include <carom/core/ids.h>

namespace carom {

/// A connected component: bodies connected by force elements or joints. Ground, shapes on it and fields do
/// not connect bodies.
struct Component {
  Range bodies;  ///< in the order of assembly
  Range q;       ///< coordinates
  Range v;       ///< velocities
  Range z;       ///< internal variables of elements
  Range blocks;  ///< parts of it, see BlockTable
  Range runs;    ///< see BlockTable::runs()
};

}  // namespace carom
