#pragma once

/// \file
/// The name that was meant, for messages about one that does not exist.

#include <carom/core/export.h>

#include <string>
#include <string_view>
#include <vector>

namespace carom {

/// The known name that is most like a given one: letters added, left out, changed or exchanged, without
/// regard to capitals, are at most a third of the longer name. Of several the first; empty where none is that
/// near.
[[nodiscard]] CAROM_API std::string nearest_name(std::string_view given,
                                                 const std::vector<std::string_view>& known);
/// Throws ModelError for a part that does not exist: "body 'bal': there is none; the nearest is 'ball'; ...".
/// \param what "body" \param known names of all such parts
[[noreturn]] CAROM_API void refuse_name(std::string_view what, std::string_view name,
                                        const std::vector<std::string_view>& known);

}  // namespace carom
