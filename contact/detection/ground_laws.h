#pragma once

/// \file
/// Laws of the contacts between features of bodies and shapes on ground, looked up once.

#include <carom/contact/detection/law_facts.h>
#include <carom/core/export.h>
#include <carom/core/ids.h>
#include <carom/core/surface.h>

#include <span>
#include <vector>

namespace carom {

class Assembly;
class BodyFeatures;
class GroundShapes;

/// A law for each material of the features and each shape on ground that it may touch.
class CAROM_API GroundLaws {
public:
  /// Throws ModelError, naming a contact, where a pair that may touch has no law.
  GroundLaws(const Assembly& assembly, const BodyFeatures& features, const GroundShapes& shapes);

  /// Shapes on ground that features of a material may touch, ascending; without those that outlines touch.
  /// \param material number in BodyFeatures::materials()
  [[nodiscard]] std::span<const Index> touched_by(Index material) const {
    return {touched_.data() + begin_[material], touched_.data() + begin_[material + 1]};
  }
  /// Law of a pair that may touch. \param material number in BodyFeatures::materials()
  [[nodiscard]] const Surface& law(Index material, Index shape) const {
    return laws_[material * shapes_ + shape];
  }
  /// Facts of all laws.
  [[nodiscard]] const LawFacts& facts() const { return facts_; }

private:
  Index shapes_;               // number of shapes
  std::vector<Surface> laws_;  // row-major: material, shape
  std::vector<Index> begin_;   // of each material: its first in `touched_`
  std::vector<Index> touched_;
  LawFacts facts_;
};

}  // namespace carom
