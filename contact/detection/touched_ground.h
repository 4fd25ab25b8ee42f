#pragma once

/// \file
/// Which shapes on ground the features of bodies may touch, and by which laws: looked up once.

#include <carom/contact/detection/law_facts.h>
#include <carom/core/export.h>
#include <carom/core/ids.h>

#include <span>
#include <vector>

namespace carom {

class Assembly;
class BodyFeatures;
class ContactLaws;
class GroundShapes;

/// A shape on ground that features of a material may touch.
struct TouchedShape {
  Index shape = none;  ///< number in GroundShapes
  Index law = none;    ///< number in ContactLaws
};

/// Shapes on ground without pieces, by the materials of features that may touch them.
class CAROM_API TouchedGround {
public:
  /// Throws ModelError, naming a contact, where a feature and a shape that may touch, with pieces or without,
  /// have no law.
  TouchedGround(const Assembly& assembly, const BodyFeatures& features, const GroundShapes& shapes,
                const ContactLaws& laws);

  /// Shapes that features of a material may touch, ascending; without those that outlines touch.
  /// \param material number in BodyFeatures::materials()
  [[nodiscard]] std::span<const TouchedShape> by(Index material) const {
    return {touched_.data() + begin_[material], touched_.data() + begin_[material + 1]};
  }
  /// Facts of all laws with shapes on ground that may be touched.
  [[nodiscard]] const LawFacts& facts() const { return facts_; }

private:
  std::vector<Index> begin_;  // of each material: its first in `touched_`
  std::vector<TouchedShape> touched_;
  LawFacts facts_;
};

}  // namespace carom
