#pragma once

/// \file
/// Fingerprint of a system, by which a checkpoint is refused on another model.

#include <carom/core/export.h>

#include <cstdint>
#include <span>
#include <string_view>

namespace carom {

/// A 64-bit FNV-1a hash of what a part reports of itself. Functions given by users cannot be hashed.
class CAROM_API Fingerprint {
public:
  /// Adds a number, bit for bit.
  void add(double value);
  /// Adds numbers, bit for bit.
  void add(std::span<const double> values);
  /// Adds a whole number.
  void add(std::uint64_t value);
  /// Adds a text.
  void add(std::string_view text);
  /// The hash so far.
  [[nodiscard]] std::uint64_t value() const { return hash_; }

private:
  void byte(unsigned char value);

  std::uint64_t hash_ = 0xcbf29ce484222325ULL;
};

}  // namespace carom
