#pragma once

/// \file
/// Laws of contact: one table for bodies and shapes on ground; and which bodies may touch each other.

#include <carom/contact/detection/body_outlines.h>
#include <carom/contact/detection/ground_shapes.h>
#include <carom/contact/detection/law_facts.h>
#include <carom/contact/detection/pair_filter.h>
#include <carom/core/assembly.h>
#include <carom/core/contact_filter.h>
#include <carom/core/export.h>
#include <carom/core/ids.h>
#include <carom/core/surface.h>
#include <carom/core/system.h>

#include <optional>
#include <vector>

namespace carom {

/// True if there is a law between the materials of two bodies that have shapes, or of a shape and a particle.
[[nodiscard]] CAROM_API bool has_law_between_bodies(const System& system);

/// Laws between the materials of bodies, and between these and shapes on ground, by number.
class CAROM_API ContactLaws {
public:
  /// \param bodies outlines of the bodies of the assembly \param between_bodies whether to look these up
  ContactLaws(const Assembly& assembly, const BodyOutlines& bodies, const GroundShapes& shapes,
              bool between_bodies);

  /// A law by its number, that of one which there is.
  [[nodiscard]] const Surface& operator[](Index law) const { return *laws_[law]; }
  /// Number of the law between two materials, the same in either order; `none` if there is none, or bodies
  /// are not looked up. \param a,b numbers among body_materials()
  [[nodiscard]] Index between(Index a, Index b) const {
    return with_bodies_ == 0 ? none : existing(a < b ? a * surfaces_ + b : b * surfaces_ + a);
  }
  /// Number of the law between a material and a shape on ground; `none` if there is none. \param material
  /// number among body_materials()
  [[nodiscard]] Index with_ground(Index material, Index shape) const {
    return existing(material * surfaces_ + with_bodies_ + shape);
  }

  /// True if some two bodies may touch each other.
  [[nodiscard]] bool bodies_touch() const { return bodies_touch_; }
  /// True if any two outlines of different bodies may touch.
  [[nodiscard]] bool all_bodies_may_touch() const { return all_may_touch_; }
  /// Facts of the laws between bodies; none where these do not touch.
  [[nodiscard]] const LawFacts& facts_of_bodies() const { return facts_; }
  /// True if two outlines of bodies may touch.
  [[nodiscard]] bool may_touch(const BodyOutline& a, const BodyOutline& b) const {
    return kinds_may_touch(a, b) && a.body != b.body && !filter_.is_excluded(a.body, b.body);
  }

private:
  [[nodiscard]] Index existing(Index law) const { return laws_[law] ? law : none; }
  /// Whether outlines like these may touch, whose ever they are.
  [[nodiscard]] bool kinds_may_touch(const BodyOutline& a, const BodyOutline& b) const {
    return between(a.material, b.material) != none && !(a.is_point() && b.is_point()) &&
           carom::may_touch(a.filter, b.filter);
  }

  Index with_bodies_ = 0, surfaces_ = 0;  // materials of bodies to be touched; these and shapes on ground
  // Row-major: a material, and what it touches; of two materials in the row of the lesser one.
  std::vector<std::optional<Surface>> laws_;
  PairFilter filter_;
  LawFacts facts_;
  bool bodies_touch_ = false, all_may_touch_ = false;
};

}  // namespace carom
