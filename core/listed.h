#pragma once

/// \file
/// Names in a message, and its length.

#include <carom/core/export.h>

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace carom {

/// Names that a message writes out: the worst tell the cause, and a hundred contacts of a pile hide it.
inline constexpr std::size_t most_listed = 3;

/// Longest message of a SolverError [bytes]. Lists name the worst parts and count the others, all of which
/// SolverFailure::parts names; of what is longer all the same, as with long names, the middle is left out.
inline constexpr std::size_t longest_message = 600;

/// "disc 'rim', disc #1 and 7 more". \param most names that are written out
[[nodiscard]] CAROM_API std::string listed(std::span<const std::string> names,
                                           std::size_t most = most_listed);
/// Names with one of them moved to the front, the others in their order. \param worst its place; negative:
/// none
[[nodiscard]] CAROM_API std::vector<std::string> worst_first(std::vector<std::string> names, int worst);
/// A text in at most so many bytes: a longer one loses its middle, for which " ... " stands. Characters of
/// UTF-8 stay whole. \param most at least 16
[[nodiscard]] CAROM_API std::string shortened(const std::string& text, std::size_t most);

}  // namespace carom
