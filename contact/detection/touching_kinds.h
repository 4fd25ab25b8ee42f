#pragma once

/// \file
/// Whether any, or all, of the outlines of an assembly may touch each other. Most are alike, so that kinds of
/// them are asked; of bodies that can touch no other nothing is looked up.

#include <carom/contact/detection/body_outlines.h>
#include <carom/contact/detection/pair_filter.h>
#include <carom/core/export.h>
#include <carom/core/function_ref.h>

#include <vector>

namespace carom {

/// Which outlines of two bodies may touch each other. Of more than some hundred kinds it may be taken for
/// granted that some may, not all.
struct TouchingKinds {
  bool any = false;  ///< some
  bool all = false;  ///< all, and no joint or decision parts any two bodies
};

/// \param may_touch may_touch(a, b) of two outlines by their materials, filters and forms, the same in either
/// order; whose bodies they are does not count
[[nodiscard]] CAROM_API TouchingKinds
touching_kinds(const std::vector<BodyOutline>& list, const PairFilter& filter,
               FunctionRef<bool(const BodyOutline&, const BodyOutline&)> may_touch);

}  // namespace carom
