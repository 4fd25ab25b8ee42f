#pragma once

/// \file
/// Order in which the contacts of one impact act.

#include <carom/core/export.h>

#include <cstdint>
#include <string_view>

namespace carom {

/// Order of the contacts of one impact (docs/contact_law.md). Both are laws: they differ in Newton's cradle.
enum class ImpactOrder : std::uint8_t {
  simultaneous,  ///< all that touch are one problem (Moreau)
  /// The contact that approaches fastest alone, contacts as fast as it as one problem; then the next, until
  /// none approaches.
  sequential
};

/// Name of an order: "simultaneous", "sequential".
[[nodiscard]] CAROM_API std::string_view to_string(ImpactOrder order);

}  // namespace carom
