#pragma once

/// \file
/// Names, laws and decisions of a System beside its parts, in containers that programs need not compile.

#include <carom/core/surface_table.h>
#include <carom/core/system.h>

#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>

namespace carom {

/// Names, laws of contact and decisions.
struct System::Notes {
  std::map<Role, std::map<Index, std::string>> names;                         ///< by serial number
  std::map<Role, std::map<std::string, Index, std::less<>>> serials_by_name;  ///< of parts that are there
  SurfaceTable surfaces;                                                      ///< laws of contact
  std::set<Index> kept;                                       ///< bodies that stay where they are
  std::map<std::pair<Index, Index>, bool> contact_decisions;  ///< of two bodies, the lesser first
  std::map<Index, BodyId> former_carriers;                    ///< bodies of removed shapes
};

}  // namespace carom
