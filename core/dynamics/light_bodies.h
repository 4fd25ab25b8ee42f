#pragma once

/// \file
/// Light bodies among heavy ones that joints bind to them, for errors: rounding of the forces between heavy
/// bodies moves them, and they swing fast.

#include <carom/core/export.h>
#include <carom/core/ids.h>

#include <string>
#include <vector>

namespace carom {

class Assembly;

/// Text that an error adds of a component in which masses differ by a factor of 100 and more: its light
/// bodies, their least mass, the heaviest body, and the ratio; empty where they do not. \param parts names of
/// the light bodies are appended
[[nodiscard]] CAROM_API std::string light_bodies(const Assembly& assembly, Index component,
                                                 std::vector<std::string>& parts);

}  // namespace carom
