#pragma once

/// \file
/// Materials that bodies touch with, by number.

#include <carom/core/export.h>
#include <carom/core/ids.h>

#include <vector>

namespace carom {

class System;

/// Materials of the shapes of bodies, and of bodies that touch at their centres, each once. One of them may
/// be no material. Their places in this list are their numbers.
[[nodiscard]] CAROM_API std::vector<MaterialId> body_materials(const System& system);
/// Number of a material of such a list, in which it must be.
[[nodiscard]] CAROM_API Index number_of(MaterialId material, const std::vector<MaterialId>& all);

}  // namespace carom
