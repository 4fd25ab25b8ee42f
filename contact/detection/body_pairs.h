#pragma once

/// \file
/// Pairs of features of bodies that may touch each other, asked for body by body: of many bodies few are near
/// each other at a time, and a list of all pairs would grow with the square of their number.

#include <carom/contact/detection/body_outlines.h>
#include <carom/contact/detection/contact_pair.h>
#include <carom/contact/detection/pair_filter.h>
#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/core/ids.h>

#include <span>
#include <vector>

namespace carom {

/// The pairs of an assembly.
class CAROM_API BodyPairs {
public:
  /// \param outlines of the bodies of the assembly; they outlive it
  BodyPairs(const Assembly& assembly, const BodyOutlines& outlines);

  /// Appends all pairs of a vertex of one of some bodies and an outline of another of them that may touch,
  /// ordered by body, then outline, then the other body and its outline. \param bodies ascending
  void append(std::span<const Index> bodies, std::vector<ContactPair>& out) const;
  /// Appends the pairs of a vertex of one of two outlines and the other outline, if these may touch: those of
  /// the vertices of the first one come first. \param a,b their numbers in BodyOutlines
  void append_between(Index a, Index b, std::vector<ContactPair>& out) const {
    append(outlines_->list()[a], b, out);
    append(outlines_->list()[b], a, out);
  }

private:
  [[nodiscard]] bool may_touch(const BodyOutline& a, const BodyOutline& b) const {
    return has_law_[a.material * materials_ + b.material] != 0 && !(a.is_point() && b.is_point()) &&
           filter_.may_touch(a.body, a.filter, b.body, b.filter);
  }
  void append(const BodyOutline& a, Index of_b, std::vector<ContactPair>& out) const;

  const BodyOutlines* outlines_;
  PairFilter filter_;
  std::size_t materials_;
  std::vector<char> has_law_;  // row-major, by material
  std::vector<Range> of_;      // by body: its outlines
};

}  // namespace carom
