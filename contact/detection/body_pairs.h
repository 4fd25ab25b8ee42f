#pragma once

/// \file
/// Pairs of features of bodies that may touch each other, asked for body by body: of many bodies few are near
/// each other at a time, and a list of all pairs would grow with the square of their number.

#include <carom/contact/detection/contact_pair.h>
#include <carom/contact/detection/outlines.h>
#include <carom/core/export.h>
#include <carom/core/ids.h>

#include <span>
#include <vector>

namespace carom {

/// The pairs of an assembly.
class CAROM_API BodyPairs {
public:
  /// \param outlines outlive it
  explicit BodyPairs(const Outlines& outlines);

  /// Appends all pairs of a vertex of one of some bodies and an outline of another of them that may touch,
  /// ordered by body, then outline, then the other body and its outline. \param bodies ascending
  void append(std::span<const Index> bodies, std::vector<ContactPair>& out) const;
  /// Appends the pairs of a vertex of one of two outlines and the other outline, if these may touch: those of
  /// the vertices of the first one come first. \param a,b their numbers in BodyOutlines
  void append_between(Index a, Index b, std::vector<ContactPair>& out) const {
    append(a, b, out);
    append(b, a, out);
  }

private:
  void append(Index of_a, Index of_b, std::vector<ContactPair>& out) const;

  const Outlines* outlines_;
  std::vector<Range> of_;  // by body: its outlines
};

}  // namespace carom
