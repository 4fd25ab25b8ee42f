#include <carom/contact/detection/body_materials.h>
#include <carom/core/registry.h>
#include <carom/core/system.h>

#include <algorithm>

namespace carom {

std::vector<MaterialId> body_materials(const System& system) {
  std::vector<MaterialId> all;
  const auto add = [&](MaterialId material) {
    if (std::find(all.begin(), all.end(), material) == all.end()) all.push_back(material);
  };
  for (const auto& entry : system.shape_kinds().entries()) {
    for (Index slot = 0; slot < entry.serials.size(); ++slot) add(entry.kind->material(slot));
  }
  for (const auto& entry : system.body_kinds().entries()) {
    for (Index slot = 0; slot < entry.serials.size(); ++slot) {
      if (entry.kind->has_contact_point(slot)) add(entry.kind->material(slot));
    }
  }
  return all;
}

Index number_of(MaterialId material, const std::vector<MaterialId>& all) {
  return static_cast<Index>(std::find(all.begin(), all.end(), material) - all.begin());
}

}  // namespace carom
