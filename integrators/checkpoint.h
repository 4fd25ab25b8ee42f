#pragma once

/// \file
/// Saved states. A file holds a format mark, a fingerprint of the model, the state and the companion, all
/// numbers bit for bit.

#include <carom/core/export.h>
#include <carom/core/state.h>
#include <carom/integrators/run/companion.h>

#include <cstdint>
#include <string>
#include <string_view>

namespace carom {

/// A checkpoint as bytes.
[[nodiscard]] CAROM_API std::string write_checkpoint(std::uint64_t fingerprint, const State& state,
                                                     const Companion& companion);

/// Reads what write_checkpoint() wrote into a state and companion of the same model. Throws FileError,
/// changing neither, for bytes that are damaged or have another fingerprint. \param origin of the bytes, for
/// messages
CAROM_API void read_checkpoint(std::string_view content, const std::string& origin, std::uint64_t fingerprint,
                               State& state, Companion& companion);

/// Writes a checkpoint; an existing file is replaced only when the new one is complete. Throws FileError.
CAROM_API void save_checkpoint(const std::string& path, std::uint64_t fingerprint, const State& state,
                               const Companion& companion);

/// Reads a checkpoint into a state and companion of the same model. Throws FileError, changing neither, for a
/// file that cannot be read, is damaged, or has another fingerprint.
CAROM_API void load_checkpoint(const std::string& path, std::uint64_t fingerprint, State& state,
                               Companion& companion);

}  // namespace carom
