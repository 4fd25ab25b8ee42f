#pragma once

/// \file
/// A picture of a model's graph.

#include <carom/core/export.h>

#include <string>

namespace carom {

class System;

/// The graph of a system in the language of Graphviz, for `dot -Tsvg`: bodies are nodes (with their mass),
/// grouped by island; couplings are edges, a load on one body is a plain node beside it, an element on three
/// or more bodies a diamond; the ground appears where a coupling ends on it; fields are notes. Shapes hang on
/// their bodies. A dashed edge joins whatever may touch an obstacle with it and names the contact law
/// (friction, restitution), in red where no law is given yet. Parts are called by their names, in the order
/// in which they came.
[[nodiscard]] CAROM_API std::string to_dot(const System& system);

}  // namespace carom
