#pragma once

/// \file
/// Parts of a System, and names, laws and decisions beside them, in containers that programs need not
/// compile.

#include <carom/core/registry.h>
#include <carom/core/surface_table.h>
#include <carom/core/system.h>

#include <functional>
#include <map>
#include <set>
#include <string>
#include <type_traits>
#include <utility>

namespace carom {

/// Parts by kind; names, laws of contact and decisions.
struct System::Stored {
  Registry<BodyKind> bodies;
  Registry<ForceKind> forces;
  Registry<JointKind> joints;
  Registry<ShapeKind> shapes;
  Registry<GroundShapeKind> ground_shapes;

  std::map<Role, std::map<Index, std::string>> names;                         ///< by serial number
  std::map<Role, std::map<std::string, Index, std::less<>>> serials_by_name;  ///< of parts that are there
  SurfaceTable surfaces;                                                      ///< laws of contact
  std::set<Index> kept;                                       ///< bodies that stay where they are
  bool closes_joints = false;                                 ///< bodies are moved however far
  std::map<std::pair<Index, Index>, bool> contact_decisions;  ///< of two bodies, the lesser first
  std::map<Index, BodyId> former_carriers;                    ///< bodies of removed shapes

  /// Parts whose role has the interface `K`.
  template <class K>
  [[nodiscard]] Registry<K>& of() {
    if constexpr (std::is_same_v<K, BodyKind>) {
      return bodies;
    } else if constexpr (std::is_same_v<K, ForceKind>) {
      return forces;
    } else if constexpr (std::is_same_v<K, JointKind>) {
      return joints;
    } else if constexpr (std::is_same_v<K, ShapeKind>) {
      return shapes;
    } else {
      return ground_shapes;
    }
  }
};

}  // namespace carom
