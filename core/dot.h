#pragma once

/// \file
/// A drawing of the graph of a model.

#include <carom/core/export.h>

#include <string>

namespace carom {

class System;

/// The graph of a system in the language of Graphviz, for `dot -Tsvg`: bodies are nodes (with their mass),
/// grouped by component; force elements are edges, a load on one body is a plain node beside it, an element
/// on three or more bodies is a diamond; the ground appears if an element ends on it; fields are notes.
/// Shapes are drawn at their bodies. A dashed edge connects a part that may touch a shape on ground with
/// it, and has the contact law (friction, restitution); it is red if no law is given yet. Parts have
/// their names, in the order in which they were added.
[[nodiscard]] CAROM_API std::string to_dot(const System& system);

}  // namespace carom
