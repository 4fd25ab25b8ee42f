#pragma once

/// \file
/// Files read and written as a whole.

#include <carom/core/export.h>

#include <string>
#include <string_view>

namespace carom {

/// True if there is something of that name that is not a regular file: a device, a pipe, a directory.
[[nodiscard]] CAROM_API bool is_special_file(const std::string& path);

/// The content of a regular file. Throws FileError "<what> '<path>': cannot be read"; of a device, a pipe or
/// a directory too.
[[nodiscard]] CAROM_API std::string read_file(const std::string& path, std::string_view what);

/// Writes a file; an existing one is replaced only when the new one is complete. Throws FileError
/// "<what> '<path>': cannot be written", in the place of a device, a pipe or a directory too.
CAROM_API void write_file(const std::string& path, std::string_view content, std::string_view what);

}  // namespace carom
