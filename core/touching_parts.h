#pragma once

/// \file
/// Parts of bodies that can touch something, for the check of a model (System::check()).

#include <carom/core/contact_filter.h>
#include <carom/core/ids.h>
#include <carom/core/model_finding.h>

#include <optional>
#include <string>
#include <vector>

namespace carom {

class SurfaceTable;
class System;

/// A material and a filter, the first part that has both, and the bodies that have such parts.
struct Toucher {
  MaterialId material;
  ContactFilter filter;
  std::string name;             ///< of the part
  std::string of_body;          ///< of a shape: " of rigid body 'log'"
  std::vector<Index> extended;  ///< serial numbers of bodies with a shape that has an extent
  std::vector<Index> points;    ///< serial numbers of bodies with a point

  void take(Index body, bool is_point);
};

/// Everything of bodies that can touch.
struct Touching {
  std::vector<Toucher> kinds;         ///< by material and filter
  std::vector<std::string> intended;  ///< shapes, and particles with a material: made to touch something
  bool any = false;                   ///< some body has a part that can touch
};

/// Name of a material in a finding: "material 'steel'", or "no material".
[[nodiscard]] std::string material_name(const SurfaceTable& surfaces, MaterialId material);
/// Collects the parts of bodies that can touch.
[[nodiscard]] Touching touching_parts(const System& system);
/// True if bodies of two kinds can touch each other: two bodies, of which points do not touch points.
[[nodiscard]] bool can_touch(const Toucher& a, const Toucher& b);
/// True if bodies touch each other by some law.
[[nodiscard]] bool any_touch(const System& system, const Touching& touching);
/// True if bodies of two materials can touch each other.
[[nodiscard]] bool can_touch(const Touching& touching, MaterialId a, MaterialId b);
/// True if a part that can touch is of a material.
[[nodiscard]] bool has(const Touching& touching, MaterialId material);
/// The finding about bodies that may meet and have no law, where there are shapes on ground, or bodies that
/// touch by another law: they pass through each other. \param surfaces of the system, which names its
/// materials
[[nodiscard]] std::optional<ModelFinding> bodies_without_law(const System& system,
                                                             const SurfaceTable& surfaces,
                                                             const Touching& touching);

}  // namespace carom
