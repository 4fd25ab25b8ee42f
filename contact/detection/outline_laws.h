#pragma once

/// \file
/// Which outlines may touch each other, and by which law: one table for bodies and shapes on ground.

#include <carom/contact/detection/body_outlines.h>
#include <carom/contact/detection/ground_shapes.h>
#include <carom/contact/detection/law_facts.h>
#include <carom/contact/detection/pair_filter.h>
#include <carom/core/assembly.h>
#include <carom/core/contact_filter.h>
#include <carom/core/export.h>
#include <carom/core/surface.h>
#include <carom/core/system.h>

#include <optional>
#include <vector>

namespace carom {

/// True if there is a law between the materials of two bodies that have shapes, or of a shape and a particle.
[[nodiscard]] CAROM_API bool has_law_between_bodies(const System& system);

/// Laws between the materials of bodies, and between these and shapes on ground that have pieces.
class CAROM_API OutlineLaws {
public:
  /// \param bodies outlines of the bodies of the assembly \param between_bodies whether to look these up
  OutlineLaws(const Assembly& assembly, const BodyOutlines& bodies, const GroundShapes& shapes,
              bool between_bodies);

  /// True if some two bodies may touch each other.
  [[nodiscard]] bool bodies_touch() const { return bodies_touch_; }
  /// True if any two outlines of different bodies may touch.
  [[nodiscard]] bool all_bodies_may_touch() const { return all_may_touch_; }
  /// Facts of the laws between bodies; none where these do not touch.
  [[nodiscard]] const LawFacts& facts_of_bodies() const { return facts_; }
  /// Law between the materials of two outlines of bodies; null: there is none, so that they do not touch.
  [[nodiscard]] const Surface* between(const BodyOutline& a, const BodyOutline& b) const {
    return at(a.material, b.material);
  }
  /// Law between an outline of a body and a shape on ground; null: there is none.
  [[nodiscard]] const Surface* with_ground(const BodyOutline& a, Index shape) const {
    return at(a.material, materials_ + shape);
  }
  /// True if two outlines of bodies may touch.
  [[nodiscard]] bool may_touch(const BodyOutline& a, const BodyOutline& b) const {
    return kinds_may_touch(a, b) && a.body != b.body && !filter_.is_excluded(a.body, b.body);
  }

private:
  /// \param surface a material of bodies, or behind these a shape on ground
  [[nodiscard]] const Surface* at(Index material, Index surface) const {
    const std::optional<Surface>& found = laws_[material * surfaces_ + surface];
    return found ? &*found : nullptr;
  }
  /// Whether outlines like these may touch, whose ever they are.
  [[nodiscard]] bool kinds_may_touch(const BodyOutline& a, const BodyOutline& b) const {
    return between(a, b) != nullptr && !(a.is_point() && b.is_point()) &&
           carom::may_touch(a.filter, b.filter);
  }

  Index materials_ = 0, surfaces_ = 0;        // of bodies; these and shapes on ground
  std::vector<std::optional<Surface>> laws_;  // row-major
  PairFilter filter_;
  LawFacts facts_;
  bool bodies_touch_ = false, all_may_touch_ = false;
};

}  // namespace carom
